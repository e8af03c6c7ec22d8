"""Hairs around locks."""

import numpy as np
import pytest
from shapes import ball, rotation

from ringlet import UserError
from ringlet.groom import make_groom, make_hairs, parse_recipe

RECIPE = """
ringlet = 1
[scalp]
region = "scalp"
[guides]
count = 20
[locks]
count = 40
points = 60
[curl]
preset = "3C"
curls = 5
[hairs]
per_lock = 12
"""


def groom(hairs=""):
    return make_groom(parse_recipe(RECIPE + hairs), ball())


def test_the_first_hair_of_a_lock_is_the_groom_guide_bit_for_bit():
    made = groom()
    hairs = make_hairs(made).curves
    first = hairs.points.reshape(40, 12, 60, 3)[:, 0]
    assert hairs.points.dtype == np.float32
    assert np.array_equal(first, made.locks.points.astype(np.float32).reshape(40, 60, 3))


def test_the_first_hair_is_the_simulated_guide_when_locks_move():
    made = groom()
    moved = (made.locks.points + 0.01 * np.sin(40.0 * made.locks.points[:, [1, 2, 0]])).astype(np.float32)
    hairs = make_hairs(made).at(moved, made.scalp.points).reshape(40, 12, 60, 3)
    assert np.array_equal(hairs[:, 0], moved.reshape(40, 60, 3))


def test_hairs_move_rigidly_with_locks_and_scalp():
    made = groom()
    hairs = make_hairs(made)
    turn, shift = rotation((1.0, 0.3, -0.5), 100.0), np.array([0.2, 0.1, -0.3])
    now = hairs.at(made.locks.points @ turn.T + shift, made.scalp.points @ turn.T + shift)
    assert np.allclose(now, hairs.curves.points @ turn.T + shift, atol=2e-6)


def test_hairs_of_other_point_counts_follow_the_lock():
    made = groom("points = 119\n")
    first = make_hairs(made).curves.points.reshape(40, 12, 119, 3)[:, 0]
    assert np.allclose(first[:, ::2], made.locks.points.reshape(40, 60, 3), atol=1e-6)


def test_roots_of_hairs_are_on_the_scalp_around_their_lock():
    made = groom("spread = '4 mm'\n")
    hairs = make_hairs(made).curves
    assert np.isin(hairs.curve["root_triangle"], ball().regions["scalp"]).all()
    at = np.einsum(
        "hc,hcx->hx", hairs.curve["root_barycentric"], ball().points[ball().triangles[hairs.curve["root_triangle"]]]
    )
    assert np.allclose(hairs.roots, at, atol=1e-7)
    assert np.linalg.norm(at - made.locks.roots[hairs.curve["lock"]], axis=1).max() < 0.0045


def test_hairs_stay_within_the_radius_of_their_lock():
    hairs = make_hairs(groom("radius = '1 mm'\nstray = 0\nfrizz = 0\nshorter = 0\n")).curves
    bundle = hairs.points.reshape(40, 12, 60, 3)[:, :, 10:]
    assert np.linalg.norm(bundle - bundle[:, :1], axis=3).max() < 0.00101


def test_a_fraction_of_the_hairs_are_the_first_ones():
    made = groom()
    everything, half = make_hairs(made).curves, make_hairs(made, fraction=0.5).curves
    kept = everything.take(np.isin(everything.ids, half.ids))
    assert len(half) == 40 * 6
    assert np.array_equal(kept.points, half.points)
    with pytest.raises(UserError, match="fraction is 0"):
        make_hairs(made, fraction=0.0)


def test_hairs_thin_out_towards_the_tip():
    hairs = make_hairs(groom("width = { value = 0.01, vary = 0, ramp = [[0, 1], [1, 0.2]] }\n")).curves
    width = hairs.point["width"].reshape(-1, 60)
    assert np.allclose(width[:, 0], 1e-4) and np.allclose(width[:, -1], 2e-5)


def test_hairs_have_names_of_their_own_and_their_texture_coordinates():
    made = groom()
    made.scalp.uv = made.scalp.points[made.scalp.triangles][:, :, [0, 2]]
    hairs = make_hairs(made).curves
    assert len(np.unique(hairs.ids)) == len(hairs)
    assert np.array_equal(hairs.curve["guide_id"], made.locks.ids[hairs.curve["lock"]])
    assert np.allclose(hairs.curve["st"], hairs.roots[:, [0, 2]], atol=1e-6)


def test_settings_that_came_from_a_file_are_checked():
    made = groom()
    made.hairs["per_lock"] = 0
    with pytest.raises(UserError, match=r"groom: hairs: per_lock is 0; must be at least 1"):
        make_hairs(made)
