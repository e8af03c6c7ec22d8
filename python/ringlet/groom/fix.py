"""Repairs a groom: removes intersections with the least change of shape."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.groom import Groom
from ringlet.data.mesh import Mesh
from ringlet.groom.check import Allowed, Bodies, Findings, find, lock_of
from ringlet.groom.operators.operator import packed

Array = NDArray[np.float64]

MAX_ITERATIONS = 100
PATIENCE = 20  # iterations without progress after which the repair stops


@dataclass
class Repair:
    """A repaired groom.

    groom:  the groom with its repaired locks
    left:   intersections that remain
    rounds: iterations
    moved:  displacement of each point [m], shape (n,)
    """

    groom: Groom
    left: Findings
    rounds: int
    moved: Array

    def summary(self) -> dict[str, Any]:
        """Summary of the repair as plain values; lengths in metres."""
        moved = self.moved > 1e-9
        return {
            "rounds": self.rounds,
            "points_moved": int(moved.sum()),
            "locks_moved": len(np.unique(lock_of(self.groom.locks, np.flatnonzero(moved)))),
            "greatest_move": float(self.moved.max(initial=0.0)),
            "median_move": float(np.median(self.moved[moved])) if moved.any() else 0.0,
        }


def fix_groom(
    groom: Groom,
    others: Sequence[Mesh] = (),
    allowed: Allowed | None = None,
    progress: Callable[[str, int, int], None] | None = None,
) -> Repair:
    """Moves locks out of bodies and apart from each other (src/ringlet/groom/repair.h).

    Iterates until no intersection remains, or until ``PATIENCE`` iterations bring no progress.
    """
    allowed, locks = allowed or Allowed(), groom.locks.check("check: locks")
    bodies = Bodies(groom, others)
    left, rounds, moved = find(locks, bodies, allowed), 0, np.zeros(len(locks.points))
    if len(left) == 0:
        return Repair(groom, left, rounds, moved)
    repair = _core.Repair(*packed(locks), bodies.solids, allowed.root_depth, allowed.root_length, allowed.thickness)
    fewest, patience = len(left), PATIENCE
    while rounds < MAX_ITERATIONS and patience > 0:
        rounds, conflicts = rounds + 1, repair.round()
        if progress:
            progress("fix", rounds, MAX_ITERATIONS if conflicts else rounds)
        if conflicts == 0:
            break
        patience = PATIENCE if conflicts < fewest else patience - 1
        fewest = min(fewest, conflicts)
    best = locks.with_points(repair.points())
    moved = np.linalg.norm(best.points - locks.points, axis=1)
    return Repair(replace(groom, locks=best), find(best, bodies, allowed), rounds, moved)
