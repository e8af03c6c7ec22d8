"""Sculpted guides keep their sculpt when the recipe changes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from ringlet.groom.edits_file import edits_text
from ringlet.groom.load import read_edits
from ringlet.groom.scalp import Scalp
from ringlet.groom.sculpt import sculpts_to
from small_example import write_example

import ringlet
from ringlet import Curves, UserError
from ringlet.groom import Groom, parse_recipe, read_recipe


@pytest.fixture
def recipe(tmp_path: Path) -> Path:
    path = write_example(tmp_path) / "small.recipe.toml"
    path.write_text(path.read_text().replace('name = "small"', 'name = "small"\nedits = "small.edits.toml"'))
    return path


def sculpt(recipe: Path, groom: Groom, guides: Curves) -> None:
    """Writes the difference of guides to those of a groom as sculpts beside the recipe."""
    assert groom.unsculpted is not None
    made: list[dict[str, Any]] = sculpts_to(groom.unsculpted, guides, Scalp(groom.scalp, groom.region))
    (recipe.parent / "small.edits.toml").write_text(edits_text({"edit": [], "sculpt": made}))


def bent(guides: Curves, row: int) -> Curves:
    """Guides with the tip of one displaced by 2 cm."""
    points = guides.points.copy()
    here = slice(guides.offsets[row], guides.offsets[row + 1])
    points[here, 0] += 0.02 * np.linspace(0.0, 1.0, guides.counts[row]) ** 2
    return guides.with_points(points)


def test_sculpted_guides_keep_their_positions_and_locks_follow(recipe: Path):
    before = ringlet.build_groom(recipe)
    wanted = bent(before.guides, 2)
    sculpt(recipe, before, wanted)
    after = ringlet.build_groom(recipe)
    assert np.abs(after.guides.points - wanted.points).max() < 2e-5  # sculpts are rounded to 0.01 mm
    assert np.array_equal(
        np.delete(after.guides.points, slice(20, 30), 0), np.delete(before.guides.points, slice(20, 30), 0)
    )
    assert np.abs(after.locks.points - before.locks.points).max() > 0.005
    np.testing.assert_array_equal(after.locks.roots, before.locks.roots)


def test_a_cut_guide_keeps_its_fraction_when_the_recipe_lengthens_it(recipe: Path):
    before = ringlet.build_groom(recipe)
    (recipe.parent / "small.edits.toml").write_text(
        f"ringlet = 2\n[[sculpt]]\nguide = {before.guides.ids[1]}\nlength = 0.5\n"
    )
    assert ringlet.build_groom(recipe).guides.lengths()[1] == pytest.approx(0.5 * before.guides.lengths()[1], rel=0.01)
    recipe.write_text(recipe.read_text().replace("length = 5", "length = 8"))
    longer = ringlet.build_groom(recipe)
    assert longer.unsculpted is not None
    assert longer.guides.lengths()[1] == pytest.approx(0.5 * longer.unsculpted.lengths()[1], rel=0.01)
    assert longer.guides.lengths()[1] > 1.4 * 0.5 * before.guides.lengths()[1]


def test_sculpting_survives_changes_of_the_guides(recipe: Path):
    before = ringlet.build_groom(recipe)
    sculpt(recipe, before, bent(before.guides, 2))
    displacement = ringlet.build_groom(recipe).guides[2][-1] - before.guides[2][-1]
    recipe.write_text(recipe.read_text().replace("length = 5", "length = 5\npoints = 16\nlift = 0.7"))
    later = ringlet.build_groom(recipe)
    assert later.unsculpted is not None and later.guides.counts[2] == 16
    assert np.linalg.norm(later.guides[2][-1] - later.unsculpted[2][-1]) == pytest.approx(
        np.linalg.norm(displacement), rel=0.02
    )


def test_unchanged_guides_need_no_sculpt(recipe: Path):
    groom = ringlet.build_groom(recipe)
    assert sculpts_to(groom.guides, groom.guides, Scalp(groom.scalp, groom.region)) == []


def test_a_sculpt_of_a_missing_guide_is_reported(recipe: Path):
    (recipe.parent / "small.edits.toml").write_text("ringlet = 2\n[[sculpt]]\nguide = 7\nlength = 0.5\n")
    assert "guide 7 was sculpted but is no longer there" in ringlet.build_groom(recipe).conflicts[0]


def test_edits_of_locks_keep_sculpts_in_the_file(recipe: Path):
    groom = ringlet.build_groom(recipe)
    sculpt(recipe, groom, bent(groom.guides, 2))
    ringlet.edit_lock(recipe, int(groom.locks.ids[0]), settings={"curl.width": "8 mm"})
    edits = read_edits(recipe.parent / "small.edits.toml")
    assert len(edits["edit"]) == 1 and len(edits["sculpt"]) == 1
    ringlet.release_locks(recipe)
    assert len(read_recipe(recipe).sculpt) == 1


def test_invalid_sculpts_are_refused(recipe: Path):
    text = recipe.read_text()
    with pytest.raises(UserError, match="changes nothing"):
        parse_recipe(text, recipe, "ringlet = 2\n[[sculpt]]\nguide = 3\n")
    with pytest.raises(UserError, match="holds \\[\\[edit\\]\\] and \\[\\[sculpt\\]\\] tables only"):
        parse_recipe(text, recipe, "ringlet = 2\n[curl]\nwidth = 1\n")
