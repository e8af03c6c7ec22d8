"""Pinched hair: what bodies close on stops alone, is stretched little and recovers; all else moves as ever."""

import numpy as np
import pytest
from pinches import NEAR, ball, coil, jaws, shaken


def test_coils_between_closing_jaws_are_neither_stretched_nor_thrown():
    """The jaws wait where the coils leave them no room.

    Eight radii that differ by 10⁻⁶ give largest stretches of 0.02 to 0.13.
    """
    played = jaws()
    assert played.crossings == 0
    assert max(played.lag) > 1e-3
    assert max(played.stretch) < 0.25
    assert max(played.speed) < 3.0


@pytest.fixture(scope="module")
def without_ball():
    return ball(None)


@pytest.mark.parametrize("moves", ["with the head", "by itself"])
def test_a_pinch_changes_no_bit_of_hair_away_from_it(moves, without_ball):
    """A ball goes 5 cm into a head through the hair between them, and leaves."""
    played = ball(moves)
    pinched, free = (np.array(of.positions).reshape(len(of.positions), 2 * NEAR, -1) for of in (played, without_ball))
    assert played.crossings == 0
    assert max(without_ball.lag) == 0.0 and max(played.lag) > 5e-3
    assert np.array_equal(pinched[:, NEAR:], free[:, NEAR:])
    assert np.abs(pinched[:, :NEAR] - free[:, :NEAR]).max() > 1e-2
    assert max(played.stretch) < 0.5
    assert played.lag[-1] == 0.0 and played.stretch[-1] < 0.05


def test_a_pinch_goes_on_from_a_memory_to_the_same_bits():
    """Also while a body lags, which is then not where the step before led it."""
    whole, rest = ball("by itself", 18), ball("by itself", 18, broken_off=15)
    assert whole.lag[14] > 5e-3
    assert np.array_equal(whole.positions[15:], rest.positions)


def test_locks_that_coincide_move_like_one_and_change_no_bit_of_others():
    """A pair without a distance has no direction to part in: it is exempt, and reported."""
    others = [coil(0.05 * k, 0.05) for k in range(4)]
    together, scene = shaken([*others, coil(0.5, 0.5), coil(0.5, 0.5)])
    assert len(scene.coincident) > 0
    together, alone, lone = (
        np.array(of.positions) for of in (together, shaken(others)[0], shaken([coil(0.5, 0.5)])[0])
    )
    assert np.array_equal(together[:, :160], alone)
    assert np.ptp(lone[:, :, 0], axis=0).max() > 1e-3
    assert np.array_equal(together[:, 160:200], lone) and np.array_equal(together[:, 200:], lone)
