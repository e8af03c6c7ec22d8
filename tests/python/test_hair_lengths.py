"""The lengths of hairs that leave are judged against those in the groom."""

import numpy as np
import pytest
from ringlet.data.curves import Curves
from ringlet.deform.lengths import SAMPLE, HairLengths


def curves(count):
    """Hairs of 2 to 4 points, 1 cm an edge."""
    return Curves.from_list([np.c_[0.01 * np.arange(2 + k % 3), np.full((2 + k % 3, 2), k)] for k in range(count)])


def test_the_hair_that_changes_most_is_found_with_its_frame():
    hairs = curves(5)
    lengths = HairLengths(hairs)
    lengths.add(1.0, hairs.points)
    assert lengths.change == pytest.approx(0.0, abs=1e-12)
    longer, shorter = hairs.points.copy(), hairs.points.copy()
    longer[hairs.offsets[3] : hairs.offsets[4], 0] *= 1.2
    shorter[hairs.offsets[1] : hairs.offsets[2], 0] *= 0.7
    for frame, points in ((2.0, longer), (3.0, shorter), (4.0, hairs.points)):
        lengths.add(frame, points)
    assert (lengths.change, lengths.frame, lengths.hair) == (pytest.approx(0.3), 3.0, 1)


def test_of_many_hairs_a_sample_from_first_to_last_is_measured():
    hairs = curves(3 * SAMPLE)
    lengths = HairLengths(hairs)
    lengths.add(1.0, np.where(np.arange(len(hairs.points))[:, None] >= hairs.offsets[-2], 2.0, 1.0) * hairs.points)
    assert lengths.hair == len(hairs) - 1 and lengths.change > 0.5


def test_there_may_be_no_hair():
    lengths = HairLengths(curves(0))
    lengths.add(1.0, np.zeros((0, 3)))
    assert lengths.change == 0.0
