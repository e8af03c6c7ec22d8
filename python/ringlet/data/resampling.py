"""Resampling of curves by arc length, for values and motion alike."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.hair_scene import CurveSet


class Resampling:
    """Linear interpolation to points that are evenly spaced by arc length on each curve in its rest pose.

    The same weights serve attributes of points, and the points of every frame.

    counts: points of each curve: a number, or shape (curves,)
    """

    def __init__(self, curves: Curves, counts: int | NDArray) -> None:
        self.offsets = offsets_from_counts(np.broadcast_to(counts, len(curves)))
        self._left, self._t = _between(curves, self.offsets, _even(self.offsets))

    @classmethod
    def at_most(cls, curves: Curves, most: int) -> Resampling:
        """Resampling of curves of more points than ``most`` to as many; the others keep theirs."""
        made, counts = cls(curves, np.minimum(curves.counts, most)), curves.counts
        kept, points = (np.repeat(counts <= most, of) for of in (np.diff(made.offsets), counts))
        rows, last = np.flatnonzero(points), np.repeat(curves.offsets[1:] - 1, counts)[points]
        made._left[kept], made._t[kept] = np.minimum(rows, last - 1), rows == last
        return made

    def values(self, values: NDArray) -> NDArray:
        """Values at the points, shape (n, …), as values at the new ones; whole numbers from the point before."""
        if values.dtype.kind not in "f":
            return values[self._left]
        return _mixed(values, self._left, self._t)

    def curves(self, curves: Curves) -> Curves:
        """The curves with as many points each."""
        return Curves(
            self.values(curves.points),
            self.offsets,
            curves.ids,
            curves.curve,
            {name: self.values(values) for name, values in curves.point.items()},
        )

    def curve_set(self, one: CurveSet) -> CurveSet:
        """The set of these curves, with the motion of the new points."""
        motion = one.motion
        moved = None if motion is None else (lambda frame: self.values(motion(frame)))
        return replace(one, curves=self.curves(one.curves), motion=moved)

    def deviation(self, curves: Curves) -> float:
        """The largest distance of a point of the curves from the new curve, at the same part of its length [m]."""
        made, along = self.curves(curves), _arc_lengths(curves)
        root, tip = (np.repeat(along[rows], curves.counts) for rows in (curves.offsets[:-1], curves.offsets[1:] - 1))
        place = _between(made, curves.offsets, (along - root) / np.maximum(tip - root, 1e-300))
        return float(np.linalg.norm(_mixed(made.points, *place) - curves.points, axis=1).max())


def _even(offsets: NDArray[np.int32]) -> NDArray[np.float64]:
    """Parts of the length of each curve, from 0 at its root to 1 at its tip, at even steps."""
    counts = np.diff(offsets)
    return (np.arange(offsets[-1]) - np.repeat(offsets[:-1], counts)) / np.repeat(counts - 1, counts)


def _between(curves: Curves, offsets: NDArray, parts: NDArray) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """The points before places on curves, and how far each place is towards the next point, 0 to 1.

    offsets: of the places of each curve, shape (curves + 1,)
    parts:   places by parts of the length of the curve, shape (places,)
    """
    along, counts = _arc_lengths(curves), np.diff(offsets)
    first, last = np.repeat(curves.offsets[:-1], counts), np.repeat(curves.offsets[1:] - 1, counts)
    wanted = along[first] + (along[last] - along[first]) * parts
    left = np.clip(np.searchsorted(along, wanted, side="right") - 1, first, last - 1)
    step = along[left + 1] - along[left]
    return left, np.clip(np.where(step > 0.0, (wanted - along[left]) / np.maximum(step, 1e-300), 0.0), 0.0, 1.0)


def _mixed(values: NDArray, left: NDArray, t: NDArray) -> NDArray:
    t = t.reshape(-1, *[1] * (values.ndim - 1))
    return ((1.0 - t) * values[left] + t * values[left + 1]).astype(values.dtype)


def _arc_lengths(curves: Curves) -> NDArray[np.float64]:
    """Arc length over all curves, one after another, at each point [m], shape (points,)."""
    edges = np.linalg.norm(np.diff(curves.points, axis=0, prepend=curves.points[:1]), axis=1)
    edges[curves.offsets[:-1]] = 0.0
    return np.cumsum(edges)
