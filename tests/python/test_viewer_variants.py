"""Variants saved from the review contain the differences and reproduce the groom."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from pages import page, serving


def test_a_variant_contains_only_differences(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.send(kind="set", changes=[[["curl", "width"], 1.5]], gesture=1)
        one.send(kind="save", name="wide", variant=True)
        one.receive("saved")
    text = (folder / "wide.recipe.toml").read_text()
    assert 'extends = "small.recipe.toml"' in text and "width = 1.5" in text and "pitch" not in text


SHAPES = """
[[shape]]
op = "scraggle"
magnitude = 0.2
[[shape]]
op = "clump"
size = 3
[[shape]]
op = "scraggle"
magnitude = 0.1
"""


@pytest.fixture
def extended(folder: Path) -> Path:
    """A recipe that extends one with three operators."""
    base = folder / "small.recipe.toml"
    base.write_text(base.read_text() + SHAPES)
    (folder / "more.recipe.toml").write_text('ringlet = 2\nextends = "small.recipe.toml"\n[curl]\nwidth = 1.3\n')
    return folder


def test_operators_of_a_base_are_changed_and_removed_by_name(extended: Path):
    with serving(extended, "more.recipe.toml") as client, page(client) as one:
        assert [stage["op"] for stage in one.receive("document")["stages"]][2:5] == ["scraggle", "clump", "scraggle"]
        one.send(kind="set", changes=[[["shape", 2, "magnitude"], 0.4]], gesture=1)
        document = one.receive("document", dirty=True)
        assert document["said"]["shape"] == [{}, {}, {"magnitude": 0.4}]
        assert document["values"]["shape"][2]["magnitude"]["value"] == 0.004
        one.send(kind="arrange", action="remove", at=0)
        document = one.receive("document")
        assert [stage["op"] for stage in document["stages"]][2:4] == ["clump", "scraggle"]
        assert document["values"]["shape"][1]["magnitude"]["value"] == 0.004
        one.send(kind="arrange", action="remove", at=1)
        assert [stage["op"] for stage in one.receive("document")["stages"]][2:4] == ["clump", "curl"]
        one.send(kind="arrange", action="move", at=0, to=0)
        assert "keep their order" in one.receive("trouble")["message"]
        one.send(kind="save")
        one.receive("saved")
    text = (extended / "more.recipe.toml").read_text()
    assert "scraggle = false" in text and '"scraggle 2" = false' in text


@pytest.mark.parametrize(
    "message",
    [
        {"kind": "set", "changes": [[["hairs"], None]]},
        {"kind": "set", "changes": [[["guides", "length"], None]]},
        {"kind": "set", "changes": [[["curl", "width"], None]]},
        {"kind": "set", "changes": [[["curl"], None]]},
        {
            "kind": "set",
            "changes": [[["shape", 1, "size"], None], [["shape", 2, "magnitude"], {"value": 0.3, "vary": 0.1}]],
        },
        {"kind": "arrange", "action": "remove", "at": 0},
        {"kind": "arrange", "action": "move", "at": 0, "to": 1},
    ],
)
def test_a_saved_variant_reproduces_changes_and_removals(extended: Path, message: dict[str, Any]):
    from ringlet.groom import read_recipe

    with serving(extended) as client, page(client) as one:
        one.receive("document")
        one.send(**message, **({"gesture": 1} if message["kind"] == "set" else {}))
        values = one.receive("document", dirty=True)["values"]
        one.send(kind="save", name="other", variant=True)
        one.receive("saved")
    made = read_recipe(extended / "other.recipe.toml").model_dump(mode="json")
    assert {**made, "extends": None, "sculpt": None} == {**values, "sculpt": None}
    assert "count = 6" not in (extended / "other.recipe.toml").read_text()


def test_a_change_that_a_variant_cannot_express_is_refused(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.send(kind="set", changes=[[["locks", "count"], None]], gesture=1)  # a variant cannot remove a count
        one.receive("document", dirty=True)
        one.send(kind="save", name="other", variant=True)
        assert "save a copy instead" in one.receive("trouble")["message"]
    assert not (folder / "other.recipe.toml").exists()
