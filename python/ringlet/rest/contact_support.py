"""What a groom rests on: the forces with which nails, bodies and other locks bear locks where they lie.

A lock that lies on a body or on another lock need not hold up all of its weight, and one that is nailed hangs from its
nails too. Statics alone does not say how much each of these bears. Here it is what strains the locks least, by the sum
over their joints of moment² / stiffness, while what touches only pushes, and holds by friction no more than a part of
that. To first order this is what they would bear if the locks remembered the groom and were let go: of all ways to
carry a load what is elastic takes that of least energy. Forces count a little themselves, or a body would press on a
lock near its root with many times its weight, as on a lever.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array

from ringlet.data.curves import Curves
from ringlet.rest.nonnegative_qp import solve_nonnegative_qp
from ringlet.rest.rod_strains import corners, edges, twists
from ringlet.shot.contact import ShotContact
from ringlet.shot.shot import Shot
from ringlet.sim.friction import LOCKS, friction_matrix, override_pairs
from ringlet.sim.nails import rigid_elements
from ringlet.sim.obstacle import Obstacle
from ringlet.sim.resting_contacts import RestingContacts, resting_contacts
from ringlet.sim.strands import Strands

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

SHY = 0.1  # of the strain energy under the loads: what it counts to be borne by one's whole weight in one place
FIRM = 1e-6  # the same of nails, which may pull as hard as they like
HOLDS = 0.1  # of Coulomb's friction: what it is counted on for
ARM = 0.01  # a nail's couple of 1 is one newton on this arm [m]


@dataclass
class Ways:
    """Ways in which locks may be borne, each by a force that is to be found, of 1 N where it is 1.

    of:     which force, shape (k,): each is told by one row or more, one after the other
    vertex: on what it acts, shape (k,)
    force:  how, shape (k, 3)
    couple: about the edge that begins there, times ARM, shape (k,)
    free:   of each force, whether it may be negative, shape (forces,)
    """

    of: Indices
    vertex: Indices
    force: Array
    couple: Array
    free: NDArray[np.bool_]


def contact_support(shot: Shot, locks: Curves, strands: Strands, loads: Array, obstacles: Sequence[Obstacle]) -> Array:
    """The forces [N] that bear locks where they were groomed, at their vertices, shape (n, 3).

    strands: the locks, with their stiffness, where they were groomed
    loads:   what pulls at them besides [N], shape (n, 3)
    """
    forces, contact = np.zeros_like(loads), shot.touching
    ways = [_nails(shot.held, locks, np.asarray(strands.held))]
    if contact is not None:
        rests = resting_contacts(contact, locks, strands, obstacles)
        ways.append(_pushing(rests, HOLDS * _friction(contact, obstacles)[0, rests.body]))
    all_ways = _joined(ways)
    if all_ways.free.size:
        found = _least(all_ways, shot.held, locks, strands, loads)
        np.add.at(forces, all_ways.vertex, found[all_ways.of, None] * all_ways.force)
    return forces


def _joined(parts: Sequence[Ways]) -> Ways:
    begin = np.cumsum([0, *(len(part.free) for part in parts)])
    return Ways(
        np.concatenate([part.of + first for part, first in zip(parts, begin[:-1], strict=True)]),
        np.concatenate([part.vertex for part in parts]),
        np.concatenate([part.force for part in parts]),
        np.concatenate([part.couple for part in parts]),
        np.concatenate([part.free for part in parts]),
    )


def _nails(from_root: int, locks: Curves, held: NDArray[np.bool_]) -> Ways:
    """Nails hold in every direction; several in a row, of which the first two tell all, hold what is between too."""
    number = np.arange(len(held)) - np.repeat(locks.offsets[:-1], locks.counts)
    nailed = held & (number >= from_root)
    first = nailed & ~np.append(False, held[:-1])
    second = np.append(False, first[:-1]) & nailed
    vertex, clamped = np.flatnonzero(first | second), np.flatnonzero(second) - 1
    pushed, turned = 3 * len(vertex), len(clamped)
    return Ways(
        np.arange(pushed + turned),
        np.concatenate([np.repeat(vertex, 3), clamped]),
        np.concatenate([np.tile(np.eye(3), (len(vertex), 1)), np.zeros((turned, 3))]),
        np.append(np.zeros(pushed), np.ones(turned)),
        np.ones(pushed + turned, bool),
    )


def _friction(contact: ShotContact, obstacles: Sequence[Obstacle]) -> Array:
    """Coulomb's μ of each pair of materials: locks, then each obstacle."""
    names = [LOCKS, *(obstacle.name for obstacle in obstacles)]
    told = [pair for pair in contact.pair if set(pair.between) <= set(names)]
    return override_pairs(friction_matrix(contact, [], [one.body(0.0) for one in obstacles]), told, names)


def _pushing(rests: RestingContacts, friction: Array) -> Ways:
    """What touches pushes, and holds across by friction, shape (k,).

    A cone of friction has four edges here; a force within is a sum of pushes along them.
    """
    normal, vertex, weight = rests.away, rests.acting, rests.weights
    across = np.cross(normal, np.eye(3)[np.abs(normal).argmin(axis=1)])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    sides = np.stack([across, -across, np.cross(normal, across), -np.cross(normal, across)], axis=1)
    way = normal[:, None] + friction[:, None, None] * sides
    each, parts = way.shape[0] * way.shape[1], vertex.shape[1]
    force = np.einsum("kwi,kv->kwvi", way, weight).reshape(-1, 3)
    of = np.repeat(np.arange(each), parts)
    vertices = np.repeat(vertex[:, None], way.shape[1], axis=1).reshape(-1)
    return Ways(of, vertices, force, np.zeros(len(of)), np.zeros(each, bool))


def _least(ways: Ways, held: int, locks: Curves, strands: Strands, loads: Array) -> Array:
    """The forces with which locks are strained least, shape (forces,).

    Minimises Σ strain² stiffness + SHY · E · Σ (f / weight)², where E is the first sum of a lock under its loads alone.
    """
    give, count = Compliance(held, locks, strands), len(ways.free)
    everywhere = np.arange(len(loads))
    by_loads, by_ways = give.pull(everywhere, loads), give.pull(ways.vertex, ways.force, ways.couple)
    weight = np.maximum(np.add.reduceat(np.linalg.norm(loads, axis=1), locks.offsets[:-1]), 1e-300)
    shy = np.where(ways.free, FIRM, SHY)
    row, column, entries, slope = [], [], [], np.zeros(count)
    lock = np.searchsorted(locks.offsets, ways.vertex, side="right") - 1
    order = np.argsort(lock, kind="stable")
    for chosen in np.split(order, np.flatnonzero(np.diff(lock[order])) + 1):
        which, of = lock[chosen[0]], ways.of[chosen]
        rows, begin = slice(*locks.offsets[which:][:2]), np.flatnonzero(np.append(True, of[1:] != of[:-1]))
        vertex, pulls, force = ways.vertex[chosen] - rows.start, by_ways[chosen], of[begin]
        alone, strained = give.under_loads(rows, by_loads[rows])
        square = give.under_two(rows, vertex, pulls)
        square = np.add.reduceat(np.add.reduceat(square, begin, axis=0), begin, axis=1)
        square.flat[:: len(force) + 1] += shy[force] * (alone / weight[which] ** 2)
        slope[force] += np.add.reduceat((strained[vertex] * pulls).sum(axis=1), begin)
        column.append(np.broadcast_to(force, square.shape).ravel())
        row.append(force.repeat(len(force)))
        entries.append(square.ravel())
    matrix = coo_array((np.concatenate(entries), (np.concatenate(row), np.concatenate(column))), (count, count))
    return solve_nonnegative_qp(matrix.tocsr(), slope, ways.free)


class Compliance:
    """How locks give way to forces at their vertices, as beams that are clamped at their roots.

    A pull is a force with its moment about the lock's root, (moment, force). All joints before the vertex at which it
    acts are strained by it: the energy that two pulls a and b have there together, strain · strain · stiffness, is
    a · C b with a matrix C of each joint. So that of a lock under two of them is a · (Σ C) b, over the joints before
    the nearer of both.
    """

    def __init__(self, held: int, locks: Curves, strands: Strands) -> None:
        points = np.asarray(locks.points, np.float64)
        number = np.arange(len(points)) - np.repeat(locks.offsets[:-1], locks.counts)
        everywhere = np.arange(len(points))
        self._tangents = edges(locks, points)[1]
        self._arms = points - np.repeat(points[locks.offsets[:-1]], locks.counts, axis=0)
        stretch, bend, twist = (
            np.where(np.isin(everywhere, of) & (number >= first) & (of_all > 0.0) & ~never, of_all, np.inf) ** -1.0
            for of, first, of_all, never in zip(
                (everywhere, corners(locks), twists(locks)),
                (held - 1, held - 1, held - 2),
                strands.stiffness,
                rigid_elements(np.asarray(strands.held)),
                strict=True,
            )
        )
        self._joints = _softness(self._arms, self._tangents, stretch, bend, twist)

    def pull(self, vertex: Indices, force: Array, couple: Array | None = None) -> Array:
        """Forces [N] on vertices, with couples about the edges that begin there, as pulls, shape (k, 6)."""
        moment = np.cross(self._arms[vertex], force)
        if couple is not None:
            moment += (ARM * couple)[:, None] * self._tangents[vertex]
        return np.concatenate([moment, force], axis=1)

    def under_loads(self, rows: slice, pulls: Array) -> tuple[float, Array]:
        """The energy of a lock under all of these pulls, shape (m, 6), at its vertices.

        Also what a pull at each vertex has together with them is to be multiplied with, shape (m, 6).
        """
        beyond = np.cumsum(pulls[::-1], axis=0)[::-1] - pulls
        strained = np.einsum("nij,nj->ni", self._joints[rows], beyond)
        return float((beyond * strained).sum()), np.cumsum(strained, axis=0) - strained

    def under_two(self, rows: slice, vertex: Indices, pulls: Array) -> Array:
        """The energy of a lock under every two of some pulls at vertices, counted from its root, shape (k, k)."""
        joints = self._joints[rows]
        before = np.cumsum(joints, axis=0) - joints
        by_each = np.einsum("kij,kj->ki", before[vertex], pulls) @ pulls.T
        return np.where(vertex[:, None] <= vertex, by_each, by_each.T)


def _softness(arms: Array, tangents: Array, stretch: Array, bend: Array, twist: Array) -> Array:
    """The matrices C of ``Compliance``, of joints at ``arms`` from their roots, shape (n, 6, 6); of 1 / stiffness, (n,).

    A pull (m, f) has the moment M = m - arm × f at a joint. With A = bend (1 - t tᵀ) + twist t tᵀ its energy there is
    M · A M + stretch (t · f)².
    """
    along = tangents[:, :, None] * tangents[:, None]
    of_moment = bend[:, None, None] * (np.eye(3) - along) + twist[:, None, None] * along
    moment = np.zeros((len(arms), 3, 6))
    moment[:, :, :3] = np.eye(3)
    moment[:, :, 3:] = np.cross(np.eye(3), arms[:, None]).transpose(0, 2, 1)
    joints = moment.transpose(0, 2, 1) @ of_moment @ moment
    joints[:, 3:, 3:] += stretch[:, None, None] * along
    return joints
