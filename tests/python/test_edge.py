"""Hair on an edge: roots along drawn lines and along the border of a region."""

from __future__ import annotations

import numpy as np
import pytest
from commands import edit
from scipy.spatial import KDTree
from small_example import RADIUS

import ringlet

LASHES = """
ringlet = 2
[scalp]
file = "head.usda"

[scalp.edge]
lines = ["lid"]
both_sides = true
width = 0.5

[curves.lid]
points = [[2, 0, 8.8], [4, 1, 8], [6, 0, 6.7]]

[guides]
count = 40
length = 1
lift = 0.2
gravity_bend = 0
flow = [0, 1, 0]

[locks]
count = 120
points = 8

[collide]
margin = 0
"""

AROUND = """
ringlet = 2
[scalp]
file = "head.usda"
[scalp.edge]
region = "scalp"
width = 0
mask = { where = "z > 0" }
[guides]
count = 20
length = 1
[locks]
count = 80
points = 8
"""


@pytest.fixture
def lashes(copy):
    (copy / "lashes.recipe.toml").write_text(LASHES)
    return copy / "lashes.recipe.toml"


def straight(roots):
    """Roots in the order of their line: x of both sides."""
    return np.abs(roots[:, 0])


def test_roots_are_evenly_along_the_line_within_its_band_on_both_sides(lashes):
    locks = ringlet.build_groom(lashes).locks
    assert len(locks) == 120 and abs((locks.roots[:, 0] > 0).sum() - 60) <= 3
    u, v = locks.curve["u"], locks.curve["v"]
    assert u.min() < 0.05 and u.max() > 0.95 and v.min() < 0.1 and v.max() > 0.9
    assert np.corrcoef(u, straight(locks.roots))[0, 1] > 0.99
    assert np.diff(np.sort(u[locks.roots[:, 0] > 0])).max() < 0.06
    line = ringlet.build_groom(edit(lashes, "width = 0.5", "width = 0")).locks
    assert KDTree(line.roots).query(locks.roots)[0].max() < 0.0025 + 0.002


def test_roots_stay_when_their_number_changes(lashes):
    before = ringlet.build_groom(lashes).locks
    after = ringlet.build_groom(edit(lashes, "count = 120", "count = 130")).locks
    assert len(after) == 130 and np.isin(before.ids, after.ids).mean() > 0.6
    same, others = np.intersect1d(before.ids, after.ids), {}
    for locks in (before, after):
        others[id(locks)] = locks.roots[[locks.row_of(int(one), "test") for one in same]]
    np.testing.assert_allclose(others[id(before)], others[id(after)], atol=1e-9)


@pytest.mark.parametrize(("turn", "along"), [(90, 0.0), (0, 1.0), (45, np.sqrt(0.5))])
def test_hair_grows_across_the_line_or_along_it_by_its_turn(lashes, turn, along):
    edit(lashes, "width = 0.5", f"width = 0\nturn = {turn}")
    locks = ringlet.build_groom(edit(lashes, "lift = 0.2", "lift = 0")).locks
    right = locks.roots[:, 0] > 0
    order = np.argsort(locks.curve["u"][right])
    roots = locks.roots[right][order]
    start = locks.points[locks.offsets[:-1] + 2][right][order] - roots
    tangent = np.gradient(roots, axis=0)
    cosine = np.sum(start * tangent, axis=1) / np.linalg.norm(start, axis=1) / np.linalg.norm(tangent, axis=1)
    assert np.median(cosine) == pytest.approx(along, abs=0.08)
    if turn == 90:
        assert (start[:, 1] > 0).all()  # to the side of guides.flow


def test_a_band_is_narrow_where_its_ramp_is(lashes):
    edit(lashes, "width = 0.5", "width = { value = 0.8, ramp = [[0, 1], [1, 0.1]] }")
    wide = ringlet.build_groom(lashes).locks
    line = ringlet.build_groom(edit(lashes, "width = { value = 0.8, ramp = [[0, 1], [1, 0.1]] }", "width = 0"))
    off, u = KDTree(line.locks.roots).query(wide.roots)[0], wide.curve["u"]
    assert off[u < 0.2].max() > 2.0 * off[u > 0.8].max()
    assert (u < 0.5).sum() > 1.5 * (u > 0.5).sum()  # as dense on the band


def test_values_and_zones_use_the_place_along_the_line(lashes):
    edit(lashes, "lift = 0.2", 'lift = 0.2\nzone = [{ mask = { where = "u > 0.5" }, length = 0.5 }]')
    locks = ringlet.build_groom(lashes).locks
    u, length = locks.curve["u"], locks.lengths()
    assert length[u < 0.4] == pytest.approx(0.01, rel=0.02) and length[u > 0.6] == pytest.approx(0.005, rel=0.02)


def test_guides_that_become_locks_carry_their_place_too(lashes):
    edit(
        lashes,
        "count = 120\npoints = 8",
        'points = 8\n[[shape]]\nop = "length"\nfactor = 2\nmask = { where = "u < 0.5" }',
    )
    locks = ringlet.build_groom(lashes).locks
    assert len(locks) == 40
    np.testing.assert_allclose(locks.lengths(), np.where(locks.curve["u"] < 0.5, 0.02, 0.01), rtol=0.02)


def test_the_border_of_a_region_carries_hair_where_its_mask_is(copy):
    (copy / "around.recipe.toml").write_text(AROUND)
    made = ringlet.build_groom(copy / "around.recipe.toml")
    roots = made.locks.roots
    assert len(roots) == 80 and (roots[:, 2] > -0.002).all()
    assert np.ptp(roots[:, 1]) < 0.005 and roots[:, 0].min() < -0.07 and roots[:, 0].max() > 0.07
    radius = np.hypot(roots[0, 0], roots[0, 2])
    assert made.edge == pytest.approx(np.pi * radius, rel=0.1) and radius < 0.01 * RADIUS
