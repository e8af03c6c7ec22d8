"""Strands as lengths, bends and twists in their material frame: numbers from a shape, and a shape from numbers.

An edge carries a director D across it, as in the model of a strand. What a strand at rest remembers is how long each
edge is, how each corner bends, as two numbers, and how each edge twists; from where its first edge lies they give the
whole shape back.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.curves import Curves

Array = NDArray[np.float64]


@dataclass
class RodStrains:
    """Lengths, bends and twists of packed strands, one row per vertex; rows without an edge or a corner are zero.

    length: of the edge that begins at the vertex [m], shape (n,)
    bend:   turning at the vertex [rad], along D of the edge behind it and across, shape (n, 2)
    twist:  angle [rad] about the edge that begins at the vertex, from its D to the next, in (−π, π], shape (n,)
    """

    length: Array
    bend: Array
    twist: Array

    def plus(self, change: RodStrains, part: Array | float = 1.0) -> RodStrains:
        """These and a part, one per vertex or one for all, of a change."""
        part = np.broadcast_to(part, self.twist.shape)
        return RodStrains(
            self.length + part * change.length,
            self.bend + part[:, None] * change.bend,
            self.twist + part * change.twist,
        )

    def minus(self, other: RodStrains) -> RodStrains:
        """What others must change by to become these."""
        return RodStrains(self.length - other.length, self.bend - other.bend, wrap(self.twist - other.twist))

    def take(self, vertices: NDArray[np.bool_]) -> RodStrains:
        """Those of some vertices."""
        return RodStrains(self.length[vertices], self.bend[vertices], self.twist[vertices])

    def put(self, vertices: NDArray[np.bool_], other: RodStrains) -> None:
        """Sets those of some vertices."""
        self.length[vertices], self.bend[vertices], self.twist[vertices] = other.length, other.bend, other.twist


def measure_strains(curves: Curves, points: Array, directors: Array) -> RodStrains:
    """Lengths, bends and twists of strands at ``points`` [m] with their directors, shapes (n, 3)."""
    lengths, tangents = edges(curves, points)
    corner, twisting = corners(curves), twists(curves)
    before, tangent, director = tangents[corner - 1], tangents[corner], directors[corner]
    turning = minimal_rotations(before, tangent)
    joints = RodStrains(lengths, np.zeros((len(points), 2)), np.zeros(len(points)))
    joints.bend[corner, 0] = _dot(turning, director)
    joints.bend[corner, 1] = _dot(turning, np.cross(tangent, director))
    tangent, director = tangents[twisting], directors[twisting]
    carried = rotate(directors[twisting + 1], -minimal_rotations(tangent, tangents[twisting + 1]))
    joints.twist[twisting] = np.arctan2(_dot(np.cross(tangent, director), carried), _dot(director, carried))
    return joints


def shape_of_strains(curves: Curves, joints: RodStrains, directors: Array) -> tuple[Array, Array]:
    """Points [m] and directors, shapes (n, 3), of strands that begin where ``curves`` do, along the same edges.

    directors: those of ``curves``, of which each strand takes over its first
    """
    numbers = (np.ascontiguousarray(of, np.float64) for of in (joints.length, joints.bend, joints.twist))
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
    """An angle within (−π, π]."""
    return np.pi - np.mod(np.pi - angle, 2.0 * np.pi)


def rotate(vectors: Array, turns: Array) -> Array:
    """Vectors turned about axes by angles, which are their directions and lengths [rad]; shapes (k, 3)."""
    angle = np.linalg.norm(turns, axis=1, keepdims=True)
    axis = turns / np.where(angle > 0.0, angle, 1.0)
    along = _dot(axis, vectors)[:, None] * axis
    return along + np.cos(angle) * (vectors - along) + np.sin(angle) * np.cross(axis, vectors)


def minimal_rotations(before: Array, after: Array) -> Array:
    """The turns that carry directions straight into others, shapes (k, 3)."""
    normal = np.cross(before, after)
    sine = np.linalg.norm(normal, axis=1)
    angle = np.arctan2(sine, _dot(before, after))
    return (angle / np.where(sine > 1e-12, sine, 1.0))[:, None] * normal


def _dot(a: Array, b: Array) -> Array:
    return np.einsum("ij,ij->i", a, b)
