"""Strands released from abuse come back to rest, gain no energy, and go no further than their start allows."""

import numpy as np
import pytest
from stability import CLOSE, release, scenes

NAMES = [name for name, _, _ in scenes()]


@pytest.fixture(scope="module", params=[(5, 24.0), (5, 12.0)], ids=["24 steps a second", "12 steps a second"])
def released(request):
    newton, fps = request.param
    return release(newton=newton, fps=fps)


def listed(bad):
    return [name for name, is_bad in zip(NAMES, bad, strict=True) if is_bad]


def test_every_scene_comes_back_to_rest(released):
    assert not listed(~(released.away < CLOSE))


def test_no_scene_gains_energy(released):
    """To one part in a million of what the start held, and never a number that is not finite."""
    assert not listed(~(released.gain < 1e-6))


def test_no_scene_is_thrown_further_than_its_coil_is_long(released):
    lengths = np.array([np.linalg.norm(np.diff(rest, axis=0), axis=1).sum() for _, rest, _ in scenes()])
    begin = np.array([np.linalg.norm(start - rest, axis=1).max() for _, rest, start in scenes()])
    assert not listed(released.excursion * begin > lengths)


def test_one_newton_step_a_step_stays_stable():
    """It may take longer, but nothing is thrown about and nothing breaks."""
    result = release(newton=1, steps=300)
    assert not listed(~(result.gain < 2e-3))
    assert np.isfinite(result.away).all()


def test_what_the_frame_is_good_for():
    """Signs alone lose a coil whose middle is straight; the material frame does not."""
    middle = [name.startswith("coil with straight middle") for name in NAMES]
    assert (release(continuation="least_energy").away[middle] > 10 * CLOSE).any()
