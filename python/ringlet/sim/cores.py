"""Cores: braids that are simulated as one rod each, which carries their strands."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.groom import CORE, SECTION, STRAND_RADIUS, WORN_MASS, WORN_RADIUS, Groom
from ringlet.data.smooth_step import smooth_step
from ringlet.sim.inextensible import along_paths
from ringlet.sim.roots import Roots

Array = NDArray[np.float64]

ADD_UP = "borne", WORN_MASS  # attributes of points: the sum over its strands is that of a core
ROOT_REACH = 4.0  # length along a strand over which its root moves it, in distances of the root from that of the core


@dataclass(frozen=True)
class Cores:
    """The locks of a groom, and the fewer that are simulated: all but the strands of cores, then the cores.

    groom:     with the locks that are simulated. A core is the mean of its strands; it has the id, the root and the
               attributes of the first, and a radius that covers all
    whole:     with all locks
    of_core:   per lock of the whole groom the core that carries it; −1: it is simulated itself, shape (count,)
    simulated: per lock of the whole groom the row of it, or of its core, among those simulated, shape (count,)
    """

    groom: Groom
    whole: Groom
    of_core: NDArray[np.int64]
    simulated: NDArray[np.int64]

    @classmethod
    def of(cls, groom: Groom) -> Cores:
        """The cores of a groom: the strands of each section whose locks have the attribute ``core``."""
        locks = groom.locks
        marked = np.asarray(locks.curve.get(CORE, np.zeros(len(locks))), bool)
        of_core = np.full(len(locks), -1, np.int64)
        if marked.any():
            of_core[marked] = np.unique(locks.curve[SECTION][marked], return_inverse=True)[1]
        alone = np.flatnonzero(of_core < 0)
        simulated = np.where(of_core < 0, np.cumsum(of_core < 0) - 1, len(alone) + of_core)
        cores = cls(groom, groom, of_core, simulated)
        return cores if not marked.any() else replace(cores, groom=replace(groom, locks=cores.reduced(locks)))

    @property
    def count(self) -> int:
        """The number of cores."""
        return int(self.of_core.max(initial=-1)) + 1

    @property
    def strands(self) -> NDArray[np.int64]:
        """The number of strands of each lock that is simulated, shape (locks,)."""
        return np.bincount(self.simulated, minlength=len(self.groom.locks))

    def reduced(self, curves: Curves) -> Curves:
        """Of curves for all locks those that are simulated; forces and masses at points add up in a core."""
        if not self.count:
            return curves
        alone = curves.take(np.flatnonzero(self.of_core < 0))
        parts = [alone]
        for core in range(self.count):
            rows = np.flatnonzero(self.of_core == core)
            strands = [curves.take(rows[k : k + 1]) for k in range(len(rows))]
            middle = np.mean([np.asarray(strand.points, np.float64) for strand in strands], axis=0)
            of_curve, of_point = dict(strands[0].curve), dict(strands[0].point)
            away = np.array([np.linalg.norm(s.points - middle, axis=1) for s in strands], np.float32)
            if STRAND_RADIUS in of_curve:
                of_curve[STRAND_RADIUS] = of_curve[STRAND_RADIUS] + np.median(away.max(axis=0))
            for name in of_point:
                all_of_them = np.array([strand.point[name] for strand in strands])
                of_point[name] = all_of_them.sum(axis=0) if name in ADD_UP else all_of_them.max(axis=0)
            if WORN_RADIUS in of_point:
                outer = [
                    np.where(s.point[WORN_RADIUS] > 0.0, s.point[WORN_RADIUS], -out) + out
                    for s, out in zip(strands, away, strict=True)
                ]
                of_point[WORN_RADIUS] = np.max(outer, axis=0)
            parts.append(Curves(middle, strands[0].offsets, strands[0].ids, of_curve, of_point))
        return _joined(parts)

    def material(self) -> dict[str, Array]:
        """Factors on the material at the vertices of simulated locks: a core has the mass, and resists stretch, bend
        and twist, as its strands side by side do. Shapes (n,)."""
        if not self.count:
            return {}
        strands = np.repeat(self.strands.astype(np.float64), self.groom.locks.counts)
        # Stiffness against bend and twist goes by the fourth power of the radius, mass and stretch by the second.
        return {"radius": np.sqrt(strands), "bend": 1.0 / strands, "twist": 1.0 / strands}

    def spread(self, values: NDArray) -> NDArray:
        """Values at the vertices of simulated locks, shape (n, …), at those of all locks; a strand has its core's."""
        if not self.count:
            return values
        offsets = self.groom.locks.offsets
        return np.concatenate([values[offsets[row] : offsets[row + 1]] for row in self.simulated])

    def carried(self, points: Array, scalp: Array, frame: float) -> Array:
        """Points of all locks [m], shape (n, 3), for those of the simulated ones at ``frame`` on the scalp's points.

        ``p = c + f o + R q``: the core c carries the path q of a strand across the braid in its frames R. Near the
        scalp the strand begins at its own root, o away from that of the core: f falls from 1 to 0. Edges keep their
        groomed lengths.
        """
        if not self.count:
            return points
        locks, whole = self.groom.locks, self.whole.locks
        roots = self._roots.carry(scalp, frame)[whole.offsets[:-1]]
        away = np.repeat(roots - points[locks.offsets[:-1]][self.simulated], whole.counts, axis=0)
        turn = self._frames(points, scalp, frame) @ self._rest_frames.transpose(0, 2, 1)
        path = np.einsum("nij,nj->ni", self.spread(turn), self._paths)
        placed = self.spread(points) + self._root_shares[:, None] * away + path
        moved = np.flatnonzero(self.of_core >= 0)
        rows, strands = whole.point_rows(moved), whole.take(moved)
        placed[rows] = along_paths(placed[rows], strands.offsets, np.asarray(strands.edge_lengths(), np.float64))
        return placed

    @cached_property
    def _roots(self) -> Roots:
        """The roots of all locks."""
        return Roots(self.whole)

    @cached_property
    def _rest_frames(self) -> Array:
        return self._frames(np.asarray(self.groom.locks.points, np.float64), self.groom.scalp.points, 0.0)

    def _frames(self, points: Array, scalp: Array, frame: float) -> Array:
        """Frames along simulated locks with those points [m], shape (n, 3, 3); rotation-minimising from the root."""
        first = self._roots.axes(scalp, frame)[np.unique(self.simulated, return_index=True)[1], :, 0]
        return _core.curve_frames(np.ascontiguousarray(points, np.float64), self.groom.locks.offsets, first.copy())

    @cached_property
    def _offsets(self) -> Array:
        """Offset of each strand from its core in the groom [m], shape (n, 3); 0 of a lock that is simulated itself."""
        return np.asarray(self.whole.locks.points - self.spread(self.groom.locks.points), np.float64)

    @cached_property
    def _root_shares(self) -> Array:
        """The share of its root in the offset of a strand, which only falls along it, from 1 to 0; shape (n,)."""
        locks, shares = self.whole.locks, np.zeros(len(self.whole.locks.points))
        for row in np.flatnonzero(self.of_core >= 0):
            points = slice(*locks.offsets[row : row + 2])
            offset = self._offsets[points]
            away = np.linalg.norm(offset[0])
            if away > 0.0:
                run = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(locks[int(row)], axis=0), axis=1))])
                near = smooth_step(1.0 - run / (ROOT_REACH * away))
                there = np.clip(offset @ offset[0] / away**2, 0.0, 1.0)
                shares[points] = np.minimum.accumulate(there) * near
        return shares

    @cached_property
    def _paths(self) -> Array:
        """The path of each strand across its braid, without the share of its root [m], shape (n, 3)."""
        roots = np.repeat(self._offsets[self.whole.locks.offsets[:-1]], self.whole.locks.counts, axis=0)
        return self._offsets - self._root_shares[:, None] * roots


def _joined(parts: list[Curves]) -> Curves:
    """Curves one after the other, with the attributes that the first has."""
    first = parts[0] if len(parts[0]) else parts[1]
    return Curves(
        np.concatenate([part.points for part in parts]),
        offsets_from_counts(np.concatenate([part.counts for part in parts])),
        np.concatenate([part.ids for part in parts]),
        {name: np.concatenate([part.curve[name] for part in parts]) for name in first.curve},
        {name: np.concatenate([part.point[name] for part in parts]) for name in first.point},
    )
