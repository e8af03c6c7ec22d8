"""Thinning: the part of the hairs of each lock that is made, or drawn at a time."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def thinned(full: NDArray[np.int64], fraction: float) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """How many hairs of each lock are made, at least 1, shape (locks,), and their rows among all hairs, shape (hairs,).

    A lock keeps its thickness, as ``ranks`` says. A smaller fraction has some of the hairs of a larger one; the first
    of a lock is in all.

    full: hairs of each lock, shape (locks,); all hairs follow one another lock by lock
    """
    counts = np.maximum(1, np.round(full * fraction)).astype(np.int64)
    return counts, np.flatnonzero(ranks(full) < np.repeat(counts, full))


def spread(counts: NDArray[np.integer]) -> NDArray[np.intp]:
    """Order of hairs in which some that follow one another are as large a part of each lock; shape (hairs,).

    counts: hairs of each lock, shape (locks,); all hairs follow one another lock by lock
    """
    lock = np.repeat(np.arange(len(counts)), counts)
    return np.argsort((ranks(counts) + _van_der_corput(lock)) / counts[lock], kind="stable")


def ranks(counts: NDArray[np.integer]) -> NDArray[np.int64]:
    """Ranks of hairs in their lock, from 0, shape (hairs,): successive ones are even over its cross-section.

    Hairs are numbered from the middle of their lock outwards, and ranked by the van der Corput sequence of the numbers.

    counts: as in ``spread``
    """
    lock = np.repeat(np.arange(len(counts)), counts)
    number = np.arange(len(lock)) - np.repeat(np.cumsum(counts) - counts, counts)
    result = np.empty_like(number)
    result[np.lexsort((_van_der_corput(number), lock))] = number
    return result


def _van_der_corput(number: NDArray[np.int64]) -> NDArray[np.float64]:
    """Numbers with their binary digits mirrored at the point, in [0, 1)."""
    result, weight = np.zeros(len(number)), 0.5
    while number.any():
        result += weight * (number & 1)
        number, weight = number >> 1, 0.5 * weight
    return result
