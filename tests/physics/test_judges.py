"""The judges of contact: linking numbers and continuous collision detection by ipctk."""

import numpy as np
import pytest
from coils import helix, rotation
from contact_scenes import hooked_strands
from crossings import Judge
from linking import linking


@pytest.mark.parametrize("turns", [1, 2, 3])
def test_the_linking_number_counts_turns(turns):
    """A coil around a ring has its turns as the linking number, a coil beside the ring has 0."""
    angle = 2 * np.pi * np.arange(40) / 40
    ring = np.c_[np.cos(angle), np.sin(angle), 0 * angle]
    coil = helix(12 * turns, radius=0.4, pitch=0.0) + [1, 0, 0]
    assert abs(linking(ring, coil)) == pytest.approx(turns, abs=1e-9)
    assert linking(ring, coil + [2, 0, 0]) == pytest.approx(0, abs=1e-9)


def test_ipctk_detects_strands_that_pass_through_each_other():
    """Hooked strands that are moved through each other cross; a rest and a common translation do not."""
    trial = hooked_strands()
    judge, before = Judge(trial.scene), trial.scene.positions.copy()
    after = before.copy()
    after[: len(after) // 2] += [0, 0.05, 0]
    assert judge.crossings(before, before) == 0
    assert judge.crossings(before, after) > 0
    assert judge.crossings(before, before + [0, 0.05, 0]) == 0


def test_a_path_begins_where_everything_has_moved_rigidly():
    """Else how it got there is judged like any move."""
    trial = hooked_strands()
    judge, before = Judge(trial.scene), trial.scene.positions.copy()
    turned = before @ rotation([0, 1, 1], 2.0).T
    after = before.copy()
    after[: len(after) // 2] += [0, 0.05, 0]
    assert judge.crossings_of_step(before, [turned, turned]) == 0
    assert judge.crossings_of_step(before, [after, after]) > 0
