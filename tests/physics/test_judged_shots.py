"""Nothing passes through anything in shots of the example, says ipctk; `judged_shots.py` plays all of them."""

import pytest
from judged_shots import SHOTS, judged, start


@pytest.mark.parametrize("shot", SHOTS)
def test_nothing_passes_through_anything_in_a_shot_of_the_example(shot):
    """Its first frames, with a part of the locks."""
    motion = start(shot, locks=100)
    frames = list(judged(motion, 3))
    assert len(frames) == 3
    assert all(frame.crossings == 0 and frame.statistics["nan"] == 0 for frame in frames)
    assert all(frame.statistics["contact"]["candidates"] > 0 for frame in frames)
