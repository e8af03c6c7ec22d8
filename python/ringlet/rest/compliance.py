"""Compliance: the strain energy of locks under forces at their vertices, as of beams that are clamped at their roots.

A wrench is a force with its moment about the lock's root, (moment, force). It strains every joint between the root and
the vertex at which it acts. Two wrenches a and b have the energy a · C b at a joint, with C the joint's compliance
matrix; the energy of a lock is a · (Σ C) b over the joints that both strain.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.rest.rod_strains import corners, edges, twists
from ringlet.sim.hair_pins import rigid_elements
from ringlet.sim.strands import Strands

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

ARM = 0.01  # a couple of 1 is one newton on this arm [m]


class Compliance:
    """Locks as beams: edges stretch, bend and twist; what is held near the root or between pins is rigid.

    held: vertices of each lock that are held from its root
    """

    def __init__(self, held: int, locks: Curves, strands: Strands) -> None:
        points = np.asarray(locks.points, np.float64)
        vertices = np.arange(len(points))
        number = vertices - np.repeat(locks.offsets[:-1], locks.counts)
        _, self._tangents = edges(locks, points)
        self._arms = points - np.repeat(points[locks.offsets[:-1]], locks.counts, axis=0)
        stretch, bend, twist = (
            np.where(np.isin(vertices, where) & (number >= first) & (stiffness > 0.0) & ~rigid, stiffness, np.inf)
            ** -1.0
            for where, first, stiffness, rigid in zip(
                (vertices, corners(locks), twists(locks)),
                (held - 1, held - 1, held - 2),
                strands.stiffness,
                rigid_elements(np.asarray(strands.held)),
                strict=True,
            )
        )
        self._joints = _compliance_matrices(self._arms, self._tangents, stretch, bend, twist)

    def wrenches(self, vertex: Indices, force: Array, couple: Array | None = None) -> Array:
        """Forces [N] on vertices and couples about the edges that begin there, as wrenches, shape (k, 6)."""
        moment = np.cross(self._arms[vertex], force)
        if couple is not None:
            moment += (ARM * couple)[:, None] * self._tangents[vertex]
        return np.concatenate([moment, force], axis=1)

    def under_loads(self, rows: slice, wrenches: Array) -> tuple[float, Array]:
        """The energy of a lock under a wrench at each of its vertices, shape (m, 6), and its derivative by each.

        The derivative is by a further wrench at the vertex, shape (m, 6).
        """
        beyond = np.cumsum(wrenches[::-1], axis=0)[::-1] - wrenches
        strained = np.einsum("nij,nj->ni", self._joints[rows], beyond)
        return float((beyond * strained).sum()), np.cumsum(strained, axis=0) - strained

    def of_pairs(self, rows: slice, vertex: Indices, wrenches: Array) -> Array:
        """The energy of a lock under each pair of wrenches at vertices, counted from its root, shape (k, k)."""
        joints = self._joints[rows]
        before = np.cumsum(joints, axis=0) - joints
        energy = np.einsum("kij,kj->ki", before[vertex], wrenches) @ wrenches.T
        return np.where(vertex[:, None] <= vertex, energy, energy.T)


def _compliance_matrices(arms: Array, tangents: Array, stretch: Array, bend: Array, twist: Array) -> Array:
    """The matrices C of joints at ``arms`` from their roots, shape (n, 6, 6); of 1 / stiffness, shapes (n,).

    A wrench (m, f) has the moment M = m - arm × f at a joint. With A = bend (1 - t tᵀ) + twist t tᵀ its energy there is
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
