"""Thinning: the part of the hairs of each lock that is made."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def thinned(full: NDArray[np.int64], fraction: float) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """How many hairs of each lock are made, at least 1, shape (locks,), and their rows among all hairs, shape (hairs,).

    Hairs are numbered from the middle of their lock outwards. Those that are made are even over its cross-section, by
    the van der Corput sequence of their numbers, so that a lock keeps its thickness. A smaller fraction has some of the
    hairs of a larger one; the first of a lock is in all.

    full: hairs of each lock, shape (locks,); all hairs follow one another lock by lock
    """
    counts = np.maximum(1, np.round(full * fraction)).astype(np.int64)
    lock = np.repeat(np.arange(len(full)), full)
    rank = np.arange(len(lock)) - np.repeat(np.cumsum(full) - full, full)
    order = np.lexsort((_van_der_corput(rank), lock))
    return counts, np.sort(order[rank < counts[lock]])


def _van_der_corput(number: NDArray[np.int64]) -> NDArray[np.float64]:
    """Numbers with their binary digits mirrored at the point, in [0, 1)."""
    result, weight = np.zeros(len(number)), 0.5
    while number.any():
        result += weight * (number & 1)
        number, weight = number >> 1, 0.5 * weight
    return result
