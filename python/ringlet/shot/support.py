"""What a groom rests on: the forces with which bodies and nails bear locks where they lie.

A lock that lies on a body need not hold up all of its weight, and one that is nailed hangs from its nails too. Statics
alone does not say how much each of these bears. Here it is what strains the lock least, by the sum over its joints of
moment² / stiffness, while bodies can only push. To first order this is what they would bear if the lock remembered the
groom and were let go: of all ways to carry a load what is elastic takes that of least energy. Forces count a little
themselves, or a body would press on a lock near its root with many times its weight, as on a lever.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from ringlet import _core
from ringlet.curves import Curves
from ringlet.shot.collider import Obstacle
from ringlet.shot.joints import corners, edges, twists
from ringlet.shot.shot import Shot
from ringlet.shot.start import depths
from ringlet.shot.strands import Strands

Array = NDArray[np.float64]

SHY = 0.1  # of the strain energy under the loads: what it counts to be borne by one's whole weight in one place
ALL_WAYS = np.concatenate([np.eye(3), -np.eye(3)])


@dataclass
class Rests:
    """Places where locks are borne: vertices, shape (k,), and unit forces that may act there, shape (k, 3)."""

    vertex: NDArray[np.int64]
    way: Array


def support(shot: Shot, locks: Curves, strands: Strands, loads: Array, obstacles: Sequence[Obstacle]) -> Array:
    """The forces [N] that bear locks where they were groomed, at their vertices, shape (n, 3).

    strands: the locks, with their stiffness
    loads:   what pulls at them besides [N], shape (n, 3)
    """
    forces, points = np.zeros_like(loads), np.asarray(locks.points, np.float64)
    rests = _joined(_nailed(shot, locks, strands), *_lying(shot, points, strands, obstacles))
    give = _Give(shot.held, locks, points, strands)
    lock = np.searchsorted(locks.offsets, rests.vertex, side="right") - 1
    order = np.argsort(lock, kind="stable")
    for chosen in np.split(order, np.flatnonzero(np.diff(lock[order])) + 1):
        if chosen.size:
            vertex, way = rests.vertex[chosen], rests.way[chosen]
            np.add.at(forces, vertex, give.least(int(lock[chosen[0]]), vertex, way, loads)[:, None] * way)
    return forces


def _joined(*rests: Rests) -> Rests:
    return Rests(np.concatenate([one.vertex for one in rests]), np.concatenate([one.way for one in rests]))


def _nailed(shot: Shot, locks: Curves, strands: Strands) -> Rests:
    """Nails hold in every direction."""
    number = np.arange(len(locks.points)) - np.repeat(locks.offsets[:-1], locks.counts)
    vertex = np.flatnonzero(np.asarray(strands.held) & (number >= shot.held))
    return Rests(np.repeat(vertex, len(ALL_WAYS)), np.tile(ALL_WAYS, (len(vertex), 1)))


def _lying(shot: Shot, points: Array, strands: Strands, obstacles: Sequence[Obstacle]) -> Iterator[Rests]:
    """Bodies push away from them what is as near as they touch it; not what begins inside."""
    contact, free = shot.touching, ~np.asarray(strands.held)
    if contact is None:
        return
    for obstacle in obstacles:
        surface, triangles = np.asarray(obstacle.mesh.points, np.float64), obstacle.mesh.triangles
        reach = contact.radius + obstacle.settings.thickness
        low, high = surface.min(axis=0) - reach, surface.max(axis=0) + reach
        near = np.flatnonzero(free & ((points > low) & (points < high)).all(axis=1))
        triangle, barycentric, distance = _core.bind_roots(surface, triangles, points[near])
        touching = (distance < reach) & (distance > 0.0)
        touching[touching] = depths(points[near[touching]], triangles, surface) == 0.0
        foot = np.einsum("ki,kij->kj", barycentric[touching], surface[triangles[triangle[touching]]])
        away = points[near[touching]] - foot
        yield Rests(near[touching], away / np.linalg.norm(away, axis=1, keepdims=True))


class _Give:
    """How locks give way to forces at their vertices, as beams that are clamped at their roots."""

    def __init__(self, held: int, locks: Curves, points: Array, strands: Strands) -> None:
        self._locks, self._points, self._tangents = locks, points, edges(locks, points)[1]
        number = np.arange(len(points)) - np.repeat(locks.offsets[:-1], locks.counts)
        stretch, bend, twist = strands.stiffness
        everywhere = np.arange(len(points))
        self._stretch, self._bend, self._twist = (
            np.where(np.isin(everywhere, of) & (number >= first) & (stiffness > 0.0), stiffness, np.inf) ** -0.5
            for of, first, stiffness in (
                (everywhere, held - 1, stretch),
                (corners(locks), held - 1, bend),
                (twists(locks), held - 2, twist),
            )
        )

    def least(self, lock: int, vertex: NDArray[np.int64], way: Array, loads: Array) -> Array:
        """The forces [N] along ``way`` at vertices of a lock, none negative, with which it is strained least.

        Minimises, with forces f in units of the lock's weight: Σ strain² stiffness + SHY · E · Σ f², where E is the
        first sum without them.
        """
        rows = slice(self._locks.offsets[lock], self._locks.offsets[lock + 1])
        weight = np.linalg.norm(loads[rows], axis=1).sum()
        if weight == 0.0:
            return np.zeros(len(vertex))
        by_loads = self._strains(rows, np.arange(rows.start, rows.stop), loads[rows]).sum(axis=1)
        shy = np.sqrt(SHY) * np.linalg.norm(by_loads) * np.eye(len(vertex))
        of_each = np.concatenate([self._strains(rows, vertex, weight * way), shy])
        found, _ = nnls(of_each, np.concatenate([-by_loads, np.zeros(len(vertex))]))
        return weight * found

    def _strains(self, rows: slice, vertex: NDArray[np.int64], force: Array) -> Array:
        """Strains of a lock under each of some forces at its vertices, times √stiffness; shape (strains, k)."""
        points, tangent = self._points[rows], self._tangents[rows]
        beyond = (np.arange(rows.start, rows.stop)[:, None] < vertex)[:, :, None]
        moment = np.where(beyond, np.cross(self._points[vertex] - points[:, None], force), 0.0)
        about, along = (np.einsum("nki,ni->nk", of, tangent) for of in (moment, np.where(beyond, force, 0.0)))
        bend = self._bend[rows, None, None] * (moment - about[:, :, None] * tangent[:, None])
        return np.concatenate(
            [
                np.moveaxis(bend, 2, 0).reshape(-1, len(vertex)),
                self._twist[rows, None] * about,
                self._stretch[rows, None] * along,
            ]
        )
