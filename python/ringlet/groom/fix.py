"""Repairs a groom: what goes through skin or hair is moved aside, with the least change of shape."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from ringlet.curves import Curves
from ringlet.groom.check import Allowed, Bodies, Findings, along, find, lock_of
from ringlet.groom.crossings import Close, Neighbours
from ringlet.groom.groom import Groom
from ringlet.mesh import Mesh

Array = NDArray[np.float64]

ROUNDS, PATIENCE = 60, 5  # of so many rounds, the first that take the nearest way out of a body
CLEAR = 5e-5  # what is moved out of a body is moved so far beyond its surface [m]
ROOM = 1.15  # locks are moved apart to that many thicknesses
FIRM = 4.0  # how much more it matters to be out of a body than apart from a lock
SPREAD = 4e-3  # length along a lock over which a move dies away [m]
EASE = 0.05  # how much it matters that a lock keeps its form and place


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
    """Moves what is inside a body out of it and locks apart, round by round, until nothing is left or no round helps.

    In every round each point that has to go somewhere is told where; between them the move of a lock is the one that
    changes its form least: it minimises ``Σ w |δ - wanted|² + EASE (SPREAD⁴ |δ″|² + |δ|²)`` with the root held.
    """
    allowed = allowed or Allowed()
    locks = groom.locks.with_points(np.array(groom.locks.points, np.float64))
    bodies, neighbours = Bodies(groom, others), Neighbours(locks, ROOM * allowed.thickness)
    best, left, rounds = locks, find(locks, bodies, neighbours, allowed), 0
    while len(left) and rounds < ROUNDS:
        rounds += 1
        wanted, weight = np.zeros((len(locks.points), 3)), np.zeros(len(locks.points))
        _push_apart(locks, neighbours.close(locks.points), ROOM * allowed.thickness, wanted, weight)
        _push_out(locks, bodies, allowed, rounds > PATIENCE, wanted, weight)
        wanted /= np.maximum(weight, 1e-12)[:, None]
        locks = locks.with_points(locks.points + _spread(locks, wanted, np.minimum(weight, 4.0)))
        found = find(locks, bodies, neighbours, allowed)
        if len(found) < len(left):
            best, left = locks, found
        if progress:
            progress("fix", rounds, ROUNDS if len(found) else rounds)
    moved = np.linalg.norm(best.points - groom.locks.points, axis=1)
    return Repair(replace(groom, locks=best), left, rounds, moved)


def _push_apart(locks: Curves, close: Close, thickness: float, wanted: Array, weight: Array) -> None:
    """Adds, for two edges that are too near, to each its half of the way apart."""
    ways = locks.points[close.edges + 1] - locks.points[close.edges]
    across = np.cross(ways[:, 0], ways[:, 1])
    direction = np.where(close.distance[:, None] > 1e-9, close.apart, across)
    direction /= np.maximum(np.linalg.norm(direction, axis=1, keepdims=True), 1e-300)
    half = 0.5 * (thickness - close.distance)[:, None] * direction
    for side, sign in ((0, -1.0), (1, 1.0)):
        _want(close.edges[:, side], close.at[:, side], sign * half, 1.0, wanted, weight)


def _push_out(locks: Curves, bodies: Bodies, allowed: Allowed, stubborn: bool, wanted: Array, weight: Array) -> None:
    """Adds, for what is inside a body, the nearest way out of it; near the root no farther than it may stay inside.

    stubborn: lead it out away from the middle of the scalp instead: the nearest ways of neighbours may be opposite
    """
    may, clear = allowed.depth(locks), np.minimum(CLEAR, 0.5 * along(locks))
    for surface, near in zip(bodies.surfaces, bodies.near(locks, 0.5 * CLEAR), strict=True):
        goal = np.where(may[near.point] > 0.0, -0.5 * may[near.point], clear[near.point])
        rows = np.flatnonzero(near.height < np.where(goal < 0.0, 1.5 * goal, 0.5 * goal))
        out = near.foot[rows] + goal[rows, None] * near.normal[rows] - near.place[rows]
        if stubborn:
            foot, met = surface.outermost(bodies.middle, near.place[rows])
            away = foot - near.place[rows]
            away += CLEAR * away / np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-12)
            led = met & (may[near.point[rows]] == 0.0)
            out[led] = away[led]
        _want(near.point[rows], near.at[rows], out, FIRM, wanted, weight)


def _want(first: NDArray, at: Array, way: Array, firm: float, wanted: Array, weight: Array) -> None:
    """Adds to the ends of edges what moves the places on them by a way; summed up, and weighed by its firmness."""
    squares = at * at + (1.0 - at) ** 2
    for end, share in ((0, 1.0 - at), (1, at)):
        np.add.at(wanted, first + end, (firm * share * share / squares)[:, None] * way)
        np.add.at(weight, first + end, firm * share)


def _spread(locks: Curves, wanted: Array, weight: Array) -> Array:
    """The moves of all points, shape (n, 3): lock by lock, only where something is wanted."""
    moves = np.zeros_like(wanted)
    for lock in np.unique(lock_of(locks, np.flatnonzero(weight > 0.0))):
        rows = slice(locks.offsets[lock] + 1, locks.offsets[lock + 1])
        spacing = np.linalg.norm(np.diff(locks[int(lock)], axis=0), axis=1).mean()
        moves[rows] = _least_change(wanted[rows], weight[rows], (SPREAD / max(spacing, 1e-9)) ** 4)
    return moves


def _least_change(wanted: Array, weight: Array, stiffness: float) -> Array:
    """Moves of the points after a root that stays, shape (k, 3); what is wanted matters enough to be got."""
    bands = EASE * stiffness * _bending(len(wanted))
    firm = weight * (1.0 + 50.0 * EASE * stiffness)
    bands[2] += EASE + firm
    return solveh_banded(bands, firm[:, None] * wanted, check_finite=False)


@lru_cache(maxsize=64)
def _bending(count: int) -> Array:
    """Δ²ᵀΔ² of points after a root that stays, as the upper bands that ``solveh_banded`` takes, shape (3, count)."""
    second = np.diff(np.eye(count + 1), n=2, axis=0)[:, 1:]
    square, bands = second.T @ second, np.zeros((3, count))
    for off in range(3):
        bands[2 - off, off:] = np.diagonal(square, off)
    return bands
