"""A few tries of each area of tests/fuzz/tries.py, which looks for silent wrong values."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from ringlet.data.binding import root_places
from shapes import ball

from ringlet.groom import make_groom, make_hairs, parse_recipe

sys.path.append(str(Path(__file__).parents[1] / "fuzz"))
from tries import AREAS, attempt


@pytest.mark.parametrize("area", AREAS)
def test_tries_hold_or_are_refused(area):
    outcomes = [attempt(area, number) for number in range(4)]
    assert set(outcomes) <= {"held", "refused"}, outcomes
    assert "held" in outcomes


@pytest.mark.parametrize("number", [36, 54, 78, 1029, 1055])
def test_a_setting_without_effect_in_a_recipe_acts_in_an_ample_one(number):
    assert attempt("used", number) == "held"


def test_a_setting_that_is_ignored_is_found(monkeypatch):
    import areas.used

    def without(table, *more):
        curl = {key: value for key, value in table.get("curl", {}).items() if key != "skips"}
        return grown({**table, "curl": curl} if curl else table, *more)

    grown = areas.used.grown
    monkeypatch.setattr(areas.used, "grown", without)
    assert attempt("used", 87).startswith("UNUSED Curl.skips")


def test_a_try_is_made_again_by_its_number():
    assert attempt("resumes", 61) == attempt("resumes", 61) == "held"


# Mended findings


@pytest.mark.parametrize("shape", ["op = 'braid'", "op = 'twist'", "op = 'loc'\nstart = 2"])
def test_hairs_that_join_a_strand_and_blend_with_another_grow_on_the_skin(shape):
    """recipes 12: the place where they join the other strand was taken for its root, and they grew up to 4 mm off."""
    text = (
        "ringlet = 2\n[scalp]\nregion = 'scalp'\n[guides]\ncount = 12\nlength = 6\n[locks]\ncount = 20\n"
        "[locks.sections]\npattern = 'grid'\nsize = 3\nstrands = 3\n[hairs]\nper_lock = 4\nblend = 1\n[[shape]]\n"
    )
    groom = make_groom(parse_recipe(text + shape), ball())
    hairs = make_hairs(groom).curves
    places = root_places(hairs, groom.scalp.points, groom.scalp.triangles)
    assert np.linalg.norm(hairs.roots - places, axis=1).max() < 1e-7
