"""Locs: the hairs of a lock, matted to a cylinder."""

import numpy as np
import pytest
from ringlet.data.groom import STRAND_RADIUS
from ringlet.groom.felt import FUZZ, MATTING, PROFILE
from ringlet.groom.scalp import Scalp
from shapes import ball
from styles import groom

from ringlet import read_groom, write_groom
from ringlet.groom import lock_thickness, make_hairs

LOC = """
[[shape]]
op = 'loc'
radius = 0.4
taper = 0
tip = 0
fuzz = 0
start = 0
matting = { value = 0, ramp = [[0, 1]] }
"""
FULL = {"per_lock": 60, "lock_radius": {"value": 0.1, "ramp": [(0.0, 1.0)]}, "frizz": 0.0, "stray": 0.0, "shorter": 0.0}


ROOT = 2  # points of hairs at their roots


def hairs_of_locs(shape, **hairs):
    """Offsets of hairs across their loc beyond its root, shape (hairs, points, 3) [m], and the groom."""
    made = groom("strands = 1", shape, "points = 40")
    made.hairs = {**FULL, "root_falloff": 0.02, **hairs}
    curves = make_hairs(made).curves
    points = curves.points.reshape(len(curves), -1, 3)
    lock = curves.curve["lock"]
    lines = made.locks.points.reshape(len(made.locks), -1, 3)
    tangent = np.gradient(lines, axis=1)
    tangent /= np.linalg.norm(tangent, axis=2, keepdims=True)
    offset = points - lines[lock]
    offset -= np.sum(offset * tangent[lock], axis=2, keepdims=True) * tangent[lock]
    # The first hair of a lock is the lock, and from the roots all over its section hairs come to it.
    return offset[np.r_[True, lock[1:] == lock[:-1]], ROOT:], made


def reach(offset):
    """Distance of the outermost hair along the loc [m]."""
    return np.linalg.norm(offset, axis=2).max(axis=0)


def test_hairs_fill_the_radius_of_a_loc_with_its_taper_bud_and_tip():
    even = reach(hairs_of_locs(LOC)[0])
    np.testing.assert_allclose(even, 0.004, rtol=0.02)
    tapered = reach(hairs_of_locs(LOC.replace("taper = 0", "taper = 0.5"))[0])
    np.testing.assert_allclose(tapered, even * (1.0 - 0.5 * np.linspace(0, 1, 40)[ROOT:]), rtol=0.02)
    offset, made = hairs_of_locs(LOC + "bud = 0.5\nbud_at = 0.5\nbud_length = 3\n")
    budded = reach(offset)
    assert budded[16:20].max() == pytest.approx(0.006, rel=0.03) and budded[[3, 33]].max() < 0.0041
    assert lock_thickness(made) == pytest.approx(0.012, rel=0.03)
    closed = reach(hairs_of_locs(LOC.replace("tip = 0", "tip = 4"))[0])
    assert closed[-1] < 1e-4 and (np.diff(closed[-9:]) < 0).all() and closed[18] > 0.0039


def test_matted_hairs_wander_through_the_loc_and_stay_in_it():
    for matting, alike in ((0, 1.0), (1, 0.0)):
        offset = hairs_of_locs(LOC.replace("value = 0", f"value = {matting}"))[0]
        assert reach(offset).max() < 0.00402
        a, b = offset[:, 10], offset[:, 23]  # 5 cm apart on straight locs
        assert np.sum(a * b) / np.sqrt(np.sum(a * a) * np.sum(b * b)) == pytest.approx(alike, abs=0.08)


def test_hair_of_a_section_comes_to_its_loc_above_the_skin():
    leaning = "[[shape]]\nop = 'bend'\nangle = 60\ntoward = [1, 0, 0]\n"

    def heights(start):
        made = groom("strands = 1", leaning + LOC.replace("start = 0", f"start = {start}"), "points = 120")
        made.hairs = FULL | {"root_falloff": 0.05}
        points = make_hairs(made).curves.points.reshape(-1, 120, 3)[:, :10]
        return Scalp(ball(), "scalp").solid.above(np.ascontiguousarray(points.reshape(-1, 3), np.float64))[0]

    assert heights(1).min() > -3e-4 > -9e-4 > heights(0).min()


def test_fuzz_stands_off_the_surface_of_a_loc_no_farther_than_its_length():
    offset = hairs_of_locs(LOC.replace("fuzz = 0", "fuzz = 0.2"))[0]
    away = np.linalg.norm(offset, axis=2)
    assert 0.0055 < away.max() < 0.00602
    assert 0.01 < np.mean(away > 0.0041) < 0.2


def test_a_loc_acts_on_the_locks_of_its_mask_alone(tmp_path):
    made = groom("strands = 1", LOC + "mask = { where = 'x > 0' }", "points = 40")
    radius = made.locks.curve[STRAND_RADIUS]
    np.testing.assert_allclose(radius, np.where(made.locks.roots[:, 0] > 0.0, 0.004, 0.0), atol=1e-8)
    assert np.array_equal(made.locks.points, groom("strands = 1", "", "points = 40").locks.points)
    write_groom(made, tmp_path / "locs.usdc")
    read = read_groom(tmp_path / "locs.usdc").locks.curve
    for name in (STRAND_RADIUS, PROFILE, MATTING, FUZZ):
        assert np.array_equal(read[name], made.locks.curve[name])
