"""Winding numbers of surfaces."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def winding_numbers(points: Array, corners: Array) -> Array:
    """Winding numbers of triangles (m, 3, 3) about points, shape (n,): Σ Ω / 4π (Jacobson et al. 2013, eq. 5)."""
    numbers = np.empty(len(points))
    for k, point in enumerate(points):
        a, b, c = (corners[:, i] - point for i in range(3))
        la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
        volume = np.einsum("ni,ni->n", a, np.cross(b, c))
        dots = (np.einsum("ni,ni->n", u, v) * w for u, v, w in ((a, b, lc), (b, c, la), (c, a, lb)))
        numbers[k] = 2.0 * np.arctan2(volume, la * lb * lc + sum(dots)).sum() / (4.0 * np.pi)
    return numbers
