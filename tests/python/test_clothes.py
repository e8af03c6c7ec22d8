"""Locks stay out of what is worn: clothes and other surfaces in the head's file, besides the scalp."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from shapes import ball, sheet

import ringlet
from ringlet import Mesh
from ringlet.groom import make_groom, parse_recipe

CHILD = Path(__file__).parents[2] / "examples" / "child" / "head.usdc"
MARGIN = 0.002  # that locks keep [m]
HANGING = (
    "ringlet = 2\n[scalp]\nregion = 'scalp'\n[guides]\ncount = 40\nlength = 25\nlift = 0.2\ngravity_bend = 4\n"
    "whorl = false\n"
    "[locks]\ncount = 80\npoints = 120\n"
)


def shoulders(height: float) -> Mesh:
    """A wide horizontal sheet, on which hair comes to lie."""
    flat = sheet(size=1.0)
    return Mesh("shirt", flat.points + [0.0, height, 0.0], flat.triangles)


def test_locks_lie_on_a_shirt_with_their_lengths_and_do_not_hang_through_it():
    free = make_groom(parse_recipe(HANGING), ball()).locks
    dressed = make_groom(parse_recipe(HANGING), ball(), colliders=[shoulders(-0.11)]).locks
    assert (free.points[:, 1] < -0.12).mean() > 0.05
    assert dressed.points[:, 1].min() > -0.11 + 0.5 * MARGIN
    np.testing.assert_allclose(dressed.lengths(), free.lengths(), rtol=0.06)
    above = free.points.reshape(len(free), -1, 3)[:, :, 1].min(axis=1) > -0.1
    assert above.any()  # locks that end above the shirt are as they were
    np.testing.assert_array_equal(
        dressed.points.reshape(len(free), -1, 3)[above], free.points.reshape(len(free), -1, 3)[above]
    )


@pytest.mark.parametrize("hide", [False, True])
def test_clothes_in_the_file_of_the_head_count_unless_they_are_hidden(hide: bool, tmp_path: Path):
    recipe = tmp_path / "long.recipe.toml"
    named = f"[scalp]\nfile = '{CHILD}'\nmesh = '/child/skin'\n" + ("hide = ['/child/shirt']\n" if hide else "")
    recipe.write_text(HANGING.replace("[scalp]\n", named))
    groom = ringlet.build_groom(recipe)
    groom.hidden = []
    depth = ringlet.check_groom(groom)["found"]["body"]["depth"]
    assert (depth > 5e-3) if hide else (depth < 1e-3), depth
