"""Equilibrium: rest shapes from which a groom hangs as it was groomed, exactly, and stands where it is put.

What a strand must hold inside is known from the loads alone (``balance``): its weight, and what bears it where it lies
(``support``). Divided by the stiffness these are strains, and the groom less its strains is what the strand has to
remember. A lock that is too soft for its load, which would have to be bent into itself or would fall over however it is
pre-bent, is made stiffer until it stands.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ringlet.curves import Curves
from ringlet.errors import UserError
from ringlet.groom.groom import Groom
from ringlet.shot.balance import balance
from ringlet.shot.collider import Obstacle
from ringlet.shot.joints import Joints, measure, shape
from ringlet.shot.loft import STILL, Loft, Progress, hang_plain, per_lock
from ringlet.shot.nails import softly
from ringlet.shot.shot import Shot
from ringlet.shot.simulate import make_strands
from ringlet.shot.strands import Strands
from ringlet.shot.support import support
from ringlet.shot.variation import Mapped

Array = NDArray[np.float64]
Locks = NDArray[np.bool_]

SAME = 1e-4  # change of a lock's strains from round to round, by their size, at which they are found
SHARPEST = 2.6  # bend of a corner at rest above which a lock counts as too soft [rad]
NUDGE = 1e-6  # by which a lock is disturbed to see whether it stands [m]
FALLING = 1e-5  # a lock that is farther away than this after that falls [m]
MUCH_LESS = 0.1  # of how far it is away by now: what does not stand is kept if it is that near
FALL = 12  # steps of 1 s in which it falls
STIFFER = 1.5  # from one try to the next


@dataclass
class _Try:
    """Locks that remember some shape: their points, the strands, and whether each balances and stands."""

    rest: Array
    points: Array
    moving: Array
    off: Array
    good: Locks


def equilibrium(
    shot: Shot, groom: Groom, *, obstacles: Sequence[Obstacle] = (), progress: Progress | None = None
) -> Loft:
    """Finds what the locks of ``groom`` must remember to be still as groomed, under the forces of ``shot``.

    obstacles: what locks may lie on, where the shot has contact, in the rest pose

    A lock that would fall is stiffened, up to ``rest.stiffen`` times; one that falls even so keeps its stiffness and
    its groomed shape, or what hangs ten times nearer to it.
    """
    locks = groom.locks
    locks.check("loft: locks")
    _check(shot, locks)
    made, stiffened, borne = hang_plain(shot, groom), np.ones(len(locks)), _borne(shot, groom, obstacles)
    going, factor = np.ones(len(locks), bool), 1.0
    while going.any() and factor <= shot.rest.stiffen:
        if progress:
            progress("loft", int((~going).sum()), len(locks))
        tried = _try(shot, replace(groom, locks=locks.take(going)), borne[np.repeat(going, locks.counts)], factor)
        better = tried.good | (tried.off < MUCH_LESS * made.off[going])
        found = going.copy()
        found[going] = better
        rows, among = np.repeat(found, locks.counts), np.repeat(better, locks.counts[going])
        made.rest.points[rows], made.lofted[rows] = tried.rest[among], tried.points[among]
        made.off[found], made.moving[found] = tried.off[better], tried.moving[better]
        stiffened[found] = factor
        going[going] = ~tried.good
        factor *= STIFFER
    if progress:
        progress("loft", len(locks), len(locks))
    return replace(made, stiffened=stiffened)


def _check(shot: Shot, locks: Curves) -> None:
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


def _borne(shot: Shot, groom: Groom, obstacles: Sequence[Obstacle]) -> Array:
    """What bears the locks where they were groomed [N], shape (n, 3); a soft nail, that part of the weight it does."""
    strands = make_strands(shot, groom)
    drawn = softly(groom.locks, 1.0 / (groom.space.fps * shot.solver.substeps))
    drawn = -np.outer(drawn * strands.masses, shot.forces.gravity)
    return drawn + support(shot, groom.locks, strands, _loads(shot, strands) + drawn, obstacles)


def _loads(shot: Shot, strands: Strands) -> Array:
    """What pulls at the vertices that move [N], shape (n, 3)."""
    loads = strands.loads(shot.forces.gravity, shot.forces.wind)
    loads[strands.held] = 0.0
    return loads


def _try(shot: Shot, groom: Groom, borne: Array, factor: float) -> _Try:
    """Balances locks that are ``factor`` times as stiff against bend, and nudges them to see whether they stand."""
    locks, stiffened = groom.locks, np.full(len(groom.locks), factor)
    rest, good = _balanced(shot, groom, borne, stiffened)
    strands = make_strands(shot, groom, rest, stiffened)
    groomed = np.asarray(locks.points, np.float64)
    nudge = NUDGE * np.random.default_rng(1).standard_normal(groomed.shape)
    strands.place(groomed + np.where(np.asarray(strands.held)[:, None], 0.0, nudge))
    moving = _let_fall(strands, shot, borne)
    off = per_lock(locks, np.linalg.norm(strands.positions - groomed, axis=1))
    return _Try(np.asarray(rest.points, np.float64), strands.positions.copy(), moving, off, good & (off < FALLING))


def _let_fall(strands: Strands, shot: Shot, borne: Array) -> Array:
    """Lets strands go where they want; returns how far each moved in the last step [m]."""
    gravity, wind = shot.forces.gravity, shot.forces.wind
    strands.settle(gravity=gravity, wind=wind, forces=borne, tolerance=STILL, steps=FALL - 1)
    before = strands.positions.copy()
    strands.settle(gravity=gravity, wind=wind, forces=borne, tolerance=STILL, steps=1)
    return per_lock(strands.curves, np.linalg.norm(strands.positions - before, axis=1))


def _balanced(shot: Shot, groom: Groom, borne: Array, stiffened: Array) -> tuple[Curves, Locks]:
    """The shape that locks must remember to balance their loads as groomed, and for which of them there is one.

    Stiffness and mass depend a little on the rest shape, so it takes some rounds.
    """
    locks, groomed = groom.locks, np.asarray(groom.locks.points, np.float64)
    frames = make_strands(shot, groom).directors.copy()
    shaped, strain = measure(locks, groomed, frames), measure(locks, groomed, frames)
    rest, going, good = groomed.copy(), np.ones(len(locks), bool), np.zeros(len(locks), bool)
    for done in range(shot.rest.iterations):
        rows = np.repeat(going, locks.counts)
        part = replace(groom, locks=locks.take(going))
        strands = make_strands(shot, part, part.locks.with_points(rest[rows]), stiffened[going])
        loads = _loads(shot, strands) + borne[rows]
        now = _strain(strands, balance(part.locks, groomed[rows], frames[rows], loads, shot.held))
        joints = shaped.take(rows).plus(now, -1.0)
        rest[rows], _ = shape(part.locks, joints, frames[rows])
        size, change, sharp = (
            per_lock(part.locks, np.linalg.norm(bend, axis=1))
            for bend in (now.bend, now.bend - strain.bend[rows], joints.bend)
        )
        strain.put(rows, now)
        balanced, soft = change <= SAME * size, sharp > SHARPEST
        good[going] = balanced & ~soft
        going[going] = ~balanced & ~(soft & (done > 0))
        if not going.any():
            break
    return locks.with_points(rest), good


def _strain(strands: Strands, forces: Joints) -> Joints:
    """By how much lengths, bends and twists differ from rest where they hold these forces.

    What lies between held vertices need not hold any; it stays as groomed, which is how the core knows its frames.
    """
    held = np.asarray(strands.held)
    held_edge = held & np.append(held[1:], False)
    held_corner = held_edge & np.append(False, held[:-1])
    held_twist = held_corner & np.append(held_corner[1:], False)
    stretch, bend, twist = (
        np.where((stiffness > 0.0) & ~fixed, stiffness, np.inf)
        for stiffness, fixed in zip(strands.stiffness, (held_edge, held_corner, held_twist), strict=True)
    )
    return Joints(forces.length / stretch, forces.bend / bend[:, None], forces.twist / twist)
