"""Smooth noise along each lock, a cubic B-spline."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.random import Random


def wander(random: Random, ids: NDArray, along: NDArray, wavelength: float) -> NDArray[np.float64]:
    """Noise of deviation 1 and of that wavelength [m] that is 0 at the root, shape (count, points, 3).

    The knots are normally distributed and independent per lock.

    along: arc length from the root [m], shape (count, points)
    """
    at = along / wavelength
    knot_count = int(at.max()) + 4
    knots = random.normals(ids, 3 * knot_count).reshape(len(ids), knot_count, 3)
    i = at.astype(int)
    t = (at - i)[:, :, None]
    rows = np.arange(len(ids))[:, None]
    a, b, c, d = (knots[rows, i + k] for k in range(4))
    noise = (
        ((-t + 3.0) * t - 3.0) * t + 1.0,
        (3.0 * t - 6.0) * t * t + 4.0,
        ((-3.0 * t + 3.0) * t + 3.0) * t + 1.0,
        t**3,
    )
    spline = (noise[0] * a + noise[1] * b + noise[2] * c + noise[3] * d) / 6.0
    return 1.5 * (spline - spline[:, :1])
