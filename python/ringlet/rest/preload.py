"""Rest-shape preload: a fixed-point iteration for the rest shape with which a groom hangs as it was groomed.

Locks in equilibrium carry their load by strains ε, the differences of their shape from the rest shape. They hang as
groomed if their rest strains are the groomed ones less these ε, which depend on the shape in turn. They are found by
letting the locks hang: first under a small load, where the groom hardly changes and ε is proportional to the load; then
under all of it, again from each corrected rest shape.

After the rest-shape preload of Iben et al., *Artistic Simulation of Curly Hair*, 2013.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.data.rigid import rotate
from ringlet.rest.loft import Loft, Progress, largest_per_lock
from ringlet.rest.rod_strains import RodStrains, edges, measure_strains, shape_of_strains
from ringlet.shot.shot import Shot
from ringlet.sim.shot_strands import make_strands
from ringlet.sim.strands import Strands
from ringlet.sim.variation import at_vertices

Array = NDArray[np.float64]
Locks = NDArray[np.bool_]

SMALL_LOAD = 0.01  # fraction of the load under which strands hang first
LEAST_DAMPING = 0.1  # fraction of a correction below which a lock is given up
STEPS = 40  # to hang still, each of 1 s
STILL = 1e-7  # motion in a step below which a lock hangs still [m]


@dataclass
class Hanging:
    """Strands that hang still from their rest strains.

    rest:   their rest strains
    points: where they hang [m], shape (n, 3)
    strain: the differences from the rest strains there
    off:    largest distance of each lock from its goal [m], shape (count,)
    moving: motion of each in its last step [m], shape (count,)
    """

    rest: RodStrains
    points: Array
    strain: RodStrains
    off: Array
    moving: Array

    def take(self, locks: Locks, vertices: Locks) -> Hanging:
        """Some of the locks, given also by their vertices."""
        rest, strain = self.rest.take(vertices), self.strain.take(vertices)
        return Hanging(rest, self.points[vertices], strain, self.off[locks], self.moving[locks])

    def put(self, locks: Locks, vertices: Locks, other: Hanging) -> None:
        """Sets some of the locks."""
        self.rest.put(vertices, other.rest)
        self.strain.put(vertices, other.strain)
        self.points[vertices], self.off[locks], self.moving[locks] = other.points, other.off, other.moving


def loft(shot: Shot, groom: Groom, *, progress: Progress | None = None) -> Loft:
    """Finds the rest shape with which the locks of ``groom`` hang as groomed, under the forces of ``shot``.

    A lock that does not get there, as where it would fall over with any rest shape, keeps the best that was found.
    """
    locks = groom.locks
    if (locks.counts <= shot.held).any():
        raise UserError(f"loft: held is {shot.held}, but a lock has {locks.counts.min()} points; hold fewer")
    solver = _HangingSolver(shot, groom)
    best, pending = solver.sagged, solver.sagged.off >= shot.rest.tolerance
    sagged = best.points.copy()
    rest, damping = solver.first_guess(), np.ones(len(locks))
    for done in range(shot.rest.iterations):
        if progress:
            progress("loft", done, shot.rest.iterations)
        if not pending.any():
            break
        hanging = solver.hang(rest, pending)
        better = pending.copy()
        better[pending] = (hanging.off < best.off[pending]) & (hanging.moving <= STILL)
        rows = solver.vertices(better)
        best.put(better, rows, hanging.take(better[pending], rows[solver.vertices(pending)]))
        damping[pending & ~better] *= 0.5
        pending &= (best.off >= shot.rest.tolerance) & (damping >= LEAST_DAMPING)
        rest = solver.next_guess(best, damping)
    if progress:
        progress("loft", shot.rest.iterations, shot.rest.iterations)
    return Loft(groom, solver.rest_shape(best.rest), sagged, best.points, best.off, best.moving)


def hang_groom(shot: Shot, groom: Groom) -> Hanging:
    """Locks that hang with the groom as their rest shape."""
    return _HangingSolver(shot, groom).sagged


def with_sag(loft: Loft, shot: Shot) -> Loft:
    """The same loft, with how its locks hang without it."""
    return loft if loft.sagged is not None else replace(loft, sagged=hang_groom(shot, loft.groom).points)


class _HangingSolver:
    """Lets the locks of a groom hang from one rest shape after the other."""

    def __init__(self, shot: Shot, groom: Groom) -> None:
        self._shot, self._groom = shot, groom
        self._gain = at_vertices(shot.rest, "gain", groom, "rest.gain")
        self._frames = make_strands(shot, groom).directors.copy()
        self._groomed = measure_strains(groom.locks, np.asarray(groom.locks.points, np.float64), self._frames)
        self._all = np.ones(len(groom.locks), bool)
        self.sagged = self.hang(self._groomed, self._all)

    def vertices(self, locks: Locks) -> Locks:
        """The vertices of some locks, as a mask."""
        return np.repeat(locks, self._groom.locks.counts)

    def rest_shape(self, rest: RodStrains) -> Curves:
        """The rest shape of all locks, from its strains."""
        locks = self._groom.locks
        return locks.with_points(shape_of_strains(locks, rest, self._frames)[0])

    def first_guess(self) -> RodStrains:
        """The groomed strains less those that carry the load, extrapolated from a small load."""
        return self._groomed.plus(self.hang(self._groomed, self._all, SMALL_LOAD).strain, -self._gain / SMALL_LOAD)

    def next_guess(self, now: Hanging, damping: Array) -> RodStrains:
        """A damped step to the groomed strains less those that carry the load now."""
        target = self._groomed.plus(now.strain, -self._gain)
        return now.rest.plus(target.minus(now.rest), np.repeat(damping, self._groom.locks.counts))

    def hang(self, rest: RodStrains, chosen: Locks, load: float = 1.0) -> Hanging:
        """Lets the chosen locks come to rest from the groom, with rest strains, under a fraction of the load."""
        rows = self.vertices(chosen)
        groom = replace(self._groom, locks=self._groom.locks.take(chosen))
        locks, frames, rest = groom.locks, self._frames[rows], rest.take(rows)
        points, directors = shape_of_strains(locks, rest, frames)
        strands = make_strands(self._shot, groom, locks.with_points(points))
        turn = _angle(locks, points, directors, strands.directors)
        strands.place(locks.points)
        moving = _settle(strands, self._shot, load)
        if self._shot.solver.continuation != "material_frame":
            strands.place(strands.positions)  # which finds the directors
        hanging = strands.positions.copy()
        _, tangents = edges(locks, hanging)
        strain = measure_strains(locks, hanging, rotate(strands.directors, -turn[:, None] * tangents)).minus(rest)
        goal, _ = shape_of_strains(locks, self._groomed.take(rows).plus(strain, 1.0 - self._gain[rows]), frames)
        return Hanging(rest, hanging, strain, largest_per_lock(locks, np.linalg.norm(hanging - goal, axis=1)), moving)


def _angle(locks: Curves, points: Array, ours: Array, theirs: Array) -> Array:
    """The angles about the edges from our directors to the core's [rad], shape (n,).

    The core begins each from the corner of the rest shape; ours continue from iteration to iteration.
    """
    _, tangents = edges(locks, points)
    return np.arctan2((np.cross(tangents, ours) * theirs).sum(axis=1), (ours * theirs).sum(axis=1))


def _settle(strands: Strands, shot: Shot, load: float) -> Array:
    """Lets strands come to rest; returns how far each moved in the last step [m]."""

    def hang(steps: int) -> bool:
        x, y, z = (load * component for component in shot.forces.gravity)
        u, v, w = (load * component for component in shot.forces.wind)
        kind = shot.solver.continuation
        return strands.settle(gravity=(x, y, z), wind=(u, v, w), tolerance=STILL, steps=steps, continuation=kind)

    hang(STEPS - 1)
    before = strands.positions.copy()
    hang(1)
    return largest_per_lock(strands.curves, np.linalg.norm(strands.positions - before, axis=1))
