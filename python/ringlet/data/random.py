"""Random numbers by key: (seed, purpose, stable id, column) always gives the same number.

The order of requests does not matter, so adding a guide changes no other lock.
"""

from __future__ import annotations

from hashlib import blake2b

import numpy as np
import scipy
from numpy.typing import NDArray

from ringlet.data.former_names import first_name


def _mix(x: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """The finaliser of SplitMix64 (Steele, Lea and Flood 2014): each bit of the result depends on all bits of x."""
    with np.errstate(over="ignore"):
        x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return x ^ (x >> np.uint64(31))


class Random:
    """The numbers of one purpose, e.g. ``Random(seed, "scraggle")``; a renamed setting keeps its numbers."""

    def __init__(self, seed: int, purpose: str) -> None:
        digest = blake2b(f"{seed}/{first_name(purpose)}".encode(), digest_size=8).digest()
        self._key = np.uint64(int.from_bytes(digest, "little"))

    def _bits(self, ids: NDArray, column: int | NDArray) -> NDArray[np.uint64]:
        golden = np.uint64(0x9E3779B97F4A7C15)
        with np.errstate(over="ignore"):
            rows = _mix(self._key + (np.asarray(ids).astype(np.int64).view(np.uint64) + np.uint64(1)) * golden)
            return _mix(rows + (np.asarray(column).astype(np.uint64) + np.uint64(1)) * golden)

    def uniform(self, ids: NDArray, column: int | NDArray = 0) -> NDArray[np.float64]:
        """One number in [0, 1) per id; another column gives other numbers."""
        return (self._bits(ids, column) >> np.uint64(11)).astype(np.float64) * 2.0**-53

    def uniforms(self, ids: NDArray, columns: int) -> NDArray[np.float64]:
        """Numbers in [0, 1), shape (len(ids), columns)."""
        return self.uniform(np.asarray(ids)[:, None], np.arange(columns)[None, :])

    def normals(self, ids: NDArray, columns: int) -> NDArray[np.float64]:
        """Normally distributed numbers (mean 0, deviation 1), shape (len(ids), columns)."""
        return scipy.special.ndtri(np.maximum(self.uniforms(ids, columns), 1e-12))

    def field(self, places: NDArray, size: float) -> NDArray[np.float64]:
        """A smooth field in space, between -1 and 1, that changes over about ``size`` [m]; places (n, 3) [m]."""
        cell = places / max(size, 1e-9)
        base = np.floor(cell).astype(np.int64)
        t = cell - base
        t = t * t * (3.0 - 2.0 * t)
        total = np.zeros(len(places))
        for corner in range(8):
            bit = np.array([corner & 1, corner >> 1 & 1, corner >> 2 & 1])
            node = base + bit
            name = (node[:, 0] & 0x1FFFFF) | (node[:, 1] & 0x1FFFFF) << 21 | (node[:, 2] & 0x1FFFFF) << 42
            total += np.prod(np.where(bit, t, 1.0 - t), axis=1) * (2.0 * self.uniform(name) - 1.0)
        return total


def soft_threshold(fraction: NDArray, chance: NDArray) -> NDArray[np.float64]:
    """1 where a random number in [0, 1) is below ``fraction``, 0 above it, and linear between for one in 50.

    So the result is continuous in the fraction.
    """
    width = 0.02
    return np.clip(((1.0 + width) * fraction - chance) / width, 0.0, 1.0)
