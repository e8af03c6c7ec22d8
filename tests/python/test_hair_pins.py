"""Pins attach hair to the moving skin."""

from itertools import pairwise

import numpy as np
import pytest
from ringlet.shot.shot import parse_shot
from ringlet.sim import simulate
from shapes import ball, rotation

import ringlet
from ringlet import Clip, UserError
from ringlet.groom import make_groom, parse_recipe

RECIPE = """
ringlet = 2
[scalp]
region = "scalp"
[guides]
count = 8
length = 6
[locks]
count = 16
points = 24
"""
SHOT = (
    "ringlet = 2\ngroom = 'g.toml'\nframes = [1, 12]\npreroll = 0\n[strands]\nbend_scale = 1\n[solver]\nnewton = 10\n"
)


def groom(pins=""):
    return make_groom(parse_recipe(RECIPE + pins), ball())


def shaken(made, extra=""):
    """Locks on a ball that oscillates about the vertical, and rigidly attached locks, per frame."""
    frames = np.arange(1.0, 13.0)
    turns = [rotation((0, 1, 0), 25 * np.sin(0.9 * (frame - 1))) for frame in frames]
    clip = Clip(frames, np.stack([made.scalp.points @ turn.T for turn in turns]), 24.0)
    cache = simulate(parse_shot(SHOT + extra), made, clip)
    return cache.points, np.stack([made.locks.points @ turn.T for turn in turns])


def swing(made, extra=""):
    """Largest distance of each point from rigid motion [m], shape (count, points)."""
    moved, rigid = shaken(made, extra)
    return np.linalg.norm(moved - rigid, axis=2).max(axis=0).reshape(len(made.locks), -1)


def test_rigidly_pinned_vertices_move_with_the_skin_and_tips_swing():
    made = groom("[[pin]]\nmask = { where = 'z > 0' }\nlength = 3\n")
    pin = made.locks.point["pin"].reshape(16, 24)
    front = made.locks.roots[:, 2] > 0
    along = np.linspace(0, 1, 24) * made.locks.lengths()[:, None]
    assert np.array_equal(pin > 0, front[:, None] & (along <= 0.03 + 1e-6))
    away = swing(made)
    assert away[pin == 1].max() < 1e-6
    assert away[:, -1].min() > 0.0015  # all tips swing
    assert np.median(away[front, -1]) < np.median(away[~front, -1])


def test_swing_increases_with_the_softness_of_pins():
    swings = [np.median(swing(groom(f"[[pin]]\nfirm = {firm}\n"))[:, -1]) for firm in (0.0, 0.2, 0.5, 0.9)]
    assert swings[0] > 0.01
    assert all(b < 0.75 * a for a, b in pairwise(swings))
    assert swings[-1] < 0.25 * swings[0]


def test_a_pin_fades_out_along_the_lock():
    made = groom("[[pin]]\nlength = 2\nfalloff = 3\n")
    pin = made.locks.point["pin"].reshape(16, 24)
    assert np.all(np.diff(pin, axis=1) <= 1e-9) and np.all(pin[:, 0] == 1) and np.all(pin[:, -1] < 1)
    away = swing(made)
    assert away[pin >= 0.999].max() < 1e-6
    assert np.all(away[:, -1] > away[:, 12])


def test_the_firmest_of_several_pins_applies():
    made = groom("[[pin]]\nfirm = 0.2\n[[pin]]\nfirm = 0.6\nmask = { where = 'x > 0' }\n")
    pin = made.locks.point["pin"].reshape(16, 24)
    np.testing.assert_allclose(pin, np.where(made.locks.roots[:, 0] > 0, 0.6, 0.2)[:, None] * np.ones(24), atol=1e-6)


def test_pins_hold_in_contact_as_well(tmp_path):
    made = groom("[[pin]]\nlength = 3\n")
    assert swing(made, "[contact]\nradius = 2e-4\n")[made.locks.point["pin"].reshape(16, 24) == 1].max() < 1e-6


def test_pins_are_written_with_the_groom(tmp_path):
    made = groom("[[pin]]\nlength = 2\nfalloff = 3\n")
    ringlet.write_groom(made, tmp_path / "groom.usdc")
    again = ringlet.read_groom(tmp_path / "groom.usdc")
    np.testing.assert_allclose(again.locks.point["pin"], made.locks.point["pin"], atol=1e-7)


def test_invalid_pins_are_refused():
    for text, words in (("firm = 2", "pin[0].firm is 2; must be at most 1"), ("frim = 1", "did you mean 'firm'")):
        with pytest.raises(UserError) as error:
            parse_recipe(RECIPE + f"[[pin]]\n{text}\n")
        assert words in str(error.value)
    with pytest.raises(UserError, match=r"pin\[0\].mask.region: ball has no region 'hairline'"):
        groom("[[pin]]\nmask = { region = 'hairline' }\n")
