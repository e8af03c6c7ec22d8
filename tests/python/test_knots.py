"""Bantu knots: strands wound about their own base."""

import numpy as np
import pytest
from ringlet.data.groom import SECTION, STRAND_RADIUS
from ringlet.groom.felt import PROFILE
from styles import groom, strands_of

from ringlet import UserError
from ringlet.groom import make_hairs

KNOT = "[[shape]]\nop = 'knot'\nwidth = 3\nheight = 2.4\n"


def knots(strands, more="", points=300):
    """Centre lines of knots (sections, points, 3), their locks, and heights of the lines over the ball [m]."""
    locks = groom(f"strands = {strands}\nsize = 5", KNOT + more, f"points = {points}").locks
    lines = np.array([one.mean(axis=0) for one in strands_of(locks)])
    return lines, locks, np.linalg.norm(lines, axis=2) - 0.09


def axis_distance(line):
    """Distance of a knot's points from its axis, which goes through the middle of the ball [m]."""
    axis = line[0] / np.linalg.norm(line[0])
    return np.linalg.norm(line - np.outer(line @ axis, axis), axis=1)


@pytest.mark.parametrize("windings", [2, 3.5])
def test_windings_of_a_knot_touch_and_do_not_overlap(windings):
    lines, locks, _ = knots(1, f"windings = {windings}")
    thickness = 2.0 * locks.curve[STRAND_RADIUS]
    for line, thick in zip(lines, thickness, strict=True):
        along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
        distance = np.linalg.norm(line[:, None] - line[None], axis=2)
        others = np.abs(along[:, None] - along[None]) > 0.5 * np.pi * thick  # beyond half a circle of that thickness
        nearest = np.where(others, distance, np.inf).min(axis=1)
        assert 0.93 * thick < nearest.min() and np.median(nearest[150:]) < 1.1 * thick


def test_a_knot_sits_on_the_scalp_with_its_width_and_height_and_its_end_tucked_under():
    lines, locks, heights = knots(1)
    assert np.array_equal(lines[:, 0], groom("strands = 1\nsize = 5", "", "points = 300").locks.roots)
    for line, height, radius in zip(lines, heights, locks.curve[STRAND_RADIUS], strict=True):
        away = axis_distance(line)
        assert height.max() + radius == pytest.approx(0.024, rel=0.05)
        assert 2.0 * (away.max() + radius) == pytest.approx(0.03, rel=0.07)
        assert height[60:].min() == pytest.approx(radius, rel=0.3) and height[60:].argmin() > 200  # the last winding
        assert away[-1] < away.max() - 0.5 * radius and height[-1] < 1.3 * radius  # the tip is under those above
    loose = knots(1, "tuck = 0")[0]
    assert min(map(axis_distance, loose), key=lambda away: away[-1])[-1] > max(axis_distance(one)[-1] for one in lines)
    assert (locks.curve[PROFILE][:, -1] < 1e-6).all()  # the end closes


def test_two_strands_of_a_knot_are_twisted_and_touch():
    locks = knots(2, points=400)[1]
    radius = float(locks.curve[STRAND_RADIUS][0])
    for one in strands_of(locks):
        apart = np.linalg.norm(one[0, 60:-30, None] - one[1, None], axis=2).min(axis=1)  # thinner at the end
        np.testing.assert_allclose(apart, 2.0 * radius, rtol=0.08)
        across = (one[0] - one[1])[60:]
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        turned = np.arccos(np.clip(np.sum(across[1:] * across[:-1], axis=1), -1.0, 1.0)).sum() / (2.0 * np.pi)
        length = np.linalg.norm(np.diff(one.mean(axis=0), axis=0), axis=1)[60:].sum()
        assert turned > 0.3 * length / (4.0 * 2.0 * radius)  # a turn every two thicknesses, seen along a bent axis


def test_a_knot_of_few_points_is_refused():
    with pytest.raises(UserError, match=r"locks.points is 20: too few for the 3.0 turns of knot and its strands"):
        knots(1, points=20)


@pytest.mark.parametrize("more", ["mask = 0", "blend = 0"])
def test_a_knot_that_acts_nowhere_changes_nothing(more):
    plain = groom("strands = 1", "").locks
    assert np.array_equal(plain.points, groom("strands = 1", KNOT + more).locks.points)


def test_hair_of_a_wide_section_comes_to_its_knot_without_gaps():
    hair = "[hairs]\ndensity = 150\npoints = 140\nroot_falloff = 0.03\nfrizz = 0\nstray = 0"
    made = groom("strands = 3\nsize = 5", KNOT, "points = 300", hair)
    locks, hairs = made.locks, make_hairs(made).curves
    points = hairs.points.reshape(len(hairs), -1, 3).astype(np.float64)
    section = locks.curve[SECTION]
    widest = []
    for one in np.unique(section):
        middle = locks.roots[section == one].mean(axis=0)
        paths = points[section[hairs.curve["lock"]] == one] - middle
        plane = np.linalg.svd(paths[:, 0], full_matrices=False)[2][:2]
        flat = paths @ plane.T
        away = np.linalg.norm(flat, axis=2)
        far = away[:, 0] > 0.35 * away[:, 0].max()
        half_way = flat[np.arange(len(flat)), (away < 0.5 * away[:, :1]).argmax(axis=1)][far]
        around = np.sort(np.arctan2(half_way[:, 1], half_way[:, 0]))
        widest.append(np.diff(around, append=around[0] + 2.0 * np.pi).max())
    assert np.degrees(np.median(widest)) < 5.0
