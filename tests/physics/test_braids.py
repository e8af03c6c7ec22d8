"""Contact holds the strands of braids and twists together: on a nodding head they keep their words."""

import numpy as np
import pytest
from braids import played, start


@pytest.mark.parametrize("style", ["braids", "twists"])
def test_braids_on_a_nodding_head_keep_their_word(style):
    """`tools/proof/braids.py` plays all sections and 48 frames."""
    motion, groom = start(style, "z < -5 and y > 5")
    states = list(played(motion, groom, 20))
    assert 4 <= len(states[0].radius) <= 12
    assert all(state.crossings == 0 and state.changed == 0 for state in states)
    radius = np.array([state.radius for state in states])
    assert np.median(radius) < 1.03  # their bands hold their ends together
    assert np.mean(radius > 1.15) < 0.03  # of twists 1 to 4 of 200, by velocities that differ by 10⁻⁸ m/s
    assert radius.max() < 1.25
    assert max(state.max_stretch for state in states) < 0.05
