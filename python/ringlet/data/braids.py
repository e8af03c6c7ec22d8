"""Braids, twists and locs: the locks with a radius of their own, and where they fold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.groom import SECTION
from ringlet.data.thickness import own_radii

COS_TURN = -0.5  # of 120°; the rope of a Bantu knot turns by 110° where its coil begins


@dataclass(frozen=True)
class Braids:
    """The strands of locks that have a radius of their own; those of one section are a braid, a loc is one alone.

    locks:   all locks, in the groom
    rows:    of the strands, shape (strands,), those of a braid one after another
    offsets: of the points of each braid's middle, shape (braids + 1,)
    point:   per point of the strands its row among ``locks.points``, shape (k,)
    middle:  and the point of the middle of its braid, shape (k,)
    radius:  of the strand there [m], shape (k,)
    """

    locks: Curves
    rows: NDArray[np.int64]
    offsets: NDArray[np.int32]
    point: NDArray[np.int64]
    middle: NDArray[np.int64]
    radius: NDArray[np.float64]

    @classmethod
    def of(cls, locks: Curves) -> Braids:
        """The braids among locks. Strands of a section that differ in their number of points are each for itself."""
        radii = own_radii(locks)
        thick = np.flatnonzero(np.maximum.reduceat(radii, locks.offsets[:-1]) > 0.0) if len(locks) else np.zeros(0, int)
        section = np.asarray(locks.curve.get(SECTION, np.full(len(locks), -1)), np.int64)[thick]
        alone = np.where(section < 0, np.arange(len(thick)), -1)
        _, first, braid = np.unique(
            np.stack([section, locks.counts[thick], alone]), axis=1, return_index=True, return_inverse=True
        )
        order = np.argsort(braid.ravel(), kind="stable")
        rows, braid = thick[order], braid.ravel()[order]
        offsets = offsets_from_counts(locks.counts[thick[first]])
        point = locks.point_rows(rows)
        along = np.concatenate([np.arange(count) for count in locks.counts[rows]] or [np.zeros(0, int)])
        middle = np.asarray(np.repeat(offsets[:-1][braid], locks.counts[rows]) + along, np.int64)
        return cls(locks, rows, offsets, point, middle, radii[point])

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def of_points(self, points: NDArray[np.bool_]) -> NDArray[np.int64]:
        """The braids, by their number, that have a strand with one of these points, shape (n,) of all locks."""
        return np.unique(np.searchsorted(self.offsets, self.middle[points[self.point]], side="right") - 1)

    def folded(self, points: NDArray[np.floating]) -> NDArray[np.bool_]:
        """Where strands fold if the locks have those points [m], shape (n, 3); per point of the locks, shape (n,).

        A strand folds where it runs backwards along its braid over more than its own width, or where the braid turns
        by over 120° within its width.
        """
        folded = np.zeros(len(points), bool)
        if not len(self.rows):
            return folded
        at = np.asarray(points[self.point], np.float64)
        strands = np.bincount(self.middle)
        line = np.stack([np.bincount(self.middle, at[:, k]) for k in range(3)], axis=1) / strands[:, None]
        width = np.zeros(len(line))
        np.maximum.at(width, self.middle, np.linalg.norm(at - line[self.middle], axis=1) + self.radius)
        along, run = _edges(line, self.offsets)
        folded[self.point] = _turns(along, run, self.offsets, width)[self.middle]

        counts = self.locks.counts[self.rows]
        edges, length = _edges(at, offsets_from_counts(counts))
        back = np.einsum("ni,ni->n", edges, along[self.middle]) < 0.0
        starts = back & ~np.concatenate([[False], back[:-1]])
        stretch = np.cumsum(starts) - 1  # the number of the backward stretch that an edge is in
        edge = np.diff(length, append=length[-1:])
        long = np.bincount(stretch[back], np.maximum(edge[back], 0.0), minlength=starts.sum())
        back[back] = long[stretch[back]] > 2.0 * self.radius[back]
        folded[self.point] |= back
        return folded


def _edges(points: NDArray[np.float64], offsets: NDArray[np.integer]) -> tuple[NDArray, NDArray[np.float64]]:
    """Directions of the edges that begin at points, 0 at the last of a curve, and lengths before points [m]."""
    edges = np.diff(points, axis=0, append=points[-1:])
    edges[offsets[1:] - 1] = 0.0
    length = np.linalg.norm(edges, axis=1)
    return edges / np.maximum(length, 1e-12)[:, None], np.cumsum(length) - length


def _turns(
    along: NDArray, run: NDArray[np.float64], offsets: NDArray[np.integer], width: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Whether curves turn by over 120° from half their width before a point to half their width after it."""
    counts, points = np.diff(offsets), np.arange(len(run))
    first, last = np.repeat(offsets[:-1], counts), np.repeat(offsets[1:] - 2, counts)
    before, after = (np.searchsorted(run, run + sign * 0.5 * width, side="right") - 1 for sign in (-1.0, 1.0))
    before = np.clip(np.minimum(before, points - 1), first, last)
    after = np.clip(np.maximum(after, points), first, last)
    return np.einsum("ni,ni->n", along[before], along[after]) < COS_TURN
