"""The looks of the examples."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from ringlet.data.groom import SECTION, STRAND_RADIUS
from ringlet.data.pigment import curve_reflectance
from ringlet.groom.check import KINDS, Allowed, Bodies, find, lock_of
from ringlet.groom.hairline import border_points
from ringlet.groom.operators.operator import arc_lengths, evenly, grid
from ringlet.groom.operators.tied import TO_TIE
from ringlet.groom.scalp import Scalp
from ringlet.groom.sections import STRAND
from ringlet.groom.shares import LAID, REACH
from scipy.spatial import KDTree

import ringlet
from ringlet.groom import PRESETS, grooms_of, hairs_per_cm2, make_hairs, read_recipe

EXAMPLES = Path(__file__).parents[2] / "examples"
LOOKS = sorted((EXAMPLES / "looks").glob("*.recipe.toml"))
TIED_LOOKS = [recipe for recipe in LOOKS if 'op = "tie"' in recipe.read_text()]
EAR = 0.365  # height of the middle of an ear [m]
WOVEN_LOOKS = [recipe for recipe in LOOKS if "strands =" in recipe.read_text()]


built = cache(ringlet.build_groom)


def name(recipe):
    return recipe.name.removesuffix(".recipe.toml")


def test_the_fringe_of_the_bob_leaves_no_lock_over_the_face():
    tips = grid(built(EXAMPLES / "looks" / "bob.recipe.toml").locks)[:, -1]
    over_face = (np.abs(tips[:, 0]) < 0.042) & (tips[:, 2] > 0.055)
    assert over_face.sum() > 100 and tips[over_face, 1].min() > 0.375


@pytest.mark.parametrize("recipe", WOVEN_LOOKS, ids=name)
def test_a_look_is_short_builds_and_has_strands_of_equal_number(recipe):
    assert len(recipe.read_text().splitlines()) < 60
    groom = built(recipe)
    assert not groom.conflicts and (groom.locks.curve[STRAND_RADIUS] > 5e-4).all()
    sections, strands = np.unique(groom.locks.curve[SECTION], return_counts=True)
    assert len(sections) > 6 and len(set(strands.tolist())) == 1
    assert len(make_hairs(groom, fraction=0.1).curves) > len(groom.locks)


@pytest.mark.parametrize("look", ["cornrows", "flat_twists"])
def test_no_row_takes_hair_from_farther_than_its_width(look):
    recipe = EXAMPLES / "looks" / f"{look}.recipe.toml"
    reach = built(recipe).locks.curve[REACH]
    assert 0.0 < reach.max() < 0.85 * read_recipe(recipe).locks.sections.size


@pytest.mark.parametrize("look", ["cornrows", "flat_twists"])
def test_tails_of_rows_leave_the_ears_free_and_no_skin_presses_their_strands_into_each_other(look):
    groom = built(EXAMPLES / "looks" / f"{look}.recipe.toml")
    locks, points = groom.locks, grid(groom.locks)
    shortest = locks.curve[LAID] < 0.09
    assert shortest.sum() == 2 * (locks.curve[STRAND].max() + 1)
    assert points[shortest, -1, 1].min() > EAR
    found = find(locks, Bodies(groom, []), Allowed())
    pair = np.stack([found.point, found.other], axis=1)[found.kind == KINDS.index("hair")]
    beyond = (arc_lengths(points) > locks.curve[LAID][:, None]).ravel()
    section = locks.curve[SECTION][lock_of(locks, pair.ravel())].reshape(pair.shape)
    assert not (beyond[pair].all(axis=1) & (section[:, 0] == section[:, 1])).any()


def test_new_growth_is_short_single_hairs_that_are_densest_at_the_hairline():
    groom = built(EXAMPLES / "looks" / "grown_locs.recipe.toml")
    assert set(groom.grooms) == {"growth", "locs"}
    alone = grooms_of(groom)["growth"]
    hairs = make_hairs(alone).curves
    points = hairs.points.reshape(len(hairs), -1, 3)
    away = np.linalg.norm(points - points[:, :1], axis=2).max(axis=1)
    assert 0.003 < np.median(away) < 0.012 and np.quantile(away, 0.99) < 0.025
    scalp = Scalp(alone.scalp, alone.region)
    far = KDTree(border_points(scalp)).query(hairs.roots)[0]
    places = scalp.positions(*scalp.sample(4000, 1)[1:])
    place = KDTree(border_points(scalp)).query(places)[0]
    density = [
        np.mean((a <= far) & (far < b)) / np.mean((a <= place) & (place < b)) for a, b in ((0, 0.005), (0.02, 0.1))
    ]
    assert density[0] > 1.5 * density[1]


def test_the_hairline_of_the_fade_goes_down_in_density_length_and_thickness_without_islands():
    groom = built(EXAMPLES / "looks" / "fade.recipe.toml")
    hairs, scalp = make_hairs(groom).curves, Scalp(groom.scalp, groom.region)
    border = KDTree(border_points(scalp))
    far, width = border.query(hairs.roots)[0], hairs.point["width"].reshape(len(hairs), -1)[:, 0]
    tips = hairs.points.reshape(len(hairs), -1, 3)[:, -1]
    places = scalp.positions(*scalp.sample(20000, 1)[1:])
    away, nearest = border.query(places)[0], KDTree(hairs.roots).query(places, k=5)[0][:, -1]
    bands = [(0.0, 0.0025), (0.0025, 0.005), (0.005, 0.01), (0.01, 0.015), (0.015, 0.02)]
    density, reach, thickness = [], [], []
    for low, high in bands:
        there, skin = (far >= low) & (far < high), (away >= low) & (away < high)
        density.append(there.sum() / skin.sum())
        reach.append(np.median(np.linalg.norm(tips - hairs.roots, axis=1)[there]))
        thickness.append(width[there].mean())
        # as even as by chance: five hairs within a circle of 1.5 times the usual radius (1.4 by a Poisson process)
        assert np.quantile(nearest[skin], 0.95) < 1.5 * np.median(nearest[skin])
    for falls, part in ((density, 0.2), (reach, 0.7), (thickness, 0.6)):
        assert (np.diff(falls) > 0.0).all() and falls[0] < part * falls[-1]


@pytest.mark.parametrize("recipe", TIED_LOOKS, ids=name)
def test_a_tied_look_is_short_and_builds_with_its_bands(recipe):
    assert len(recipe.read_text().splitlines()) < 60
    groom = built(recipe)
    assert not groom.conflicts and (groom.locks.curve[TO_TIE] > 0.0).mean() > 0.98
    ties = {"two_puffs": 2, "ponytails": len(np.unique(groom.locks.curve.get(SECTION, 0)))}.get(name(recipe), 1)
    assert len(groom.accessories) == ties * (3 if "bead =" in recipe.read_text() else 1)  # two beads on a band


def test_the_ombre_is_dark_at_its_roots_and_light_at_its_tips():
    made = make_hairs(built(LOOKS[0].with_name("ombre.recipe.toml")), fraction=0.05).curves
    colors = curve_reflectance(made, "hairs").reshape(len(made), -1, 3)
    assert np.median(colors[:, 0], axis=0).max() < 0.02
    assert np.median(colors[:, -1], axis=0)[0] > 0.3


def test_ridges_of_the_finger_waves_run_along_the_part_on_both_sides_of_the_head():
    recipe = LOOKS[0].with_name("finger_waves.recipe.toml")
    groom, settings = built(recipe), read_recipe(recipe)
    (wave,) = (operator for operator in settings.shape if operator.op == "finger_wave")
    points = grid(groom.locks)
    above = Scalp(groom.scalp, groom.region).solid.above(np.ascontiguousarray(points.reshape(-1, 3)))[0]
    part = evenly(settings.curves["parting"].inline_curve()[0], 500)
    distance = KDTree(part).query(points)[0]
    swing = np.abs(np.sin(2.0 * np.pi * (distance - wave.start) / wave.wavelength))
    laid = (arc_lengths(points) > 0.02) & (distance > 0.03) & (distance < 0.1)
    for side in (points[..., 0] > 0.05, points[..., 0] < 0.0):
        high, low = (np.median(above.reshape(swing.shape)[laid & side & rows]) for rows in (swing > 0.9, swing < 0.5))
        assert high - low > 0.5 * wave.height.value
    assert not groom.conflicts


@pytest.mark.parametrize("kind", PRESETS)
def test_every_type_has_a_recipe_with_the_density_of_a_full_head(kind):
    recipe = read_recipe(EXAMPLES / "types" / f"{kind}.recipe.toml")
    assert recipe.curl is not None and recipe.curl.preset == kind and recipe.name == kind
    assert recipe.hairs.density is not None and recipe.hairs.density.value >= 120


@pytest.mark.parametrize("kind", ["1", "4C"])
def test_a_type_grows_as_dense_as_its_recipe_says(kind):
    groom = built(EXAMPLES / "types" / f"{kind}.recipe.toml")
    assert hairs_per_cm2(groom) == pytest.approx(120, rel=0.05)


def test_the_beard_has_the_density_and_lengths_of_a_beard_and_stays_out_of_the_mouth():
    recipe = EXAMPLES / "looks" / "beard.recipe.toml"
    assert len(recipe.read_text().splitlines()) < 60
    made = built(recipe)
    grooms = grooms_of(made)
    assert not made.conflicts and list(grooms) == ["hair", "beard", "brows", "lashes", "lower_lashes"]
    assert 40 <= hairs_per_cm2(grooms["beard"]) <= 65
    assert np.median(grooms["lashes"].locks.lengths()) == pytest.approx(0.009, abs=0.001)
    assert np.median(grooms["lower_lashes"].locks.lengths()) == pytest.approx(0.006, abs=0.001)
    in_mouth = np.abs(grooms["beard"].locks.points - (0.0, 0.3034, 0.07)) < (0.018, 0.002, 0.02)
    assert not in_mouth.all(axis=1).any()


@pytest.mark.parametrize("look", ["beard", "brows_and_lashes"])
def test_lashes_fan_out_and_curl_up_and_brows_lie_on_the_skin_outwards(look):
    recipe = read_recipe(EXAMPLES / "looks" / f"{look}.recipe.toml")
    assert len((EXAMPLES / "looks" / f"{look}.recipe.toml").read_text().splitlines()) < 60
    lashes, brows = (ringlet.build_groom(recipe.grooms[name]).locks for name in ("lashes", "brows"))
    points, side = grid(lashes), np.sign(lashes.roots[:, 0])
    start, end = points[:, 2] - points[:, 0], points[:, -1] - points[:, -3]
    assert (end[:, 1] > start[:, 1]).mean() > 0.95 and (end[:, 1] > 0).mean() > 0.9
    outwards = side * (points[:, -1, 0] - points[:, 0, 0])
    u = lashes.curve["u"]
    assert np.median(outwards[u > 0.8]) > 0.002 and np.median(outwards[u < 0.3]) < 0.001
    assert np.median(points[:, -1, 2] - points[:, 0, 2]) > 0.003  # forward, out of the eye
    tips = grid(brows)[:, -1]
    assert (np.sign(brows.roots[:, 0]) * (tips[:, 0] - brows.roots[:, 0]) > 0).mean() > 0.9
    scalp = Scalp(ringlet.build_groom(recipe.grooms["brows"]).scalp, None)
    off = np.linalg.norm(scalp.nearest(tips)[0] - tips, axis=1)
    assert np.median(off) < 0.001 and off.max() < 0.0025
