"""The looks of the examples."""

from pathlib import Path

import numpy as np
import pytest
from ringlet.data.groom import SECTION, STRAND_RADIUS
from ringlet.data.pigment import curve_reflectance
from ringlet.groom.operators.tied import TO_TIE

import ringlet
from ringlet.groom import PRESETS, hairs_per_cm2, make_hairs, read_recipe

EXAMPLES = Path(__file__).parents[2] / "examples"
LOOKS = sorted((EXAMPLES / "looks").glob("*.recipe.toml"))
TIED_LOOKS = [recipe for recipe in LOOKS if 'op = "tie"' in recipe.read_text()]
WOVEN_LOOKS = [recipe for recipe in LOOKS if "strands =" in recipe.read_text()]


def name(recipe):
    return recipe.name.removesuffix(".recipe.toml")


@pytest.mark.parametrize("recipe", WOVEN_LOOKS, ids=name)
def test_a_look_is_short_builds_and_has_strands_of_equal_number(recipe):
    assert len(recipe.read_text().splitlines()) < 60
    groom = ringlet.build_groom(recipe)
    assert not groom.conflicts and (groom.locks.curve[STRAND_RADIUS] > 5e-4).all()
    sections, strands = np.unique(groom.locks.curve[SECTION], return_counts=True)
    assert len(sections) > 6 and len(set(strands.tolist())) == 1
    assert len(make_hairs(groom, fraction=0.1).curves) > len(groom.locks)


@pytest.mark.parametrize("recipe", TIED_LOOKS, ids=name)
def test_a_tied_look_is_short_and_builds_with_its_bands(recipe):
    assert len(recipe.read_text().splitlines()) < 60
    groom = ringlet.build_groom(recipe)
    assert not groom.conflicts and (groom.locks.curve[TO_TIE] > 0.0).mean() > 0.98
    assert len(groom.bands) == (2 if "puffs" in recipe.name else 1)


def test_the_ombre_is_dark_at_its_roots_and_light_at_its_tips():
    made = make_hairs(ringlet.build_groom(LOOKS[0].with_name("ombre.recipe.toml")), fraction=0.05).curves
    colors = curve_reflectance(made, "hairs").reshape(len(made), -1, 3)
    assert np.median(colors[:, 0], axis=0).max() < 0.02
    assert np.median(colors[:, -1], axis=0)[0] > 0.3


@pytest.mark.parametrize("kind", PRESETS)
def test_every_type_has_a_recipe_with_the_density_of_a_full_head(kind):
    recipe = read_recipe(EXAMPLES / "types" / f"{kind}.recipe.toml")
    assert recipe.curl is not None and recipe.curl.preset == kind and recipe.name == kind
    assert recipe.hairs.density is not None and recipe.hairs.density.value >= 120


@pytest.mark.parametrize("kind", ["1", "4C"])
def test_a_type_grows_as_dense_as_its_recipe_says(kind):
    groom = ringlet.build_groom(EXAMPLES / "types" / f"{kind}.recipe.toml")
    assert hairs_per_cm2(groom) == pytest.approx(120, rel=0.05)
