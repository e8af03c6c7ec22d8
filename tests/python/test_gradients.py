"""Gradients: maps by height and by distance from lines and borders."""

import numpy as np
import pytest
from shapes import ball, sheet

from ringlet import UserError
from ringlet.groom import hairs_per_cm2, make_groom, make_hairs, parse_recipe

HEAD = "ringlet = 2\n[scalp]\nregion = 'scalp'\n"


def groom(text, mesh=None, head=HEAD):
    return make_groom(parse_recipe(head + text), mesh or ball())


def test_a_taper_gives_length_by_height_along_its_ramp():
    """Hair of 10 cm at the top of the ball tapers to a tenth at its equator."""
    taper = "[gradients.taper]\ntoward = [0, 1, 0]\nstart = -4.5\nend = 4.5\nramp = [[0, 0.1], [0.5, 0.2], [1, 1]]\n"
    guides = groom(taper + "[guides]\ncount = 300\nlength = { value = 10, map = 'taper' }").guides
    height, length = guides.roots[:, 1], guides.lengths()
    at = np.argsort(height)
    assert np.all(np.diff(length[at]) > -2e-3)  # but for the chords of the mesh
    assert length[height < 0.003] == pytest.approx(0.01, rel=0.1) and length[height.argmax()] > 0.095
    assert np.median(length[np.abs(height - 0.045) < 0.005]) == pytest.approx(0.02, rel=0.2)


@pytest.mark.parametrize("rings", [8, 32])
def test_a_hairline_fades_in_density_and_width_at_any_resolution_of_the_mesh(rings):
    made = groom(
        "[gradients.fade]\nborder = true\nend = 3\nramp = [[0, 0.1], [1, 1]]\n[guides]\ncount = 40\n"
        "[locks]\ncount = 3000\ndensity = 'fade'\n"
        "[hairs]\ndensity = { value = 60, map = 'fade' }\nwidth = { value = '0.09 mm', vary = 0, map = 'fade' }\n",
        ball(rings=rings),
    )
    hairs = make_hairs(made).curves
    height = hairs.roots[:, 1]
    width = hairs.point["width"][hairs.offsets[:-1]]
    band = [(low <= height) & (height < low + 0.006) for low in (0.002, 0.012, 0.034)]
    density = [b.sum() for b in band]  # zones of a sphere of one height have one area
    assert density[0] < 0.45 * density[2] and density[0] < density[1] < density[2]
    widths = [np.median(width[b]) for b in band]
    assert widths[0] < 0.4 * widths[2] and widths[0] < widths[1] < widths[2]


def test_locks_grow_by_their_distance_from_a_drawn_line():
    made = groom(
        "[curves.line]\npoints = [[-9, 0, 0], [9, 0, 0]]\n"
        "[gradients.near]\ncurve = 'line'\nstart = 2\nend = 4\nramp = [[0, 1], [1, 0]]\n"
        "[guides]\ncount = 100\n[locks]\ncount = 400\ndensity = 'near'\n",
        sheet(),
        "ringlet = 2\n",
    )
    away = np.abs(made.locks.roots[:, 2])
    assert away.max() < 0.0401 and np.mean(away < 0.02) > 0.6


def test_a_gradient_that_changes_makes_the_locks_again_and_a_wrong_one_is_refused():
    text = "[gradients.a]\ntoward = [0, 1, 0]\nend = {}\n[guides]\ncount = 50\n[locks]\ncount = 200\ndensity = 'a'\n"
    assert not np.array_equal(groom(text.format(3)).locks.ids, groom(text.format(8)).locks.ids)
    for wrong, message in (
        ("[gradients.a]\nend = 3", "needs one of 'toward', 'curve' and 'border = true'"),
        ("[gradients.a]\nborder = true\nend = 0", "has the same start and end"),
        ("[guides]\nlength.map = 'none'", "which neither the locks nor ball have"),
    ):
        with pytest.raises(UserError, match=message):
            groom(wrong)


def test_a_gradient_of_density_keeps_the_hairs_that_are_asked_for_where_it_is_one():
    made = groom(
        "[gradients.all]\ntoward = [0, 1, 0]\nend = 1\nramp = [[0, 1], [1, 1]]\n"
        "[guides]\ncount = 30\n[locks]\ncount = 500\n[hairs]\ndensity = { value = 60, map = 'all' }\n"
    )
    assert hairs_per_cm2(made) == pytest.approx(60, rel=0.05)


def test_sections_end_where_the_map_of_their_mask_does_and_leave_nothing_bare_before():
    text = (
        "[gradients.front]\ntoward = [0, 0, 1]\nstart = -0.01\nend = 0.01\n[guides]\ncount = 40\n"
        "[locks]\n[locks.sections]\nsize = 4\ngap = 0\nstrands = 2\nmask = { map = 'front' }\n"
        "[hairs]\ndensity = 40\n"
    )
    made = groom(text)
    hairs = make_hairs(made).curves
    assert made.locks.roots[:, 2].min() > 0.0
    near = hairs.roots[hairs.roots[:, 1] > 0.02]
    assert -0.001 < near[:, 2].min() < 0.003
    bare = [near[np.abs(near[:, 0] - x) < 0.01, 2].min() for x in (-0.06, -0.03, 0.0, 0.03, 0.06)]
    assert max(bare) < 0.006
    assert len(hairs) == pytest.approx(40.0 * 0.5 * 2e4 * np.pi * 0.09**2, rel=0.06)
