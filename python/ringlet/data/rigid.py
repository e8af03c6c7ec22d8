"""The rigid motion that fits points best."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def best_rotation(before: Array, after: Array) -> Array:
    """The rotation of row vectors that takes points nearest to others, both about their centres (Kabsch 1976).

    before, after: corresponding points, shape (..., n, 3). Returns matrices of shape (..., 3, 3).
    """
    before, after = (points - points.mean(axis=-2, keepdims=True) for points in (before, after))
    left, _, right = np.linalg.svd(before.swapaxes(-1, -2) @ after)
    left[..., 2] *= np.sign(np.linalg.det(left @ right))[..., None]  # a rotation, and no mirror image
    return left @ right
