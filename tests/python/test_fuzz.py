"""Hostile files: what fuzzing starts from and what it found is refused in one line or read, and takes neither long nor
much memory."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

FUZZ = Path(__file__).parents[1] / "fuzz"
sys.path.append(str(FUZZ))
from targets import TARGETS, try_out  # noqa: E402

KEPT = [pytest.param(file, id=f"{file.parent.name}/{file.name}") for file in sorted((FUZZ / "corpus").glob("*/*"))]


@pytest.mark.parametrize("file", KEPT)
def test_kept_inputs_are_read_or_refused(file, tmp_path):
    try_out(TARGETS[file.parent.name], file.read_bytes(), tmp_path)


def test_every_target_has_something_to_start_from():
    assert {file.parent.name for file in (FUZZ / "corpus").glob("*/*")} == set(TARGETS)
