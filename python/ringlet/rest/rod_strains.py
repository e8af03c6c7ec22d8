"""Strains of discrete rods: edge lengths, bends and twists in the material frame, from a shape and back to it.

The rod is that of Bergou et al., *Discrete Elastic Rods*, 2008, with one director D per edge. Its rest shape is given
by these numbers and by the position of the first edge.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.rigid import rotate

Array = NDArray[np.float64]


@dataclass
class RodStrains:
    """Lengths, bends and twists of packed strands, one row per vertex; rows without an edge or a corner are zero.

    length: of the edge that begins at the vertex [m], shape (n,)
    bend:   turning angle at the vertex [rad], along D of the edge behind it and across, shape (n, 2)
    twist:  angle [rad] about the edge that begins at the vertex, from its D to the next, in (−π, π], shape (n,)

    Forces in these directions have the same layout: tension [N], bending and twisting moments [N m].
    """

    length: Array
    bend: Array
    twist: Array

    def plus(self, change: RodStrains, factor: Array | float = 1.0) -> RodStrains:
        """The sum with ``factor``, one per vertex or one for all, times a change."""
        factor = np.broadcast_to(factor, self.twist.shape)
        return RodStrains(
            self.length + factor * change.length,
            self.bend + factor[:, None] * change.bend,
            self.twist + factor * change.twist,
        )

    def minus(self, other: RodStrains) -> RodStrains:
        """The difference; angles of twist within (−π, π]."""
        return RodStrains(self.length - other.length, self.bend - other.bend, wrap(self.twist - other.twist))

    def take(self, vertices: NDArray[np.bool_]) -> RodStrains:
        """The rows of some vertices."""
        return RodStrains(self.length[vertices], self.bend[vertices], self.twist[vertices])

    def put(self, vertices: NDArray[np.bool_], other: RodStrains) -> None:
        """Sets the rows of some vertices."""
        self.length[vertices], self.bend[vertices], self.twist[vertices] = other.length, other.bend, other.twist


def measure_strains(curves: Curves, points: Array, directors: Array) -> RodStrains:
    """Strains of strands at ``points`` [m] with their directors, shapes (n, 3)."""
    lengths, tangents = edges(curves, points)
    corner, twisting = corners(curves), twists(curves)
    before, tangent, director = tangents[corner - 1], tangents[corner], directors[corner]
    turning = minimal_rotations(before, tangent)
    strains = RodStrains(lengths, np.zeros((len(points), 2)), np.zeros(len(points)))
    strains.bend[corner, 0] = _dot(turning, director)
    strains.bend[corner, 1] = _dot(turning, np.cross(tangent, director))
    tangent, director = tangents[twisting], directors[twisting]
    carried = rotate(directors[twisting + 1], -minimal_rotations(tangent, tangents[twisting + 1]))
    strains.twist[twisting] = np.arctan2(_dot(np.cross(tangent, director), carried), _dot(director, carried))
    return strains


def shape_of_strains(curves: Curves, strains: RodStrains, directors: Array) -> tuple[Array, Array]:
    """Points [m] and directors, shapes (n, 3), of strands with these strains that begin with the edges of ``curves``.

    directors: those of ``curves``, of which the first of each strand is kept
    """
    numbers = (np.ascontiguousarray(of, np.float64) for of in (strains.length, strains.bend, strains.twist))
    begin = (np.ascontiguousarray(of, np.float64) for of in (curves.points, directors))
    points, made = _core.shape_of_joints(curves.offsets, *numbers, *begin)
    return points, made


def edges(curves: Curves, points: Array) -> tuple[Array, Array]:
    """Lengths [m], shape (n,), and directions, shape (n, 3), of the edges that begin at the vertices; zero at tips."""
    edge = np.zeros_like(points, np.float64)
    edge[:-1] = np.diff(points, axis=0)
    edge[curves.offsets[1:] - 1] = 0.0
    length = np.linalg.norm(edge, axis=1)
    return length, edge / np.where(length > 0.0, length, 1.0)[:, None]


def corners(curves: Curves) -> NDArray[np.int64]:
    """Vertices between two edges."""
    return _but_ends(curves, 1)


def twists(curves: Curves) -> NDArray[np.int64]:
    """Vertices at which an edge between two corners begins."""
    return _but_ends(curves, 2)


def _but_ends(curves: Curves, last: int) -> NDArray[np.int64]:
    inner = np.ones(len(curves.points), bool)
    inner[curves.offsets[:-1]] = False
    for back in range(1, last + 1):
        inner[np.maximum(curves.offsets[1:] - back, curves.offsets[:-1])] = False
    return np.flatnonzero(inner)


def wrap(angle: Array) -> Array:
    """The same angle within (−π, π]."""
    return np.pi - np.mod(np.pi - angle, 2.0 * np.pi)


def minimal_rotations(before: Array, after: Array) -> Array:
    """Rotation vectors [rad] of the smallest rotations from directions to others, shapes (k, 3)."""
    normal = np.cross(before, after)
    sine = np.linalg.norm(normal, axis=1)
    angle = np.arctan2(sine, _dot(before, after))
    return (angle / np.where(sine > 1e-12, sine, 1.0))[:, None] * normal


def _dot(a: Array, b: Array) -> Array:
    return np.einsum("ij,ij->i", a, b)
