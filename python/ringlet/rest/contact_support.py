"""Support forces: how pins, bodies and other locks share the weight of a groom.

Statics alone does not determine them. Of all forces that carry the loads, an elastic body takes those of least strain
energy; to first order, these act when locks remember the groom and are released. Contacts only push, and friction is
counted on for a fraction of Coulomb's cone, so the least is a nonnegative quadratic program. A penalty on the forces
themselves keeps a body from pressing a lock near its root with many times its weight, as on a lever.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array

from ringlet.data.curves import Curves
from ringlet.rest.compliance import Compliance
from ringlet.rest.nonnegative_qp import solve_nonnegative_qp
from ringlet.shot.contact import ShotContact
from ringlet.shot.shot import Shot
from ringlet.sim.friction import LOCKS, friction_matrix, override_pairs
from ringlet.sim.obstacle import Obstacle
from ringlet.sim.resting_contacts import RestingContacts, resting_contacts
from ringlet.sim.strands import Strands

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

CONTACT_PENALTY = 0.1  # of a contact that carries the lock's whole weight, per strain energy under the loads
PIN_PENALTY = 1e-6  # the same of pins, which may pull as hard as they must
FRICTION_FRACTION = 0.1  # of Coulomb's friction that support counts on


@dataclass
class UnitForces:
    """Forces of 1 N, or couples of 1 N on the arm ``ARM``, whose amounts are unknown; each acts in one row or more.

    of:     the unknown that each row belongs to, shape (k,); the rows of one follow each other
    vertex: the vertex that it acts on, shape (k,)
    force:  its direction and size, shape (k, 3)
    couple: about the edge that begins there, shape (k,)
    free:   per unknown, whether it may be negative, shape (unknowns,)
    """

    of: Indices
    vertex: Indices
    force: Array
    couple: Array
    free: NDArray[np.bool_]


def contact_support(shot: Shot, locks: Curves, strands: Strands, loads: Array, obstacles: Sequence[Obstacle]) -> Array:
    """The forces [N] that support locks where they were groomed, at their vertices, shape (n, 3).

    strands: the locks, with their stiffness, where they were groomed
    loads:   what pulls at them besides [N], shape (n, 3)
    """
    forces, contact = np.zeros_like(loads), shot.touching
    of_pins = _pin_forces(shot.held, locks, np.asarray(strands.held))
    of_contacts = None
    if contact is not None:
        contacts = resting_contacts(contact, locks, strands, obstacles)
        of_contacts = _contact_forces(contacts, FRICTION_FRACTION * _friction(contact, obstacles)[0, contacts.body])
    unit = of_pins if of_contacts is None else _joined(of_pins, of_contacts)
    if unit.free.size:
        amounts = _least_energy(unit, shot.held, locks, strands, loads)
        np.add.at(forces, unit.vertex, amounts[unit.of, None] * unit.force)
    return forces


def _joined(one: UnitForces, other: UnitForces) -> UnitForces:
    return UnitForces(
        np.concatenate([one.of, other.of + len(one.free)]),
        np.concatenate([one.vertex, other.vertex]),
        np.concatenate([one.force, other.force]),
        np.concatenate([one.couple, other.couple]),
        np.concatenate([one.free, other.free]),
    )


def _pin_forces(from_root: int, locks: Curves, held: NDArray[np.bool_]) -> UnitForces:
    """Pins hold in every direction; a row of them is clamped, and its first two stand for all of it."""
    number = np.arange(len(held)) - np.repeat(locks.offsets[:-1], locks.counts)
    pinned = held & (number >= from_root)
    first = pinned & ~np.append(False, held[:-1])
    second = np.append(False, first[:-1]) & pinned
    vertex, clamped = np.flatnonzero(first | second), np.flatnonzero(second) - 1
    forces, couples = 3 * len(vertex), len(clamped)
    return UnitForces(
        np.arange(forces + couples),
        np.concatenate([np.repeat(vertex, 3), clamped]),
        np.concatenate([np.tile(np.eye(3), (len(vertex), 1)), np.zeros((couples, 3))]),
        np.append(np.zeros(forces), np.ones(couples)),
        np.ones(forces + couples, bool),
    )


def _friction(contact: ShotContact, obstacles: Sequence[Obstacle]) -> Array:
    """Coulomb's μ of each pair of materials: locks, then each obstacle."""
    names = [LOCKS, *(obstacle.name for obstacle in obstacles)]
    pairs = [pair for pair in contact.pair if set(pair.between) <= set(names)]
    return override_pairs(friction_matrix(contact, [], [one.body(0.0) for one in obstacles]), pairs, names)


def _contact_forces(contacts: RestingContacts, friction: Array) -> UnitForces:
    """Contacts push, and hold across by friction, shape (k,): along the four edges of a linearised friction cone."""
    normal, vertex, weight = contacts.normal, contacts.acting, contacts.weights
    tangent = np.cross(normal, np.eye(3)[np.abs(normal).argmin(axis=1)])
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    tangents = np.stack([tangent, -tangent, np.cross(normal, tangent), -np.cross(normal, tangent)], axis=1)
    edges = normal[:, None] + friction[:, None, None] * tangents
    unknowns, vertices = edges.shape[0] * edges.shape[1], vertex.shape[1]
    of = np.repeat(np.arange(unknowns), vertices)
    return UnitForces(
        of,
        np.repeat(vertex[:, None], edges.shape[1], axis=1).reshape(-1),
        np.einsum("kwi,kv->kwvi", edges, weight).reshape(-1, 3),
        np.zeros(len(of)),
        np.zeros(unknowns, bool),
    )


def _least_energy(unit: UnitForces, held: int, locks: Curves, strands: Strands, loads: Array) -> Array:
    """The amounts of the unit forces that strain the locks least, shape (unknowns,).

    Minimises Σ strain² stiffness + penalty · E · Σ (f / weight)², where E is the first sum of a lock under its loads
    alone. Forces of different locks are coupled only by contacts of both.
    """
    compliance, count = Compliance(held, locks, strands), len(unit.free)
    of_loads = compliance.wrenches(np.arange(len(loads)), loads)
    of_units = compliance.wrenches(unit.vertex, unit.force, unit.couple)
    weight = np.maximum(np.add.reduceat(np.linalg.norm(loads, axis=1), locks.offsets[:-1]), 1e-300)
    penalty = np.where(unit.free, PIN_PENALTY, CONTACT_PENALTY)
    row, column, entries, gradient = [], [], [], np.zeros(count)
    lock = np.searchsorted(locks.offsets, unit.vertex, side="right") - 1
    order = np.argsort(lock, kind="stable")
    for chosen in np.split(order, np.flatnonzero(np.diff(lock[order])) + 1):
        which, of = lock[chosen[0]], unit.of[chosen]
        rows, begin = slice(*locks.offsets[which:][:2]), np.flatnonzero(np.append(True, of[1:] != of[:-1]))
        vertex, wrenches, unknown = unit.vertex[chosen] - rows.start, of_units[chosen], of[begin]
        energy, derivative = compliance.under_loads(rows, of_loads[rows])
        square = compliance.of_pairs(rows, vertex, wrenches)
        square = np.add.reduceat(np.add.reduceat(square, begin, axis=0), begin, axis=1)
        square.flat[:: len(unknown) + 1] += penalty[unknown] * (energy / weight[which] ** 2)
        gradient[unknown] += np.add.reduceat((derivative[vertex] * wrenches).sum(axis=1), begin)
        column.append(np.broadcast_to(unknown, square.shape).ravel())
        row.append(unknown.repeat(len(unknown)))
        entries.append(square.ravel())
    matrix = coo_array((np.concatenate(entries), (np.concatenate(row), np.concatenate(column))), (count, count))
    return solve_nonnegative_qp(matrix.tocsr(), gradient, unit.free)
