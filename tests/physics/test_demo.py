"""The demo begins with its groom, and its ringlets bounce; tests/proof/test_whole_demo.py has all of them."""

import numpy as np
import pytest
from bouncing import clip, shot_and_groom

import ringlet

HOP = (34, 46)  # frames


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return shot_and_groom(tmp_path_factory.mktemp("demo"), 30)


def test_the_hair_of_the_demo_hangs_as_groomed_when_the_clip_begins(made):
    """Within 0.1 mm after half a second; the groom as its own rest shape sags by centimetres."""
    shot, groom = made
    shot = shot.model_copy(update={"preroll": 12})
    moved = ringlet.simulate(shot, groom, frames=(1, 1)).points[-1] - groom.locks.points
    assert np.linalg.norm(moved, axis=1).max() < 1e-4


def test_ringlets_open_and_close_in_the_hop(made, tmp_path):
    shot, groom = made
    words = clip(tmp_path, shot.model_copy(update={"frames": HOP}), groom).words
    opens, closes = (words[name].found for name in ("opens", "closes"))
    assert np.median(opens) > 0.08 and np.percentile(opens, 90) > 0.15
    assert np.median(closes) < -0.08 and np.percentile(closes, 10) < -0.15
