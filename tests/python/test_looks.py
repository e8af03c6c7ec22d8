"""The looks of the examples."""

from pathlib import Path

import numpy as np
import pytest
from ringlet.data.pigment import curve_reflectance
from ringlet.groom.operators.woven import STRAND_RADIUS
from ringlet.groom.sections import SECTION

import ringlet
from ringlet.groom import make_hairs

LOOKS = sorted((Path(__file__).parents[2] / "examples" / "looks").glob("*.recipe.toml"))
WOVEN = [look for look in LOOKS if "[locks.sections]" in look.read_text()]


@pytest.mark.parametrize("recipe", WOVEN, ids=lambda path: path.name.removesuffix(".recipe.toml"))
def test_a_woven_look_is_short_builds_and_has_strands_of_equal_number(recipe):
    assert len(recipe.read_text().splitlines()) < 60
    groom = ringlet.build_groom(recipe)
    assert not groom.conflicts and (groom.locks.curve[STRAND_RADIUS] > 5e-4).all()
    sections, strands = np.unique(groom.locks.curve[SECTION], return_counts=True)
    assert len(sections) > 10 and len(set(strands.tolist())) == 1
    assert len(make_hairs(groom, fraction=0.1).curves) > len(groom.locks)


def test_the_ombre_is_dark_at_its_roots_and_light_at_its_tips():
    made = make_hairs(ringlet.build_groom(LOOKS[0].with_name("ombre.recipe.toml")), fraction=0.05).curves
    colors = curve_reflectance(made, "hairs").reshape(len(made), -1, 3)
    assert np.median(colors[:, 0], axis=0).max() < 0.02
    assert np.median(colors[:, -1], axis=0)[0] > 0.3
