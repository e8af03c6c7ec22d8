"""Equilibrium: rest shapes from which a groom hangs as it was groomed, exactly, and stands where it is put.

What a strand must hold inside is known from the loads alone (``internal_forces``): its weight, and what bears it where it lies
(``contact_support``). Divided by the stiffness these are strains, and the groom less its strains is what the strand has to
remember. A lock that is too soft for its load, which would have to be bent into itself or would fall over however it is
pre-bent, is made stiffer until it stands.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.rest.contact_support import contact_support
from ringlet.rest.inverse_statics import internal_forces
from ringlet.rest.preload import STILL, Loft, Progress, hang_groom, largest_per_lock
from ringlet.rest.rod_strains import RodStrains, measure_strains, shape_of_strains
from ringlet.shot.shot import Shot
from ringlet.shot.variation import Mapped
from ringlet.sim.motion import make_strands
from ringlet.sim.nails import rigid_elements, spring_fraction
from ringlet.sim.obstacle import Obstacle
from ringlet.sim.strands import Strands

Array = NDArray[np.float64]
Locks = NDArray[np.bool_]

SAME = 1e-5  # change of a lock's strains from round to round, by their size, at which they are found
SHARPEST = 2.6  # bend of a corner at rest above which a lock counts as too soft [rad]
STIFFER = 1.5  # a lock that does not balance becomes so much stiffer at once
TRIES = 20  # to make locks stiff enough
PUSH = 1e-5  # of its weight: with so much a lock is pushed that falls, to begin with
FALL = 12  # steps of 1 s in which it falls
FALLING = 1e-5  # a lock that hangs farther away than this from the groom that it remembers falls [m]
MUCH_LESS = 0.1  # of how far it is away: so near is what is kept though it does not stand


@dataclass
class _Try:
    """Locks that remember some shape, some times as stiff: where they come to rest, and which balance and stand.

    needed: times that each must be stiffer still, as far as is known
    """

    factor: Array
    rest: Array
    points: Array
    moving: Array
    off: Array
    good: Locks
    needed: Array


def equilibrium(
    shot: Shot,
    groom: Groom,
    *,
    obstacles: Sequence[Obstacle] = (),
    borne: Array | None = None,
    frames: Array | None = None,
    progress: Progress | None = None,
) -> Loft:
    """Finds what the locks of ``groom`` must remember to be still as groomed, under the forces of ``shot``.

    obstacles: what locks may lie on, where the shot has contact, in the rest pose
    borne:     what ``bearing`` says of these locks, where they are some of a groom [N], shape (n, 3)
    frames:    their directors where they were groomed, shape (n, 3), where they are known

    A lock that would fall is stiffened, up to ``rest.stiffen`` times; one that falls even so keeps its stiffness and
    its groomed shape, or what hangs ten times nearer to it.
    """
    locks = groom.locks
    locks.check("loft: locks")
    _check(shot, locks)
    strands, most = make_strands(shot, groom), shot.rest.stiffen
    frames = strands.directors.copy() if frames is None else frames
    borne = support_forces(shot, groom, obstacles, strands) if borne is None else borne
    held_up = borne + _drawn(shot, groom, strands)
    going, soft, factor = np.ones(len(locks), bool), np.zeros(len(locks), bool), np.ones(len(locks))
    made = _nothing_tried(groom, borne)

    def tried(which: Locks, fall: bool = False) -> _Try:
        part, rows = replace(groom, locks=locks.take(which)), np.repeat(which, locks.counts)
        return _try(shot, part, frames[rows], held_up[rows], factor[which], fall)

    for _ in range(TRIES):
        if progress:
            progress("loft", int((~going).sum()), len(locks))
        found = tried(going)
        _put(made, going, found, found.good)
        factor[going] *= found.needed
        going[going] = ~found.good
        soft |= going & (factor > most)
        going &= ~soft
        if not going.any():
            break
    soft |= going
    if soft.any():
        factor[soft] = most
        _put(made, soft, tried(soft, fall=True), np.ones(soft.sum(), bool))
        plain = _plain(shot, replace(groom, locks=locks.take(soft)))
        _put(made, soft, plain, made.off[soft] >= MUCH_LESS * plain.off)
    if progress:
        progress("loft", len(locks), len(locks))
    return made


def _nothing_tried(groom: Groom, borne: Array) -> Loft:
    count, points = len(groom.locks), np.array(groom.locks.points, np.float64)
    nowhere = np.full(count, np.inf)
    return Loft(
        groom, groom.locks.with_points(points), None, points.copy(), nowhere, nowhere.copy(), nowhere.copy(), borne
    )


def _put(made: Loft, going: Locks, tried: _Try, better: Locks) -> None:
    """Takes over what was tried of the locks that are still going where it is better."""
    assert made.stiffened is not None
    found, counts = going.copy(), made.rest.counts
    found[going] = better
    rows, among = np.repeat(found, counts), np.repeat(better, counts[going])
    made.rest.points[rows], made.lofted[rows] = tried.rest[among], tried.points[among]
    made.off[found], made.moving[found] = tried.off[better], tried.moving[better]
    made.stiffened[found] = tried.factor[better]


def _plain(shot: Shot, groom: Groom) -> _Try:
    """How locks hang that remember the groom."""
    plain, ones = hang_groom(shot, groom), np.ones(len(groom.locks))
    rest = np.array(groom.locks.points, np.float64)
    return _Try(ones, rest, plain.points, plain.moving, plain.off, plain.off < FALLING, ones)


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


def support_forces(shot: Shot, groom: Groom, obstacles: Sequence[Obstacle], strands: Strands | None = None) -> Array:
    """What bears the locks of a groom where they were groomed: bodies, nails and one another [N], shape (n, 3).

    strands: those locks, there, as ``contact_support`` takes them; by default they are made
    """
    strands = make_strands(shot, groom) if strands is None else strands
    return contact_support(
        shot, groom.locks, strands, external_loads(shot, strands) + _drawn(shot, groom, strands), obstacles
    )


def _drawn(shot: Shot, groom: Groom, strands: Strands) -> Array:
    """What soft nails bear of the weight [N], shape (n, 3)."""
    part = spring_fraction(groom.locks, 1.0 / (groom.space.fps * shot.solver.substeps))
    return -np.outer(part * strands.masses, shot.forces.gravity)


def external_loads(shot: Shot, strands: Strands) -> Array:
    """What pulls at the vertices that move [N], shape (n, 3)."""
    pulls = strands.loads(shot.forces.gravity, shot.forces.wind)
    pulls[strands.held] = 0.0
    return pulls


def _try(shot: Shot, groom: Groom, frames: Array, borne: Array, factor: Array, fall: bool) -> _Try:
    """Balances locks that are some times as stiff against bend, and sees whether they stand and are still.

    frames: the directors of the locks where they were groomed, shape (n, 3)
    fall:   push them and let them fall, until they hang
    """
    locks, groomed = groom.locks, np.asarray(groom.locks.points, np.float64)
    rest, balanced = _balanced(shot, groom, frames, borne, factor)
    strands = make_strands(shot, groom, rest, factor)
    strands.place(groomed)
    needed = strands.stiffness_to_stand(shot.rest.spring / factor, shot.rest.stiffen)
    if fall:
        _let_go(strands, shot, borne + _push(external_loads(shot, strands), locks), 1)
    moving = _let_go(strands, shot, borne, FALL if fall else 1)
    off = largest_per_lock(locks, np.linalg.norm(strands.positions - groomed, axis=1))
    still = balanced & (off < FALLING)
    good = still & (needed == 1.0)
    needed = np.where(still, needed, np.maximum(needed, STIFFER))
    return _Try(factor, np.asarray(rest.points, np.float64), strands.positions.copy(), moving, off, good, needed)


def _push(pulls: Array, locks: Curves) -> Array:
    """A small part of the size of what pulls at each lock [N], each in some direction of its own, shape (n, 3)."""
    way = np.random.default_rng(1).standard_normal((len(locks), 3))
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    return PUSH * np.linalg.norm(pulls, axis=1, keepdims=True) * np.repeat(way, locks.counts, axis=0)


def _let_go(strands: Strands, shot: Shot, borne: Array, steps: int) -> Array:
    """Lets strands go where they want for a time; returns how far each moved in the last step [m]."""
    gravity, wind = shot.forces.gravity, shot.forces.wind
    settle = partial(strands.settle, gravity=gravity, wind=wind, forces=borne, tolerance=STILL)
    if steps > 1:
        settle(steps=steps - 1)
    before = strands.positions.copy()
    settle(steps=1)
    return largest_per_lock(strands.curves, np.linalg.norm(strands.positions - before, axis=1))


def _balanced(shot: Shot, groom: Groom, frames: Array, borne: Array, stiffened: Array) -> tuple[Curves, Locks]:
    """The shape that locks must remember to balance their loads as groomed, and for which of them there is one.

    Stiffness and mass depend a little on the rest shape, so it takes some rounds.
    """
    locks, groomed = groom.locks, np.asarray(groom.locks.points, np.float64)
    shaped = measure_strains(locks, groomed, frames)
    strain = shaped.take(np.ones(len(groomed), bool))
    rest, going, good = groomed.copy(), np.ones(len(locks), bool), np.zeros(len(locks), bool)
    for done in range(shot.rest.iterations):
        rows = np.repeat(going, locks.counts)
        part = replace(groom, locks=locks.take(going))
        strands = make_strands(shot, part, part.locks.with_points(rest[rows]), stiffened[going])
        pulls = external_loads(shot, strands) + borne[rows]
        balanced = partial(internal_forces, part.locks, groomed[rows], frames[rows], pulls, shot.held)
        now = _strain_between_nails(strands, balanced)
        joints = shaped.take(rows).plus(now, -1.0)
        rest[rows], _ = shape_of_strains(part.locks, joints, frames[rows])
        size, change, sharp = (
            largest_per_lock(part.locks, np.linalg.norm(bend, axis=1))
            for bend in (now.bend, now.bend - strain.bend[rows], joints.bend)
        )
        strain.put(rows, now)
        balanced, soft = change <= SAME * size, sharp > SHARPEST
        good[going] = balanced & ~soft
        going[going] = ~balanced & ~(soft & (done > 0))
        if not going.any():
            break
    return locks.with_points(rest), good


def _strain(strands: Strands, forces: RodStrains) -> RodStrains:
    """By how much lengths, bends and twists differ from rest where they hold these forces.

    What lies between held vertices need not hold any; it stays as groomed, which is how the core knows its frames.
    """
    stretch, bend, twist = (
        np.where((stiffness > 0.0) & ~never, stiffness, np.inf)
        for stiffness, never in zip(strands.stiffness, rigid_elements(np.asarray(strands.held)), strict=True)
    )
    return RodStrains(forces.length / stretch, forces.bend / bend[:, None], forces.twist / twist)


def _strain_between_nails(strands: Strands, balanced: Callable[[Array], RodStrains]) -> RodStrains:
    """The strains that balance the loads, with nails that turn edges about themselves such that these stay.

    The director of an edge between nails is where twist at rest leads it from the root. In the groom it is there too if
    the twists by which these two differ cancel from the root to the nail; twist is linear in what nails turn with.

    balanced: the forces and moments that balance the loads with what turns each edge's director besides [N m], (n,)
    """
    locks, stiffness = strands.curves, strands.stiffness[2]
    turning = np.zeros(len(stiffness))
    strain = _strain(strands, balanced(turning))
    nailed = _first_nailed(strands)
    if not nailed.any():
        return strain
    lock, which = np.searchsorted(locks.offsets, np.flatnonzero(nailed), side="right") - 1, np.cumsum(nailed)
    which = (which - np.append(0, which)[locks.offsets[:-1]].repeat(locks.counts))[nailed] - 1
    place, rows = np.flatnonzero(nailed), which.max() + 1

    def turned(strain: RodStrains) -> Array:
        """By how much the first edge of each row of nails is turned, shape (count, rows)."""
        angle, sums = np.zeros((len(locks), rows)), np.append(0.0, np.cumsum(strain.twist))
        angle[lock, which] = sums[place] - sums[locks.offsets[lock]]
        return angle

    by_loads, by_each = turned(strain), np.tile(np.eye(rows), (len(locks), 1, 1))
    for k in range(rows):
        of = which == k
        turning[:] = 0.0
        turning[place[of]] = stiffness[place[of] - 1]
        by_each[lock[of], :, k] = (turned(_strain(strands, balanced(turning))) - by_loads)[lock[of]]
    turning[place] = np.linalg.solve(by_each, -by_loads[:, :, None])[lock, which, 0] * stiffness[place - 1]
    return _strain(strands, balanced(turning))


def _first_nailed(strands: Strands) -> Locks:
    """The edges at which a row of nails begins that hold them, shape (n,)."""
    held_edge, _, _ = rigid_elements(np.asarray(strands.held))
    held_edge[strands.curves.offsets[1:] - 1] = False
    return held_edge & ~np.append(True, held_edge[:-1]) & ~_at(strands.curves.offsets[:-1], len(held_edge))


def _at(rows: NDArray[np.integer], count: int) -> Locks:
    """Some of so many rows, as a mask."""
    mask = np.zeros(count, bool)
    mask[rows] = True
    return mask
