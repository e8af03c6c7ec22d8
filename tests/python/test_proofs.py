"""The page of proofs has a row for each, in which a run notes its result."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def prove(tmp_path, monkeypatch):
    spec = importlib.util.spec_from_file_location("prove", ROOT / "tools/prove.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    page = tmp_path / "proofs.md"
    page.write_text(module.PAGE.read_text())
    monkeypatch.setattr(module, "PAGE", page)
    return module


def test_a_run_notes_its_result_in_the_row_of_each_proof(prove, monkeypatch):
    monkeypatch.setattr(prove, "PROOFS", dict.fromkeys(prove.PROOFS, "true") | {"wheel": "false"})
    assert prove.main([]) == 1
    rows = [line for line in prove.PAGE.read_text().splitlines() if line.startswith("| ")][1:]
    last = {row.split("|")[1].strip(): row.split("|")[-2].strip() for row in rows}
    assert last.keys() == prove.PROOFS.keys()
    assert last.pop("wheel").startswith("**fails**: ") and all(noted.startswith("holds: ") for noted in last.values())
    assert prove.main(["wheel"]) == 1 and prove.main(["gallery"]) == 0
