"""Finger waves: rows of S-waves on the skin that line up along a line, with ridges between."""

import numpy as np
import pytest
from ringlet.groom.operators.operator import grid
from ringlet.groom.scalp import Scalp
from shapes import ball
from test_groom_operators import on_sheet, uncleaned

from ringlet import UserError
from ringlet.groom import make_groom, parse_recipe

LINE = [[-20, 9, 0], [20, 9, 0]]  # over the top of the ball, from side to side, so that distances are those from x
SETTINGS = "wavelength = 4\namplitude = 0.6\nheight = 0.4\nstart = 1"
RADIUS = 0.09
BALL = ball(RADIUS, rings=48)


PART = "part_line = { across = [0, 0, 1], falloff = 1e2 }"  # combs hair to the front and to the back


def recipe(settings=SETTINGS, more="curve = 'line'", guides="lift = 0.05", points=120, part=PART):
    shape = f"[[shape]]\nop = 'finger_wave'\n{settings}\n{more}\n" if settings is not None else ""
    return parse_recipe(f"""
ringlet = 2
[scalp]
region = 'scalp'
[curves.line]
points = {LINE}
[guides]
count = 60
length = 9
gravity_bend = 5
whorl = false
{guides}
{part}
[locks]
count = 150
points = {points}
shape_points = 40
{shape}
""")


def locks(*settings, **more):
    """Locks after the shape stack."""
    return uncleaned(recipe(*settings, **more), BALL)


def above(points):
    flat = np.ascontiguousarray(points.reshape(-1, 3), np.float64)
    return np.asarray(Scalp(BALL, "scalp").solid.above(flat)[0]).reshape(points.shape[:-1])


def from_line(points):
    return np.hypot(points[..., 1] - RADIUS, points[..., 2])


def test_roots_and_lengths_stay_and_no_point_comes_below_the_skin():
    plain, waved = locks(None), locks()
    assert np.array_equal(waved.roots, plain.roots)
    assert np.allclose(waved.lengths(), plain.lengths(), rtol=1e-2)
    assert above(grid(plain)).min() < -0.01  # straight guides go through the ball
    assert above(grid(waved)).min() > -2e-4


def test_locks_side_by_side_wave_together_in_the_closed_form_and_rise_where_they_turn():
    lying = [
        np.linspace((x, 0.001, z), (x, 0.001, z + 0.11), 111) for x, z in ((-0.03, -0.08), (0.0, -0.05), (0.04, -0.07))
    ]
    curve = "curves.line.points = [[-9, 0.1, -8.5], [9, 0.1, -8.5]]\n"
    waved = grid(on_sheet(f"op = 'finger_wave'\ncurve = 'line'\n{SETTINGS}\n", lying, top=curve))
    for points, straight in zip(waved, lying, strict=True):
        distance = points[:, 2] + 0.085
        beyond = (points[:, 2] - straight[0, 2] > 0.012) & (distance > 0.022)
        assert beyond.sum() > 50
        swing = np.sin(2.0 * np.pi * (distance[beyond] - 0.01) / 0.04)
        np.testing.assert_allclose(points[beyond, 0] - straight[0, 0], 0.006 * swing, atol=1e-4)
        between = 0.006 * np.tanh(0.001 / 0.006)
        np.testing.assert_allclose(points[beyond, 1], between + 0.004 * swing**4, atol=1e-4)


def test_hair_that_stands_off_is_drawn_in_and_waves_are_between_start_and_end():
    standing = "lift = 0.5"
    far, near = (above(grid(locks(f"{SETTINGS}\noff = {off}", guides=standing))).max() for off in (9, 0.3))
    assert far > 0.02 and near < 0.008
    plain, waved = grid(locks("amplitude = 0\nheight = 0\noff = 10")), grid(locks(f"off = 10\nend = 5\n{SETTINGS}"))
    inside = from_line(plain) < 0.009
    assert np.allclose(waved[inside], plain[inside], atol=1e-3)
    assert np.abs(waved - plain).max() > 0.004


def test_ridges_run_along_the_part_line_of_the_guides_where_no_curve_is_named():
    drawn = "part_line = { curve = 'line', falloff = 1e2 }"
    named, own = (make_groom(recipe(more=more, part=drawn), BALL).locks.points for more in ("curve = 'line'", ""))
    assert np.array_equal(named, own)
    points = grid(make_groom(recipe(more="amplitude = 0", settings="off = 10\nheight = 0"), BALL).locks)
    waved = grid(make_groom(recipe(more=""), BALL).locks)  # of a plane
    assert np.abs(waved - points)[:, :, 0].max() > 0.005


def test_bad_input_is_one_line():
    with pytest.raises(UserError, match="no line to run along; name a curve"):
        locks(more="")
    with pytest.raises(UserError, match="ends before it starts; set an 'end'"):
        locks(more="curve = 'line'\nend = 0.5")
    with pytest.raises(UserError, match=r"points of a lock in a wave, where it needs 8; raise locks\.points"):
        locks("wavelength = 1", points=41)
