"""The rigid motion that fits points best."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def best_rotation(before: Array, after: Array) -> Array:
    """The rotation of row vectors that takes points nearest to others, both about their centres (Kabsch 1976).

    before, after: corresponding points, shape (n, 3). Returns a matrix of shape (3, 3).
    """
    left, _, right = np.linalg.svd((before - before.mean(axis=0)).T @ (after - after.mean(axis=0)))
    mirror = np.array([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    return left * mirror @ right
