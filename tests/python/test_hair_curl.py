"""Curl of hairs within their lock: sub-clumps, slips, coils of their own."""

import numpy as np
import pytest
from shapes import sheet

from ringlet import UserError
from ringlet.groom import HairMemory, lay_hairs, make_groom, make_hairs, parse_recipe

RECIPE = """
ringlet = 2
[scalp]
[guides]
count = 6
length = 12
lift = 1
gravity_bend = 0
[locks]
count = 6
points = 240
[curl]
width = 1
pitch = 1
start = 0
irregularity = 0
[hairs]
per_lock = 40
points = 240
lock_radius = { value = "1 mm", ramp = [[0, 1], [1, 1]] }
frizz = 0
stray = 0
shorter = 0
"""
INNER = slice(60, 180)  # points away from the root and the tip, where the centre line is that of a whole turn


def groom(hairs="", recipe=RECIPE):
    """A groom of upright coils on a flat sheet, 1 cm wide."""
    return make_groom(parse_recipe(recipe + hairs), sheet())


def bundles(made):
    """Hairs of each lock, shape (locks, hairs, points, 3)."""
    curves = make_hairs(made).curves
    return curves.points.reshape(len(made.locks), -1, len(made.locks.points) // len(made.locks), 3)


def from_axis(hairs, made):
    """Distance of hairs from the axis of their upright lock [m]."""
    return np.linalg.norm(
        hairs[..., [0, 2]] - made.shapes.points[made.shapes.offsets[:-1], None, None][..., [0, 2]], axis=-1
    )


def slips(hairs, made):
    """Phase of hairs about the axis of their lock, relative to the first of them, between -½ and ½ [turns]."""
    x, z = np.moveaxis(
        hairs[..., [0, 2]] - made.shapes.points[made.shapes.offsets[:-1], None, None][..., [0, 2]], -1, 0
    )
    phase = np.arctan2(z, x) / (2.0 * np.pi)
    return (phase[:, 1:] - phase[:, :1] + 0.5) % 1.0 - 0.5


THIN = "[hairs.families]\ncount = 1\ntightness = { value = 1, ramp = [[0, 1]] }\nradius = 0\n"


def test_slips_turn_hairs_about_the_axis_of_the_coil_and_keep_its_radius():
    made = groom(THIN + "[hairs.curl]\ndrift = 0.1\nslips = 0\ncoherence = 0\n")
    hairs = bundles(made)
    radius = from_axis(hairs, made)[:, :, INNER]
    assert np.allclose(radius, 0.005, atol=4e-4)
    slip = slips(hairs, made)
    assert 0.07 < np.std(slip[:, :, 180]) < 0.11
    assert np.std(slip[:, :, 60]) < 0.7 * np.std(slip[:, :, 180])  # it grows along the hair
    assert np.ptp(bundles(groom(THIN))[:, :, INNER], axis=1).max() < 1e-5  # without, all are in phase


def test_hairs_that_slip_are_off_by_that_part_of_a_turn():
    made = groom(THIN + "[hairs.curl]\ndrift = 0\nslips = 0.5\nslip = 0.25\ncoherence = 0\n")
    hairs = bundles(made)
    slip = np.abs(slips(hairs, made))[:, :, 180]
    settled = (slip < 0.02) | (np.abs(slip - 0.25) < 0.03)
    assert settled.mean() > 0.8
    assert 0.3 < (slip > 0.2).mean() < 0.5  # those that slip before that point


def test_families_share_their_phase():
    four = THIN.replace("count = 1", "count = 4")
    together, apart = (
        groom(four + f"[hairs.curl]\ndrift = 0.1\nslips = 0\ncoherence = {coherence}\n") for coherence in (1, 0)
    )
    assert all(len(np.unique(np.round(lock, 3))) <= 5 for lock in slips(bundles(together), together)[:, :, 170])
    assert all(len(np.unique(np.round(lock, 3))) > 20 for lock in slips(bundles(apart), apart)[:, :, 170])


def test_families_draw_hairs_together_as_their_ramp_says():
    families = "[hairs.families]\ncount = 5\ntightness = { value = 1, ramp = [[0, 0], [0.5, 1], [1, 0]] }\nradius = 0\n"
    made = groom(families)
    hairs = bundles(made)[:, 1:]
    middle, end = (np.unique(np.round(hairs[0, :, at], 5), axis=0) for at in (120, -1))
    assert len(middle) == 5 and len(end) == 39


def test_a_coil_of_their_own_winds_hairs_about_their_place_in_the_lock():
    straight = RECIPE.replace("width = 1\n", "width = 0\n")
    made = groom(
        "[hairs.coil]\nwidth = { value = '2 mm', vary = 0 }\npitch = { value = '12 mm', vary = 0 }\n", straight
    )
    plain = bundles(groom("", straight))
    hairs = bundles(made)
    off = np.linalg.norm(hairs - plain, axis=3)[:, 1:]
    assert np.allclose(off[:, :, 40:], 0.001, atol=1e-5)
    turned = np.unwrap(np.arctan2(*np.moveaxis((hairs - plain)[:, 1:, 40:, [2, 0]], -1, 0)), axis=-1) / (2.0 * np.pi)
    turns = np.abs(turned[:, :, -1] - turned[:, :, 0])
    assert np.allclose(turns.mean(), 10 * 199 / 239, atol=0.5)
    assert np.array_equal(hairs[:, 0], plain[:, 0])  # the first hair is the lock


def test_a_kinked_coil_is_a_zigzag_in_a_plane():
    straight = RECIPE.replace("width = 1\n", "width = 0\n")
    coil = "[hairs.coil]\nwidth = { value = '2 mm', vary = 0 }\nkink = 1\n"
    off = (bundles(groom(coil, straight)) - bundles(groom("", straight)))[:, 1:, 40:]
    for hair in off.reshape(-1, *off.shape[2:])[:20]:
        sizes = np.linalg.svd(hair - hair.mean(axis=0), compute_uv=False)
        assert sizes[1] < 1e-3 * sizes[0]


def test_coils_relax_towards_the_tips_of_hairs_and_not_elsewhere():
    made = groom(THIN + "[hairs.curl]\ndrift = 0\nslips = 0\nrelax = { value = 1, vary = 0 }\n")
    radius = from_axis(bundles(made), made)[:, 1:]
    assert np.allclose(radius[:, :, INNER], 0.005, atol=4e-4)
    assert radius[:, :, -1].max() < 0.002


def test_hairs_escape_from_the_centre_line_towards_the_tip():
    made = groom(THIN + "[hairs.curl]\ndrift = 0\nslips = 0\nescape = '4 mm'\n")
    hairs = bundles(made)
    off = np.linalg.norm(hairs - hairs[:, :1], axis=3)[:, 1:]
    assert np.median(off[:, :, -1]) > 2.0 * np.median(off[:, :, 100]) > 0.0
    turn = 20  # points of a turn: the coil itself stays as wide
    centre = np.mean(np.stack([hairs[:, :, 140 + k : 160 + k] for k in range(turn)]), axis=0)
    radius = np.linalg.norm((hairs[:, :, 150:170] - centre)[..., [0, 2]], axis=3)
    assert np.allclose(radius, 0.005, atol=8e-4)


def test_the_curl_of_hairs_survives_that_locks_swing():
    made = groom("[hairs.families]\n[hairs.curl]\ndrift = 0.3\nescape = '2 mm'\n[hairs.coil]\npitch = '20 mm'\n")
    hairs = make_hairs(made)
    height = made.locks.points[:, 1:2] - made.locks.points[:, 1].min()
    bent = made.locks.points + np.concatenate([4.0 * height**2, 0 * height, 0 * height], axis=1)
    rest, swung = (
        np.diff(points.reshape(-1, 240, 3), axis=1)
        for points in (hairs.deformed(made.locks.points, made.scalp.points), hairs.deformed(bent, made.scalp.points))
    )
    lengths = [np.linalg.norm(edges, axis=2).sum(axis=1) for edges in (rest, swung)]
    lock = [
        np.linalg.norm(np.diff(p.reshape(-1, 240, 3), axis=1), axis=2).sum(axis=1) for p in (made.locks.points, bent)
    ]
    stretch = np.repeat(lock[1] / lock[0], 40)
    assert np.abs(lengths[1] / lengths[0] / stretch - 1.0).max() < 0.1


def test_too_few_points_for_the_coil_of_hairs_are_refused_with_a_number():
    with pytest.raises(UserError, match=r"hairs.points is 240: too few for .* turns of hairs.coil .* set it to \d+"):
        make_hairs(groom("[hairs.coil]\npitch = '1 mm'\n"))


def test_hairs_get_the_points_that_their_coil_needs_where_none_are_given():
    made = groom("[hairs.coil]\npitch = '1 mm'\n", RECIPE.replace("per_lock = 40\npoints = 240\n", "per_lock = 4\n"))
    assert make_hairs(made).curves.counts.max() > 8 * made.locks.lengths().max() / 1e-3


def test_families_wind_at_a_pitch_of_their_own():
    families = THIN.replace("count = 1", "count = 6").replace("value = 1", "value = 0")
    curl = "[hairs.curl]\ndrift = 0\nslips = 0\npitch_spread = 0.3\n"
    made = groom(families + curl, RECIPE.replace("1 mm", "0.01 mm"))
    phase = slips(bundles(made), made)[:, :, INNER]
    more = np.diff(np.unwrap(2.0 * np.pi * phase, axis=2)[:, :, [0, -1]], axis=2)[..., 0] / (2.0 * np.pi)
    turns = 12.0 * 119 / 239  # of the lock there
    assert np.abs(more).max() < 0.31 * turns and np.abs(more).max() > 0.15 * turns
    assert all(len(np.unique(np.round(of_lock, 2))) <= 8 for of_lock in more)  # with the lock itself


def test_wider_locks_keep_the_layout_of_hairs_that_curl():
    curl = "[hairs.families]\n[hairs.curl]\n"
    memory = HairMemory()
    laid = lay_hairs(groom(curl), memory=memory)
    wide = lay_hairs(groom(curl, RECIPE.replace("width = 1\n", "width = 1.2\n")), memory=memory)
    assert wide.curves is laid.curves  # a page that has this layout needs no other
    tighter = lay_hairs(groom(curl, RECIPE.replace("pitch = 1\n", "pitch = 0.7\n")), memory=memory)
    assert (laid.windows.tolist(), tighter.windows.tolist()) == ([20] * 6, [14] * 6)
    other = lay_hairs(groom(curl + "drift = 0.2\n"), memory=memory)
    assert other.curves is not laid.curves


def test_cached_hairs_with_a_curl_equal_rebuilt_hairs():
    curl = "[hairs.families]\n[hairs.curl]\n[hairs.coil]\npitch = '20 mm'\n"
    memory = HairMemory()
    make_hairs(groom(curl), memory=memory)
    wider = groom(curl, RECIPE.replace("width = 1\n", "width = 1.2\n"))
    assert np.array_equal(make_hairs(wider, memory=memory).curves.points, make_hairs(wider).curves.points)
    painted = groom(curl.replace("[hairs.coil]", "drift = 0.2\n[hairs.coil]"))
    assert np.array_equal(make_hairs(painted, memory=memory).curves.points, make_hairs(painted).curves.points)
