"""Brushes on guides: fixed roots, and the effect of each tool."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from ringlet.viewer.edit.brush import TOOLS, Ball, grab, grab_weights, restore

from ringlet import Curves


@pytest.fixture
def guides() -> Curves:
    """Three vertical guides of 10 cm in a row along x."""
    up = np.linspace(0.0, 0.1, 11)
    return Curves.from_list([np.stack([np.full(11, x), up, np.zeros(11)], axis=1) for x in (-0.05, 0.0, 0.05)])


def ball(x: float = 0.0, y: float = 0.08, by: tuple[float, float, float] = (0.0, 0.0, 0.01)) -> Ball:
    return Ball(np.array([x, y, 0.0]), np.array(by), 0.02)


def test_grab_moves_points_inside_the_brush_only(guides: Curves):
    brush = ball()
    after = grab(guides, brush, grab_weights(guides, brush))
    assert after[1][8] == pytest.approx([0.0, 0.08, 0.01])
    assert np.array_equal(after[1][:6], guides[1][:6])
    assert np.array_equal(after[0], guides[0]) and np.array_equal(after[2], guides[2])


def test_comb_keeps_the_length_of_every_edge(guides: Curves):
    after = TOOLS["comb"](guides, ball())
    assert after[1][8][2] > 0.005
    edges = np.linalg.norm(np.diff(after[1], axis=0), axis=1)
    np.testing.assert_allclose(edges, 0.01, rtol=1e-9)


def test_smooth_reduces_bends_and_keeps_the_length(guides: Curves):
    points = guides.points.copy()
    points[11 + 7, 2] = 0.006
    bent = guides.with_points(points)
    after = TOOLS["smooth"](bent, ball(y=0.07, by=(0.0, 0.0, 0.02)))
    assert abs(after[1][7][2] - 0.5 * (after[1][6][2] + after[1][8][2])) < 0.004
    assert after.lengths()[1] == pytest.approx(bent.lengths()[1])


def test_cut_ends_a_guide_at_the_brush(guides: Curves):
    after = TOOLS["cut"](guides, ball())
    assert after.lengths()[1] == pytest.approx(0.06, abs=0.0015)  # the brush covers 6 to 10 cm
    assert after.lengths()[[0, 2]] == pytest.approx([0.1, 0.1])
    assert TOOLS["cut"](guides, ball(y=0.0)).lengths()[1] == pytest.approx(0.005)  # a minimum length remains


def test_growth_depends_on_the_path_of_the_brush_only(guides: Curves):
    once = TOOLS["lengthen"](guides, ball()).lengths()[1]
    twice = guides
    for _ in range(2):
        twice = TOOLS["lengthen"](twice, ball(by=(0.0, 0.0, 0.005)))
    assert once > 0.11 and twice.lengths()[1] == pytest.approx(once, rel=0.01)


@pytest.mark.parametrize("tool", sorted(TOOLS))
def test_roots_stay_and_a_distant_brush_changes_nothing(guides: Curves, tool: str):
    assert np.array_equal(TOOLS[tool](guides, ball(y=0.01)).roots, guides.roots)
    assert np.array_equal(TOOLS[tool](guides, ball(x=0.2)).points, guides.points)


def test_a_brush_between_two_points_affects_the_guide(guides: Curves):
    small = Ball(np.array([0.0, 0.085, 0.0]), np.array([0.0, 0.0, 0.002]), 0.002)
    assert TOOLS["cut"](guides, small).lengths()[1] < 0.09


def test_a_mirrored_brush_gives_the_mirror_image(guides: Curves):
    one = ball(x=0.05, by=(0.004, 0.0, 0.003))
    after = TOOLS["comb"](TOOLS["comb"](guides, one), one.mirrored(0.0))
    np.testing.assert_allclose(after[0], after[2] * (-1, 1, 1), atol=1e-12)
    assert np.array_equal(after[1], guides[1])


def test_the_revert_brush_restores_guides(guides: Curves):
    changed = TOOLS["comb"](guides, ball())
    assert np.array_equal(restore(changed, ball(), guides).points, guides.points)


def test_strength_and_falloff_weigh_what_a_brush_moves(guides: Curves):
    at = np.array([[0.0, 0.08, 0.0], [0.0, 0.09, 0.0], [0.0, 0.099, 0.0]])  # centre, half the radius, near its border
    weights = {name: replace(ball(), profile=name, strength=0.5).falloff(at) for name in ("smooth", "sharp", "flat")}
    assert all(values[0] == pytest.approx(0.5) for values in weights.values())
    assert weights["flat"][2] == 0.5 > weights["smooth"][1] > weights["sharp"][1] > 0.0
