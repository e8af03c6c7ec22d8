"""Bounce and swing of hanging locks, by linear theory about the shape in which they hang.

A lock is a curved rod, clamped at its root. Smooth loads, its mass times Legendre polynomials of the place along it,
pull it along its axis from root to tip and across, and turn it about the axis. The motions that they cause, by
Castigliano's theorem, are the basis of Ritz's method: a mode q of frequency ω is a solution of

    (F + G) q = ω² M q

with the flexibility F of the loads, the geometric stiffness G of weight and moments, and the inertia M. Bounce is the
mode that a pull along the axis works on most, swing the one that a pull across it works on most.
docs/theory/hanging_coil.md derives it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from ringlet.data.curves import Curves

Array = NDArray[np.float64]

ORDERS = 4  # polynomials of each kind of load
AT_ONCE = 1 << 11  # vertices whose motions are in memory at once
STANDS = 1e-9  # least stiffness of a lock that stays in place, relative to its largest


class Strands(Protocol):
    """Strands as ``ringlet.sim.strands`` has them: arrays of vertices, shapes (n,), in SI units."""

    curves: Curves
    held: int | NDArray[np.bool_]

    @property
    def masses(self) -> Array: ...
    @property
    def drag(self) -> Array: ...
    @property
    def damping(self) -> Array: ...
    @property
    def stiffness(self) -> tuple[Array, Array, Array]: ...


@dataclass
class Mode:
    """A motion of each lock, per generalised mass; shapes (count,). NaN where a lock does not stay in place.

    elastic: stiffness of stretch, bend and twist [1/s²]
    weight:  geometric stiffness of weight and moments [1/s²]
    damping: resistance of stretch, bend and twist to their rates [1/s]
    drag:    resistance of the air [1/s]
    """

    elastic: Array
    weight: Array
    damping: Array
    drag: Array


@dataclass
class Modes:
    """The smooth motions of hanging locks, from which modes follow for any stiffness.

    All have the shape (count, motions, motions). Motions are ordered by their loads: along, across, across, about the
    axis, with the orders of each.

    flexibility: F of the loads [J]
    weight:      G of weight and moments [J]
    damping:     F with each strain times its damping time [J s]
    drag:        resistance of the air [J s]
    inertia:     M [J s²]
    """

    flexibility: Array
    weight: Array
    damping: Array
    drag: Array
    inertia: Array

    def bounce(self, stiffer: Array | float = 1.0) -> Mode:
        """The mode along the axis of locks that are so many times stiffer."""
        return self._mode(slice(0, 1), stiffer)

    def swing(self, stiffer: Array | float = 1.0) -> Mode:
        """The mode across the axis of locks that are so many times stiffer."""
        return self._mode(slice(1, 3), stiffer)

    def _mode(self, pulls: slice, stiffer: Array | float) -> Mode:
        """The mode that uniform loads in some of the directions work on most."""
        stiffer = np.reshape(stiffer, (-1, 1, 1))
        elastic = stiffer * self.flexibility
        size = np.sqrt(np.einsum("lii->li", elastic))
        known = (np.isfinite(size) & (size > 0.0)).all(axis=1)
        size[~known] = 1.0
        scaled = np.where(known[:, None, None], elastic + self.weight, 0.0) / (size[:, :, None] * size[:, None])
        values, vectors = np.linalg.eigh(scaled)
        stands = known & (values[:, 0] > STANDS * np.abs(values[:, -1]))
        root = vectors / np.sqrt(np.where(stands[:, None], values, 1.0))[:, None] / size[:, :, None]
        modes = root @ np.linalg.eigh(np.where(stands[:, None, None], _between(root, self.inertia), 0.0))[1]
        worked = np.sum((self.flexibility[:, ::ORDERS][:, pulls] @ modes) ** 2, axis=1)
        q = np.take_along_axis(modes, np.nan_to_num(worked).argmax(axis=1)[:, None, None], axis=2)
        mass = np.where(stands, _between(q, self.inertia)[:, 0, 0], np.nan)
        matrices = elastic, self.weight, stiffer * self.damping, self.drag
        return Mode(*(_between(q, matrix)[:, 0, 0] / mass for matrix in matrices))


def modes_of(strands: Strands, points: Array, gravity: tuple[float, float, float]) -> Modes:
    """The smooth motions of strands about ``points`` [m], shape (n, 3), where they hang in equilibrium.

    Those of a lock that is held beyond its root are NaN.
    """
    curves = strands.curves
    step = max(1, AT_ONCE // int(curves.counts.max()))
    chunks = [_Rods(strands, points, np.arange(k, min(k + step, len(curves)))) for k in range(0, len(curves), step)]
    made = [vars(rods.modes(np.asarray(gravity, np.float64))).values() for rods in chunks]
    return Modes(*(np.concatenate(parts) for parts in zip(*made, strict=True)))


class _Rods:
    """Some strands as arrays of one length: vertices and edges beyond a tip have no extent and no mass.

    Row v of what belongs to edges is the edge that begins at vertex v, of what belongs to corners the corner there.
    Loads and motions have the shape (count, n, loads, 3).
    """

    def __init__(self, strands: Strands, points: Array, chosen: NDArray[np.int64]) -> None:
        begin, counts = strands.curves.offsets[chosen], strands.curves.counts[chosen]
        number = np.arange(counts.max())
        rows = begin[:, None] + np.minimum(number, counts[:, None] - 1)
        held = np.asarray(strands.held)[rows]
        first = held.argmin(axis=1)[:, None]  # the first vertex that is free
        self.pinned = (held & (number > first)).any(axis=1)
        self.points = points[rows]
        self.edges = np.diff(self.points, axis=1, append=self.points[:, -1:])
        self.tangents = _unit(self.edges)
        self.corners = _unit(np.roll(self.tangents, 1, axis=1) + self.tangents)
        free = (number >= first) & (number < counts[:, None])
        self.mass, self.drag = (np.where(free, of[rows], 0.0) for of in (strands.masses, strands.drag))
        self.damping = strands.damping[rows]
        stretch, bend, twist = (of[rows] for of in strands.stiffness)
        moves = (number >= first - 1) & (number < counts[:, None] - 1)  # edges, and the corners before them

        def compliance(stiffness: Array, moves: NDArray[np.bool_]) -> Array:
            """NaN where there is no stiffness."""
            return np.where(moves, 1.0 / np.where(moves & (stiffness > 0.0), stiffness, np.nan), 0.0)

        self.stretch, self.bend = compliance(stretch, moves), compliance(bend, moves)
        # A twist has the number of the edge before its corner; the first edge has no director.
        self.twist = compliance(np.roll(twist, 1, axis=1), moves & (number > 1))

    def modes(self, gravity: Array) -> Modes:
        """The smooth motions under gravity [m/s²]."""
        place = 2.0 * np.cumsum(self.mass, axis=1) / self.mass.sum(axis=1, keepdims=True) - 1.0
        profiles = self.mass[..., None] * legendre.legvander(place, ORDERS - 1)
        axes = np.linalg.svd(self.points[:, -1:] - self.points[:, :1])[2]
        loads = (profiles[:, :, None, :, None] * axes[:, None, :, None]).reshape(*self.mass.shape, -1, 3)
        about = _beyond(loads[:, :, :ORDERS])  # couples about the axis, on an arm of 1 m
        tension, moment = self._carried(loads)
        tension, moment = np.append(tension, 0.0 * about, axis=2), np.append(moment, about, axis=2)
        corners, edges = self._strains(tension, moment)
        turns = np.cumsum(corners, axis=1)
        turned = np.cross(turns, self.edges[:, :, None])
        moves = np.cumsum(turned + edges[..., None] * self.tangents[:, :, None], axis=1)
        moved = np.concatenate([np.zeros_like(moves[:, :1]), moves[:, :-1]], axis=1)

        def work(times: Array) -> Array:
            """The work of each load on the strains of each, these times a factor."""
            of_edges = _products(times[..., None, None] * self._pull(tension)[..., None], edges[..., None])
            return _products(times[..., None, None] * moment, corners) + of_edges

        flexibility = work(np.where(self.pinned, np.nan, 1.0)[:, None] * np.ones_like(self.mass))
        weight = self._geometric_stiffness(*self._carried(self.mass[..., None, None] * gravity), turns)
        drag, inertia = (_products(of[..., None, None] * moved, moved) for of in (self.drag, self.mass))
        return Modes(flexibility, weight, work(self.damping), drag, inertia)

    def _carried(self, forces: Array) -> tuple[Array, Array]:
        """Loads of edges [N] and moments of corners [N m] that carry forces on vertices."""
        points, tension = self.points[:, :, None], _beyond(forces)
        return tension, _beyond(np.cross(points, forces)) - np.cross(points, tension)

    def _pull(self, tension: Array) -> Array:
        return np.einsum("lvi,lvai->lva", self.tangents, tension)

    def _strains(self, tension: Array, moment: Array) -> tuple[Array, Array]:
        """Rotations of corners [rad] and lengthenings of edges [m] under loads."""
        twisting = np.einsum("lvi,lvai->lva", self.corners, moment)[..., None] * self.corners[:, :, None]
        bend, twist = self.bend[:, :, None, None], self.twist[:, :, None, None]
        return bend * (moment - twisting) + twist * twisting, self.stretch[..., None] * self._pull(tension)

    def _geometric_stiffness(self, tension: Array, moment: Array, turns: Array) -> Array:
        """The stiffness against rotations of edges that one load gives, with its moments, in equilibrium.

        An edge e with the load n that turns by ω takes (n · e |ω|² - (n · ω) (e · ω)) / 2; a corner with the moment m
        between edges that turn by ω and ω' takes -m · (ω × ω') / 2.
        """
        n, m = tension[:, :, 0], moment[:, :, 0]
        before = np.concatenate([np.zeros_like(turns[:, :1]), turns[:, :-1]], axis=1)
        pulled = np.einsum("lvi,lvi->lv", n, self.edges)[..., None, None] * turns
        along = np.einsum("lvai,lvi->lva", turns, n)[..., None] * self.edges[:, :, None]
        stiffness = _products(pulled - along - np.cross(m[:, :, None], before), turns)
        return 0.5 * (stiffness + stiffness.transpose(0, 2, 1))


def _products(left: Array, right: Array) -> Array:
    """The sum over vertices of the products of vectors, shape (count, left, right)."""
    rows, columns = (of.transpose(0, 2, 1, 3).reshape(len(of), of.shape[2], -1) for of in (left, right))
    return rows @ columns.transpose(0, 2, 1)


def _beyond(of_vertices: Array) -> Array:
    """The sum over all vertices beyond each one, towards the tip."""
    return np.cumsum(of_vertices[:, ::-1], axis=1)[:, ::-1] - of_vertices


def _unit(vectors: Array) -> Array:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0.0, length, 1.0)


def _between(vectors: Array, matrix: Array) -> Array:
    """Vᵀ A V of each lock."""
    return vectors.transpose(0, 2, 1) @ matrix @ vectors
