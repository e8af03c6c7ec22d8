"""Ramps from root to tip, against the monotone cubics of SciPy."""

from __future__ import annotations

import numpy as np
import pytest
from ringlet.data.quantities import along
from scipy.interpolate import PchipInterpolator

FACTORS = [0.0, 0.2, 0.5, 1.0, 1.0, 2.0, 1e3]  # with flat pieces, peaks and valleys


@pytest.mark.parametrize("places", range(2, 8))
def test_a_ramp_is_a_monotone_cubic(places):
    random = np.random.default_rng(places)
    for _ in range(100):
        at, factor = np.sort(random.random(places)), random.choice(FACTORS, places)
        u = np.concatenate([np.linspace(0.0, 1.0, 33), at])
        expected = PchipInterpolator(at, factor)(np.clip(u, at[0], at[-1]))
        np.testing.assert_allclose(along(list(zip(at, factor, strict=True)), u), expected, rtol=1e-9, atol=1e-9)


def test_a_ramp_of_one_place_is_constant():
    assert along([(0.3, 0.7)], np.array([0.0, 0.3, 1.0])).tolist() == [0.7, 0.7, 0.7]
