"""Repairs a groom: what goes through skin or hair is moved aside, with the least change of shape."""

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

ROUNDS = 100
PATIENCE = 20  # rounds that may pass without one that leaves less


@dataclass
class Repair:
    """A repaired groom.

    groom:  with other points
    left:   what could not be repaired
    rounds: how often everything was looked at
    moved:  how far each point went [m], shape (n,)
    """

    groom: Groom
    left: Findings
    rounds: int
    moved: Array

    def told(self) -> dict[str, Any]:
        """What was done, as plain values."""
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
    """Moves what is inside a body out of it and locks apart, round by round, until nothing is left or no round helps
    (src/ringlet/groom/repair.h)."""
    allowed, locks = allowed or Allowed(), groom.locks.check("check: locks")
    bodies = Bodies(groom, others)
    left, rounds, moved = find(locks, bodies, allowed), 0, np.zeros(len(locks.points))
    if len(left) == 0:
        return Repair(groom, left, rounds, moved)
    repair = _core.Repair(*packed(locks), bodies.solids, allowed.root_depth, allowed.root_length, allowed.thickness)
    fewest, patience = len(left), PATIENCE
    while rounds < ROUNDS and patience > 0:
        rounds, wrong = rounds + 1, repair.round()
        if progress:
            progress("fix", rounds, ROUNDS if wrong else rounds)
        if wrong == 0:
            break
        patience = PATIENCE if wrong < fewest else patience - 1
        fewest = min(fewest, wrong)
    best = locks.with_points(repair.points())
    moved = np.linalg.norm(best.points - locks.points, axis=1)
    return Repair(replace(groom, locks=best), find(best, bodies, allowed), rounds, moved)
