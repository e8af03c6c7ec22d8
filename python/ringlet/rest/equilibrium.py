"""Equilibrium: rest shapes with which a groom is exactly in static equilibrium, and stable.

Inverse statics gives the rest shape of a lock under its weight and the forces that support it. A lock that is too soft
for its load has none, or one that is bent into itself, or it would buckle: it is stiffened until it stands. Stability
is that of the second derivative of the energy, which must be positive in every direction.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.rest.contact_support import contact_support
from ringlet.rest.inverse_statics import balanced_rest_shape, external_loads
from ringlet.rest.loft import Loft, Progress, largest_per_lock
from ringlet.rest.preload import STILL, hang_groom
from ringlet.shot.shot import Shot
from ringlet.shot.variation import Mapped
from ringlet.sim.hair_pins import spring_fraction
from ringlet.sim.obstacle import Obstacle
from ringlet.sim.shot_strands import make_strands
from ringlet.sim.strands import Strands

Array = NDArray[np.float64]
Locks = NDArray[np.bool_]

STIFFER = 1.5  # factor by which a lock without equilibrium becomes stiffer at once
TRIES = 20  # to make locks stiff enough
PUSH = 1e-5  # force that perturbs a lock that is unstable, relative to its weight
FALL = 12  # steps of 1 s in which it falls
STANDS = 1e-5  # largest distance from the groom of a lock that stands [m]
MUCH_NEARER = 0.1  # distance, relative to that with the groom as rest shape, at which an unstable lock keeps its own


@dataclass
class _Trial:
    """Locks with some stiffness and their rest shape: where they come to rest, and which are in stable equilibrium.

    needed: times that each must be stiffer still, as far as is known
    """

    factor: Array
    rest: Array
    points: Array
    moving: Array
    off: Array
    stable: Locks
    needed: Array


def equilibrium(
    shot: Shot,
    groom: Groom,
    *,
    obstacles: Sequence[Obstacle] = (),
    support: Array | None = None,
    frames: Array | None = None,
    progress: Progress | None = None,
) -> Loft:
    """Finds the rest shape with which the locks of ``groom`` are still as groomed, under the forces of ``shot``.

    obstacles: what locks may lie on, where the shot has contact, in the rest pose
    support:   the ``support_forces`` of these locks [N], shape (n, 3), where they are some of a groom
    frames:    their directors where they were groomed, shape (n, 3), where these are known

    A lock that would fall is stiffened, up to ``rest.stiffen`` times. One that falls even so keeps its stiffness and
    its groomed shape, or what hangs ten times nearer to it.
    """
    locks = groom.locks
    _check(shot, locks)
    strands, most = make_strands(shot, groom), shot.rest.stiffen
    frames = strands.directors.copy() if frames is None else frames
    support = support_forces(shot, groom, obstacles, strands) if support is None else support
    carried = support + _pin_springs(shot, groom, strands)
    pending, soft, factor = np.ones(len(locks), bool), np.zeros(len(locks), bool), np.ones(len(locks))
    made = _empty_loft(groom, support)

    def solve(which: Locks, fall: bool = False) -> _Trial:
        part, rows = replace(groom, locks=locks.take(which)), np.repeat(which, locks.counts)
        return _solve(shot, part, frames[rows], carried[rows], factor[which], fall)

    for _ in range(TRIES):
        if progress:
            progress("loft", int((~pending).sum()), len(locks))
        found = solve(pending)
        _accept(made, pending, found, found.stable)
        factor[pending] *= found.needed
        pending[pending] = ~found.stable
        soft |= pending & (factor > most)
        pending &= ~soft
        if not pending.any():
            break
    soft |= pending
    if soft.any():
        factor[soft] = most
        _accept(made, soft, solve(soft, fall=True), np.ones(soft.sum(), bool))
        plain = _unlofted(shot, replace(groom, locks=locks.take(soft)))
        _accept(made, soft, plain, made.off[soft] >= MUCH_NEARER * plain.off)
    if progress:
        progress("loft", len(locks), len(locks))
    return made


def support_forces(shot: Shot, groom: Groom, obstacles: Sequence[Obstacle], strands: Strands | None = None) -> Array:
    """The forces of bodies, pins and other locks that support a groom [N], shape (n, 3).

    strands: its locks, as ``contact_support`` takes them; by default they are made
    """
    strands = make_strands(shot, groom) if strands is None else strands
    loads = external_loads(shot, strands) + _pin_springs(shot, groom, strands)
    return contact_support(shot, groom.locks, strands, loads, obstacles)


def _pin_springs(shot: Shot, groom: Groom, strands: Strands) -> Array:
    """The share of the weight that soft pins carry [N], shape (n, 3)."""
    share = spring_fraction(groom.locks, 1.0 / (groom.space.fps * shot.solver.substeps))
    return -np.outer(share * strands.masses, shot.forces.gravity)


def _check(shot: Shot, locks: Curves) -> None:
    """Refuses settings with which there is no equilibrium to find."""
    if shot.solver.continuation != "material_frame":
        raise UserError(
            f"loft: rest.mode is 'equilibrium', which needs solver.continuation = 'material_frame'; it is "
            f"'{shot.solver.continuation}'"
        )
    if shot.rest.gain != Mapped():
        raise UserError(
            "loft: rest.gain is set, but rest.mode 'equilibrium' takes all of the sag; use 'lofted', or drop it"
        )
    if shot.held < 3:
        raise UserError(
            f"loft: held is {shot.held}; rest.mode 'equilibrium' needs at least 3, which hold a lock's frame"
        )
    if (locks.counts <= shot.held).any():
        raise UserError(f"loft: held is {shot.held}, but a lock has {locks.counts.min()} points; hold fewer")


def _empty_loft(groom: Groom, support: Array) -> Loft:
    """A loft to be filled, lock by lock."""
    count, points = len(groom.locks), np.array(groom.locks.points, np.float64)
    nowhere = np.full(count, np.inf)
    return Loft(
        groom, groom.locks.with_points(points), None, points.copy(), nowhere, nowhere.copy(), nowhere.copy(), support
    )


def _accept(made: Loft, pending: Locks, trial: _Trial, better: Locks) -> None:
    """Takes over those of the ``pending`` locks whose trial is better."""
    assert made.stiffened is not None
    found, counts = pending.copy(), made.rest.counts
    found[pending] = better
    rows, among = np.repeat(found, counts), np.repeat(better, counts[pending])
    made.rest.points[rows], made.lofted[rows] = trial.rest[among], trial.points[among]
    made.off[found], made.moving[found] = trial.off[better], trial.moving[better]
    made.stiffened[found] = trial.factor[better]


def _unlofted(shot: Shot, groom: Groom) -> _Trial:
    """Locks whose rest shape is the groom."""
    plain, ones = hang_groom(shot, groom), np.ones(len(groom.locks))
    rest = np.array(groom.locks.points, np.float64)
    return _Trial(ones, rest, plain.points, plain.moving, plain.off, plain.off < STANDS, ones)


def _solve(shot: Shot, groom: Groom, frames: Array, support: Array, factor: Array, fall: bool) -> _Trial:
    """Finds the rest shape of locks that are some times as stiff against bend, and whether they stand with it.

    frames: the directors of the locks where they were groomed, shape (n, 3)
    fall:   perturb them and let them fall, until they hang
    """
    locks, groomed = groom.locks, np.asarray(groom.locks.points, np.float64)
    rest, balanced = balanced_rest_shape(shot, groom, frames, support, factor)
    strands = make_strands(shot, groom, rest, factor)
    strands.place(groomed)
    needed = strands.stabilising_stiffness(shot.rest.spring / factor, shot.rest.stiffen)
    if fall:
        _release(strands, shot, support + _perturbation(external_loads(shot, strands), locks), 1)
    moving = _release(strands, shot, support, FALL if fall else 1)
    off = largest_per_lock(locks, np.linalg.norm(strands.positions - groomed, axis=1))
    still = balanced & (off < STANDS)
    stable = still & (needed == 1.0)
    needed = np.where(still, needed, np.maximum(needed, STIFFER))
    return _Trial(factor, np.asarray(rest.points, np.float64), strands.positions.copy(), moving, off, stable, needed)


def _perturbation(loads: Array, locks: Curves) -> Array:
    """A small fraction of the load at each vertex [N], in a random direction per lock, shape (n, 3)."""
    direction = np.random.default_rng(1).standard_normal((len(locks), 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    return PUSH * np.linalg.norm(loads, axis=1, keepdims=True) * np.repeat(direction, locks.counts, axis=0)


def _release(strands: Strands, shot: Shot, forces: Array, steps: int) -> Array:
    """Lets strands move freely for some steps of 1 s; returns how far each moved in the last one [m]."""
    gravity, wind = shot.forces.gravity, shot.forces.wind
    settle = partial(strands.settle, gravity=gravity, wind=wind, forces=forces, tolerance=STILL)
    if steps > 1:
        settle(steps=steps - 1)
    before = strands.positions.copy()
    settle(steps=1)
    return largest_per_lock(strands.curves, np.linalg.norm(strands.positions - before, axis=1))
