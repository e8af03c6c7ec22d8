"""A hand in live hair: it pulls a lock, combs, or pats."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError
from ringlet.sim.core import Vector
from ringlet.sim.strands import Springs

Array = NDArray[np.float64]

FARTHEST = 0.3  # of a hand in a step [m]: beyond, it lets go
GRIP = 1000.0  # stiffness of fingers, relative to the inertia of a vertex in a step
TEETH = 4.0  # that of a comb in its middle
UNROLLED = 0.98  # how far a lock is pulled, by the length of its wire
PRESSED = 0.01  # how far hair inside a palm comes out in a step [m]


@dataclass(frozen=True)
class Touch:
    """What a hand does to live hair.

    does:   pull the lock that is nearest as it begins, comb what is near, or pat
    at:     where the hand is at the end of the next step [m]
    radius: of the comb, or of the palm, which is a ball [m]

    Raises UserError for what is not finite, and for a radius that is not positive.
    """

    does: Literal["pull", "comb", "pat"]
    at: Vector
    radius: float = 0.04

    def __post_init__(self) -> None:
        if np.shape(self.at) != (3,) or not np.isfinite(self.at).all():
            raise UserError(f"live: a hand is at {self.at}; must be three finite numbers")
        if not (np.isfinite(self.radius) and self.radius > 0.0):
            raise UserError(f"live: radius of a hand is {self.radius}; must be positive")


@dataclass
class Hand:
    """A hand from one step to the next.

    touch:  what it does; None: it has let go
    start:  where it is as a step begins [m]
    lock:   id of the lock that it pulls, and the number of the vertex of its rod
    grip:   the vertex from the hand [m]
    thrown: whether it was farther away after a step than a hand goes, and does nothing until it is taken away
    """

    touch: Touch | None = None
    start: Array = field(default_factory=lambda: np.full(3, np.nan))
    lock: tuple[int, int] | None = None
    grip: Array = field(default_factory=lambda: np.zeros(3))
    thrown: bool = False

    def take(self, touch: Touch | None) -> None:
        """Does something, goes on with it, or lets go."""
        if touch is None:
            self.thrown = False
        elif self.touch is None or touch.does != self.touch.does:
            self.start, self.lock = np.array(touch.at), None
        self.touch = touch

    def begin(self) -> tuple[Touch | None, str]:
        """What it does in a step; and a sentence about what was cut off, empty for nothing."""
        touch = self.touch
        if touch is None or self.thrown:
            return None, ""
        if (distance := float(np.linalg.norm(touch.at - self.start))) > FARTHEST:
            self.thrown = True
            return None, f"the hand was thrown {distance:.2g} m in a step; it let go"
        return touch, ""

    def end(self) -> None:
        """The step is over."""
        if self.touch is not None and not self.thrown:
            self.start = np.array(self.touch.at)

    def springs(self, touch: Touch, rods: TouchedRods) -> Springs | None:
        """The springs by which it pulls or combs in a step; None for one that pats, or whose lock is gone."""
        if touch.does == "pull":
            return self._pull(touch, rods)
        return rods.comb(self.start, np.array(touch.at), touch.radius) if touch.does == "comb" else None

    def _pull(self, touch: Touch, rods: TouchedRods) -> Springs | None:
        if self.lock is None:
            rod, vertex = rods.nearest(np.array(touch.at))
            self.lock = int(rods.ids[rod]), vertex
            self.grip = rods.points[rod, vertex] - touch.at
        found = np.flatnonzero(rods.ids == self.lock[0])
        return rods.pull(int(found[0]), self.lock[1], touch.at + self.grip) if found.size else None


@dataclass(frozen=True)
class TouchedRods:
    """Rods as a step begins.

    ids:     of their locks, shape (count,)
    points:  their vertices [m], shape (count, vertices, 3)
    roots:   where they begin at the end of the step [m], shape (count, 3)
    reach:   how far each vertex is from its root on a lock that is pulled straight [m], shape (count, vertices)
    inertia: of each vertex in the step, 0 where it is held [N/m], shape (count, vertices)
    """

    ids: NDArray[np.int64]
    points: Array
    roots: Array
    reach: Array
    inertia: Array

    def nearest(self, at: Array) -> tuple[int, int]:
        """The rod and the number of its free vertex that is nearest to a place."""
        away = np.where(self.inertia > 0.0, ((self.points - at) ** 2).sum(axis=2), np.inf)
        rod, vertex = np.unravel_index(int(np.argmin(away)), away.shape)
        return int(rod), int(vertex)

    def pull(self, rod: int, vertex: int, to: Array) -> Springs:
        """Springs that pull a vertex to a place, as far as its lock reaches."""
        way, most = to - self.roots[rod], UNROLLED * self.reach[rod, vertex]
        targets, stiffness = np.zeros_like(self.points), np.zeros_like(self.inertia)
        targets[rod, vertex] = self.roots[rod] + way * min(1.0, most / max(float(np.linalg.norm(way)), 1e-12))
        stiffness[rod, vertex] = GRIP * self.inertia[rod, vertex]
        return targets.reshape(-1, 3), stiffness.ravel()

    def comb(self, start: Array, end: Array, radius: float) -> Springs:
        """Springs by which vertices near a comb take over its velocity: an implicit drag."""
        way = end - start
        part = np.clip((self.points - start) @ way / max(float(way @ way), 1e-12), 0.0, 1.0)
        away2 = ((self.points - start - part[..., None] * way) ** 2).sum(axis=2)
        weight = np.maximum(1.0 - away2 / radius**2, 0.0) ** 2
        return (self.points + way).reshape(-1, 3), (TEETH * weight * self.inertia).ravel()
