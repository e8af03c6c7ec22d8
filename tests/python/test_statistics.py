"""Statistics of a frame, from the solver's reports of its steps."""

import numpy as np
import pytest
from ringlet.sim.statistics import StepReports, frame_statistics

from ringlet import _core

LOCKS = np.array([4, 7, 9])


def statistics(moved: float, left: float, stalled: tuple[float, ...] = (0, 0, 0), accuracy: float = 5e-4) -> dict:
    """Of a frame of one step."""
    strands = {name: np.zeros(3) for name in _core.REPORT} | {"stalled": np.array(stalled, float)}
    scene = dict.fromkeys(_core.SCENE_REPORT, 0.0) | {"moved": moved, "left": left, "stalled": sum(stalled)}
    return frame_statistics(StepReports([strands], [scene]), LOCKS, [], 0, [], vertices=4, accuracy=accuracy)


def test_locks_that_stalled_are_counted_and_named():
    found = statistics(1.0, 0.0, stalled=(0, 1, 1))
    assert found["stalled"] == 2 and found["stalled_locks"] == [7, 9]


@pytest.mark.parametrize(
    ("moved", "left", "kept"), [(3.0, 1.0, 0.75), (0.0, 2.0, 0.0), (1.0, -1.0, 1.0), (0.0, 0.0, None)]
)
def test_motion_kept_counts_what_is_missing_also_where_nothing_has_moved(moved, left, kept):
    assert statistics(moved, left)["contact"]["motion_kept"] == kept


def test_missing_motion_is_a_distance_with_a_tolerance():
    # Four vertices that went 3 mm each, and of which 1 mm more each is missing.
    contact = statistics(4 * 3e-3**2, 4 * 3e-3 * 1e-3)["contact"]
    assert contact["motion_missing"] == pytest.approx(1e-3)
    assert contact["motion_tolerated"] == pytest.approx(5e-4)
    assert statistics(4 * 0.3**2, 4 * 0.3 * 0.1)["contact"]["motion_tolerated"] == pytest.approx(0.05 * 0.4)
    assert statistics(1.0, 0.0, accuracy=0.2)["contact"]["motion_tolerated"] == 0.2
    nothing_moved = statistics(0.0, 4 * 1e-3**2)["contact"]
    assert nothing_moved["motion_missing"] == pytest.approx(1e-3) and nothing_moved["motion_kept"] == 0.0
