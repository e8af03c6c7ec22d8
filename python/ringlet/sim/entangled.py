"""Braids whose strands run through those of other braids."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from ringlet.data.braids import Braids

Array = NDArray[np.float64]


class Entangled:
    """The depth of carried strands in the strands of other braids, besides what it is in the groom.

    braids:  all braids, twists and locs
    carried: the points of strands that cores carry, per point of all locks, shape (n,)
    """

    def __init__(self, braids: Braids, carried: NDArray[np.bool_]) -> None:
        self._point, self._radius, self._carried = braids.point, braids.radius, carried[braids.point]
        self._braid = np.searchsorted(braids.offsets, braids.middle, side="right") - 1
        strand = np.searchsorted(braids.locks.offsets, braids.point, side="right")
        self._follows = np.append(strand[1:] == strand[:-1], False)  # the points that another of the strand follows
        self._braids, self._groomed = len(braids), (np.zeros(0, np.int64), np.zeros(0))
        _, pair, depth = self._places(np.asarray(braids.locks.points, np.float64))
        self._groomed = _deepest(pair, depth)

    def depths(self, points: Array, least: float) -> Array:
        """The depth of points in strands of other braids, for locks at positions [m]; shape (n,).

        0 in a braid in which theirs is nowhere deeper by ``least`` than in the groom.
        """
        found = np.zeros(len(points))
        point, pair, depth = self._places(points)
        pairs, most = _deepest(pair, depth)
        groomed, was = self._groomed
        at = np.minimum(np.searchsorted(groomed, pairs), max(len(groomed) - 1, 0))
        before = np.where(groomed[at] == pairs, was[at], 0.0) if len(groomed) else np.zeros(len(pairs))
        deeper = np.isin(pair, pairs[most > before + least]) & (depth > least)
        np.maximum.at(found, point[deeper], depth[deeper])
        return found

    def _places(self, points: Array) -> tuple[NDArray[np.int64], NDArray[np.int64], Array]:
        """Carried points inside a strand of another braid: the point, the pair of braids, and the depth [m]."""
        x = points[self._point]
        edges = np.where(self._follows[:, None], np.roll(x, -1, axis=0) - x, 0.0)
        length = np.linalg.norm(edges, axis=1)
        near = KDTree(x).query_pairs(float(np.max(self._radius + 0.5 * length, initial=0.0)), output_type="ndarray")
        near = near[self._braid[near[:, 0]] != self._braid[near[:, 1]]]
        near = np.concatenate([near, near[:, ::-1]])
        a, b = near[self._carried[near[:, 0]]].T
        distance = np.full(len(a), np.inf)
        for begin in (b, b - 1):  # the edges that meet at b
            t = np.einsum("ni,ni->n", x[a] - x[begin], edges[begin]) / np.maximum(length[begin] ** 2, 1e-24)
            foot = x[begin] + np.clip(t, 0.0, 1.0)[:, None] * edges[begin]
            there = self._follows[begin]
            distance[there] = np.minimum(distance, np.linalg.norm(x[a] - foot, axis=1))[there]
        depth = self._radius[b] - distance
        inside = depth > 0.0
        a, b, depth = a[inside], b[inside], depth[inside]
        ends = np.sort(np.stack([self._braid[a], self._braid[b]]), axis=0)
        return self._point[a], ends[0] * self._braids + ends[1], depth


def _deepest(pair: NDArray[np.int64], depth: Array) -> tuple[NDArray[np.int64], Array]:
    """The pairs, ascending, and the greatest depth of each."""
    pairs, row = np.unique(pair, return_inverse=True)
    most = np.zeros(len(pairs))
    np.maximum.at(most, row, depth)
    return pairs, most
