"""Lofting: pre-bends the shape that strands remember, so that what hangs under gravity is the groom.

A strand that hangs still carries its load by strains ε, by which the hanging shape differs from the one it remembers.
It hangs as groomed if it remembers the groom less the ε that hold it there. Those are not known before it hangs so;
they are found by hanging it: first under a small part of the load, where the groom is hardly changed and ε is
proportional to the load, then under all of it, as often as it takes.

After the rest-shape preload of Iben et al., *Artistic Simulation of Curly Hair*, 2013.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.rest.rod_strains import RodStrains, edges, measure_strains, rotate, shape_of_strains
from ringlet.shot.shot import Shot
from ringlet.sim.motion import make_strands
from ringlet.sim.strands import Strands
from ringlet.sim.variation import at_vertices

Progress = Callable[[str, int, int], None]
Array = NDArray[np.float64]
Locks = NDArray[np.bool_]

SMALL = 0.01  # part of the load under which a strand is hung first
SLOWEST = 0.1  # pace at which a lock is given up
STEPS = 40  # to hang still, each of 1 s
STILL = 1e-7  # what moves less in a step hangs still [m]


@dataclass
class Loft:
    """A lofted rest shape and what it does; positions in the rest pose of the scalp [m].

    groom:  what was lofted
    rest:   what the locks are to remember
    sagged: how they hang when they remember the groom, shape (n, 3); None: nobody has looked, see ``with_sag``
    lofted: how they hang when they remember ``rest``, shape (n, 3)
    off:    how far each hangs from where it should, shape (count,)
    moving: how far each still moved in its last step, of 1 s, shape (count,)
    stiffened: times that each is stiffer against bend than the shot says, shape (count,); None: none is
    borne:  what was taken to bear them, besides their roots [N], shape (n, 3); None: nothing
    """

    groom: Groom
    rest: Curves
    sagged: Array | None
    lofted: Array
    off: Array
    moving: Array
    stiffened: Array | None = None
    borne: Array | None = None

    def lost(self) -> dict[str, dict[str, float]]:
        """What is lost of the groom, with the loft and, if known, without [m]: ``with max`` … of each measure.

        away:   how far the vertices hang from where they were groomed
        drop:   how much deeper the tips of the locks hang
        height: how much less high the locks reach over their lowest point
        """
        locks = self.groom.locks
        begin, tips = locks.offsets[:-1], locks.offsets[1:] - 1

        def height(points: NDArray[np.floating]) -> Array:
            return np.maximum.reduceat(points[:, 1], begin) - np.minimum.reduceat(points[:, 1], begin)

        def measured(points: Array) -> dict[str, Array]:
            return {
                "away": np.linalg.norm(points - locks.points, axis=1),
                "drop": locks.points[tips, 1] - points[tips, 1],
                "height": height(locks.points) - height(points),
            }

        lost: dict[str, dict[str, float]] = {}
        for when, points in (("without", self.sagged), ("with", self.lofted)):
            if points is None:
                continue
            for name, values in measured(points).items():
                size = np.abs(values)
                summary = {"mean": size.mean(), "95": np.percentile(size, 95), "max": size.max()}
                lost.setdefault(name, {}).update({f"{when} {k}": float(v) for k, v in summary.items()})
        return lost


@dataclass
class Hanging:
    """Strands that hang still from the rest shape ``joints``: where, with what strains, and how far from their goal."""

    joints: RodStrains
    points: Array
    strain: RodStrains
    off: Array
    moving: Array

    def take(self, locks: Locks, vertices: Locks) -> Hanging:
        """Some of the locks, given also by their vertices."""
        joints, strain = self.joints.take(vertices), self.strain.take(vertices)
        return Hanging(joints, self.points[vertices], strain, self.off[locks], self.moving[locks])

    def put(self, locks: Locks, vertices: Locks, other: Hanging) -> None:
        """Sets some of the locks."""
        self.joints.put(vertices, other.joints)
        self.strain.put(vertices, other.strain)
        self.points[vertices], self.off[locks], self.moving[locks] = other.points, other.off, other.moving


def loft(shot: Shot, groom: Groom, *, progress: Progress | None = None) -> Loft:
    """Finds the shape that the locks of ``groom`` must remember to hang as groomed, under the forces of ``shot``.

    A lock that does not get there, as where it would fall over however it is pre-bent, keeps the best that was found.
    """
    locks = groom.locks
    locks.check("loft: locks")
    if (locks.counts <= shot.held).any():
        raise UserError(f"loft: held is {shot.held}, but a lock has {locks.counts.min()} points; hold fewer")
    tries = _Tries(shot, groom)
    best, going = tries.sagged, tries.sagged.off >= shot.rest.tolerance
    sagged = best.points.copy()
    joints, pace = tries.first_guess(), np.ones(len(locks))
    for done in range(shot.rest.iterations):
        if progress:
            progress("loft", done, shot.rest.iterations)
        if not going.any():
            break
        tried = tries.hang(joints, going)
        better = going.copy()
        better[going] = (tried.off < best.off[going]) & (tried.moving <= STILL)
        best.put(
            better, tries.vertices(better), tried.take(better[going], tries.vertices(better)[tries.vertices(going)])
        )
        pace[going & ~better] *= 0.5
        going &= (best.off >= shot.rest.tolerance) & (pace >= SLOWEST)
        joints = tries.next_guess(best, pace)
    if progress:
        progress("loft", shot.rest.iterations, shot.rest.iterations)
    return Loft(groom, tries.rest(best.joints), sagged, best.points, best.off, best.moving)


def hang_groom(shot: Shot, groom: Groom) -> Hanging:
    """How locks hang that remember the groom."""
    return _Tries(shot, groom).sagged


def with_sag(loft: Loft, shot: Shot) -> Loft:
    """The same, which knows how its locks hang when they remember the groom."""
    return loft if loft.sagged is not None else replace(loft, sagged=hang_groom(shot, loft.groom).points)


class _Tries:
    """Hangs the locks of a groom from one rest shape after the other."""

    def __init__(self, shot: Shot, groom: Groom) -> None:
        self._shot, self._groom = shot, groom
        self._gain = at_vertices(shot.rest.gain, groom, "rest.gain")
        self._frames = make_strands(shot, groom).directors.copy()
        self._groomed = measure_strains(groom.locks, np.asarray(groom.locks.points, np.float64), self._frames)
        self._all = np.ones(len(groom.locks), bool)
        self.sagged = self.hang(self._groomed, self._all)

    def vertices(self, locks: Locks) -> Locks:
        """The vertices of some locks, as a mask."""
        return np.repeat(locks, self._groom.locks.counts)

    def rest(self, joints: RodStrains) -> Curves:
        """The rest shape of all locks."""
        locks = self._groom.locks
        return locks.with_points(shape_of_strains(locks, joints, self._frames)[0])

    def first_guess(self) -> RodStrains:
        """The groom less what holds it, from a small part of the load."""
        return self._groomed.plus(self.hang(self._groomed, self._all, SMALL).strain, -self._gain / SMALL)

    def next_guess(self, now: Hanging, pace: Array) -> RodStrains:
        """From where they are now, a part of the way to the groom less what holds them now."""
        wanted = self._groomed.plus(now.strain, -self._gain)
        return now.joints.plus(wanted.minus(now.joints), np.repeat(pace, self._groom.locks.counts))

    def hang(self, joints: RodStrains, chosen: Locks, load: float = 1.0) -> Hanging:
        """Lets the chosen locks hang still from the groom, remembering ``joints``, under a part of the load."""
        rows = self.vertices(chosen)
        groom = replace(self._groom, locks=self._groom.locks.take(chosen))
        locks, frames, joints = groom.locks, self._frames[rows], joints.take(rows)
        points, directors = shape_of_strains(locks, joints, frames)
        strands = make_strands(self._shot, groom, locks.with_points(points))
        turn = _angle(locks, points, directors, strands.directors)
        strands.place(locks.points)
        moving = _settle(strands, self._shot, load)
        if self._shot.solver.continuation != "material_frame":
            strands.place(strands.positions)  # which finds the directors
        hung = strands.positions.copy()
        _, tangents = edges(locks, hung)
        strain = measure_strains(locks, hung, rotate(strands.directors, -turn[:, None] * tangents)).minus(joints)
        goal, _ = shape_of_strains(locks, self._groomed.take(rows).plus(strain, 1.0 - self._gain[rows]), frames)
        return Hanging(joints, hung, strain, largest_per_lock(locks, np.linalg.norm(hung - goal, axis=1)), moving)


def _angle(locks: Curves, points: Array, ours: Array, theirs: Array) -> Array:
    """By how much the core's directors are turned about the edges from ours [rad], shape (n,).

    The core begins each from the corner of the rest shape; ours go on from iteration to iteration.
    """
    _, tangents = edges(locks, points)
    return np.arctan2((np.cross(tangents, ours) * theirs).sum(axis=1), (ours * theirs).sum(axis=1))


def _settle(strands: Strands, shot: Shot, load: float) -> Array:
    """Lets strands hang still; returns how far each moved in the last step [m]."""

    def hang(steps: int) -> bool:
        x, y, z = (load * part for part in shot.forces.gravity)
        u, v, w = (load * part for part in shot.forces.wind)
        kind = shot.solver.continuation
        return strands.settle(gravity=(x, y, z), wind=(u, v, w), tolerance=STILL, steps=steps, continuation=kind)

    hang(STEPS - 1)
    before = strands.positions.copy()
    hang(1)
    return largest_per_lock(strands.curves, np.linalg.norm(strands.positions - before, axis=1))


def largest_per_lock(locks: Curves, values: Array) -> Array:
    """The largest of the vertices' values for each lock, shape (count,)."""
    return np.maximum.reduceat(values, locks.offsets[:-1])
