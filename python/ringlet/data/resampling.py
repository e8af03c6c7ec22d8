"""Resampling of curves by arc length, for values and motion alike."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves, offsets_from_counts


class Resampling:
    """Linear interpolation to ``count`` points on each curve, evenly spaced by arc length in its rest pose.

    The same weights serve attributes of points, and the points of every frame.
    """

    def __init__(self, curves: Curves, count: int) -> None:
        edges = np.linalg.norm(np.diff(curves.points, axis=0, prepend=curves.points[:1]), axis=1)
        edges[curves.offsets[:-1]] = 0.0
        along = np.cumsum(edges)
        first, last = curves.offsets[:-1], curves.offsets[1:] - 1
        start, length = along[first], along[last] - along[first]
        wanted = start[:, None] + length[:, None] * np.linspace(0.0, 1.0, count)
        left = np.searchsorted(along, wanted.ravel(), side="right").reshape(wanted.shape) - 1
        left = np.clip(left, first[:, None], last[:, None] - 1)
        step = along[left + 1] - along[left]
        self._left = left.ravel()
        self._t = np.clip(np.where(step > 0.0, (wanted - along[left]) / np.maximum(step, 1e-300), 0.0), 0, 1).ravel()
        self._count = count

    def values(self, values: NDArray) -> NDArray:
        """Values at the points, shape (n, …), as values at the new ones; whole numbers from the point before."""
        if values.dtype.kind not in "f":
            return values[self._left]
        t = self._t.reshape(-1, *[1] * (values.ndim - 1))
        mixed = (1.0 - t) * values[self._left] + t * values[self._left + 1]
        return mixed.astype(values.dtype)

    def curves(self, curves: Curves) -> Curves:
        """The curves with as many points each."""
        return Curves(
            self.values(curves.points),
            offsets_from_counts(np.full(len(curves), self._count)),
            curves.ids,
            curves.curve,
            {name: self.values(values) for name, values in curves.point.items()},
        )
