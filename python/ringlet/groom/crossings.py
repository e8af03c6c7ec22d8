"""Where locks come nearer to one another, or to themselves, than they are thick."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from ringlet.curves import Curves

Array = NDArray[np.float64]

SKIN = 2.5e-4  # points may move so far before pairs are looked for again [m]
OF_ONE_LOCK = 4.0  # pieces of one lock are compared when they are so many thicknesses apart along it


@dataclass
class Close:
    """Pairs of edges that are too near.

    edges:    the first points of the two edges, shape (k, 2), indices into the points of the locks
    at:       where on the edges they are nearest, 0 to 1, shape (k, 2)
    apart:    from the one nearest place to the other [m], shape (k, 3)
    distance: length of that [m], shape (k,)
    """

    edges: NDArray[np.int64]
    at: Array
    apart: Array
    distance: Array

    def within(self, distance: float) -> Close:
        """Those that are nearer than a distance [m]."""
        near = self.distance < distance
        return Close(self.edges[near], self.at[near], self.apart[near], self.distance[near])


class Neighbours:
    """Pairs of edges that may come near: found once, and again only when points have moved far.

    thickness: edges nearer than this are too near [m]
    """

    def __init__(self, locks: Curves, thickness: float) -> None:
        self.locks, self.thickness = locks, thickness
        last = np.zeros(len(locks.points), bool)
        last[locks.offsets[1:] - 1] = True
        self._first = np.flatnonzero(~last)
        self._lock = np.searchsorted(locks.offsets, self._first, side="right") - 1
        self._seen: Array | None = None
        self._pairs = np.zeros((0, 2), np.int64)

    def close(self, points: NDArray[np.floating]) -> Close:
        """All pairs of edges that are too near with the points there [m], shape (n, 3)."""
        points = np.asarray(points, np.float64)
        if self._seen is None or np.linalg.norm(points - self._seen, axis=1).max(initial=0.0) > SKIN:
            self._seen = points.copy()
            found = self._measured(points, self._candidates(points), self.thickness + 2.0 * SKIN)
            self._pairs = np.unique(np.sort(np.searchsorted(self._first, found.edges), axis=1), axis=0)
        return self._measured(points, self._pairs, self.thickness)

    def _candidates(self, points: Array) -> NDArray[np.int64]:
        """Pairs of edges that may be near, shape (k, 2), some twice. Long edges are cut into pieces, so that the
        balls around pieces are small."""
        start, way = points[self._first], points[self._first + 1] - points[self._first]
        length = np.linalg.norm(way, axis=1)
        pieces = np.maximum(1, np.ceil(length / max(float(np.median(length)), 1e-6))).astype(np.int64)
        edge = np.repeat(np.arange(len(way)), pieces)
        step = np.arange(len(edge)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
        middle, half = start[edge] + ((step + 0.5) / pieces[edge])[:, None] * way[edge], 0.5 * (length / pieces)[edge]
        within = self.thickness + 2.0 * SKIN
        a, b = KDTree(middle).query_pairs(2.0 * float(half.max()) + within, output_type="ndarray").T
        i, j = edge[a], edge[b]
        other = self._lock[i] != self._lock[j]
        run = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
        gap = np.abs(run[self._first[j]] - run[self._first[i]]) - np.where(i < j, length[i], length[j])
        other |= (np.abs(i - j) > 1) & (gap > OF_ONE_LOCK * self.thickness)
        a, b = a[other], b[other]
        near = np.sum((middle[a] - middle[b]) ** 2, axis=1) <= (half[a] + half[b] + within) ** 2
        return np.stack([edge[a[near]], edge[b[near]]], axis=1)

    def _measured(self, points: Array, pairs: NDArray[np.int64], within: float) -> Close:
        """Of pairs of edges those that are nearer than ``within``."""
        first = self._first[pairs]
        start, way = points[first], points[first + 1] - points[first]
        s, t = _nearest_places(start[:, 0], way[:, 0], start[:, 1], way[:, 1])
        apart = start[:, 1] + t[:, None] * way[:, 1] - start[:, 0] - s[:, None] * way[:, 0]
        distance = np.linalg.norm(apart, axis=1)
        close = distance < within
        return Close(first[close], np.stack([s, t], axis=1)[close], apart[close], distance[close])


def _nearest_places(p: Array, u: Array, q: Array, v: Array) -> tuple[Array, Array]:
    """Where segments p + s u and q + t v are nearest (Lumelsky 1985), shape (n,) each."""
    w = p - q
    a, b, c, d, e = (np.einsum("nx,nx->n", *pair) for pair in ((u, u), (u, v), (v, v), (u, w), (v, w)))
    determinant = a * c - b * b
    parallel = determinant <= 1e-12 * a * c
    s = np.clip(np.where(parallel, 0.0, (b * e - c * d) / np.where(parallel, 1.0, determinant)), 0.0, 1.0)
    t = np.clip((b * s + e) / np.maximum(c, 1e-30), 0.0, 1.0)
    return np.clip((b * t - d) / np.maximum(a, 1e-30), 0.0, 1.0), t
