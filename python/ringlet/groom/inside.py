"""Which points are inside a mesh, and how deep: by the normal that belongs to the nearest place."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet import _core

Array = NDArray[np.float64]

ON_EDGE = 1e-7  # a barycentric coordinate below this is 0: the nearest place is on an edge or a corner


class Surface:
    """A triangle mesh as a solid. Whether a point is inside is told by the angle-weighted pseudonormal of the face,
    edge or corner that it is nearest to (Bærentzen and Aanæs 2005), which never errs on a closed mesh. Beyond the rim
    of an open one, nothing is inside."""

    def __init__(self, points: NDArray, triangles: NDArray) -> None:
        self.points = np.ascontiguousarray(points, np.float64)
        self.triangles = np.ascontiguousarray(triangles, np.int32)
        self._corners = self.points[self.triangles]
        a, b, c = (self._corners[:, k] for k in range(3))
        self._faces = _unit(np.cross(b - a, c - a))
        self._vertices = np.zeros_like(self.points)
        for k in range(3):
            here, left, right = (self._corners[:, (k + i) % 3] for i in range(3))
            cosine = np.sum(_unit(left - here) * _unit(right - here), axis=1)
            np.add.at(self._vertices, self.triangles[:, k], np.arccos(np.clip(cosine, -1, 1))[:, None] * self._faces)
        edges = np.sort(self.triangles[:, [[1, 2], [2, 0], [0, 1]]], axis=2).reshape(-1, 2)  # opposite each corner
        _, first, uses = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
        first = first.reshape(-1)
        sums = np.zeros((len(uses), 3))
        np.add.at(sums, first, np.repeat(self._faces, 3, axis=0))
        self._edges = sums[first].reshape(-1, 3, 3)
        self._open_edges = (uses == 1)[first].reshape(-1, 3)
        self._open_corners = np.zeros(len(self.points), bool)
        self._open_corners[edges[(uses == 1)[first]]] = True

    def nearest(self, places: NDArray) -> tuple[Array, Array, Array, NDArray[np.int32]]:
        """Height above the surface (negative inside), nearest place, outward direction there, and its triangle.

        places: positions [m], shape (n, 3)
        """
        places = np.ascontiguousarray(places, np.float64)
        triangle, barycentric, distance = _core.bind_roots(self.points, self.triangles, places)
        foot = np.einsum("nc,ncx->nx", barycentric, self._corners[triangle])
        zero = barycentric < ON_EDGE
        count = zero.sum(axis=1)
        normal = self._faces[triangle].copy()
        on_edge, on_corner = np.flatnonzero(count == 1), np.flatnonzero(count == 2)
        normal[on_edge] = self._edges[triangle[on_edge], zero[on_edge].argmax(axis=1)]
        corner = self.triangles[triangle[on_corner], barycentric[on_corner].argmax(axis=1)]
        normal[on_corner] = self._vertices[corner]
        normal = _unit(normal)
        behind = np.einsum("nx,nx->n", places - foot, normal) < 0.0
        behind[on_edge] &= ~self._open_edges[triangle[on_edge], zero[on_edge].argmax(axis=1)]
        behind[on_corner] &= ~self._open_corners[corner]
        return np.where(behind, -distance, distance), foot, normal, triangle

    def outermost(self, origin: Array, places: Array) -> tuple[Array, NDArray[np.bool_]]:
        """Where rays from ``origin`` through places leave the mesh for good, shape (n, 3), and whether they meet it."""
        ways = _unit(places - origin)
        a, b, c = (self._corners[:, k] - origin for k in range(3))
        reach = np.zeros(len(places))
        for k, way in enumerate(ways):  # Möller and Trumbore 1997, with the origin at 0
            across = np.cross(way, c - a)
            determinant = np.sum((b - a) * across, axis=1)
            with np.errstate(all="ignore"):
                turned = np.cross(-a, b - a)
                u, v = np.sum(-a * across, axis=1) / determinant, turned @ way / determinant
                t = np.sum((c - a) * turned, axis=1) / determinant
                reach[k] = np.max(t, where=(u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0), initial=0.0)
        return origin + reach[:, None] * ways, reach > 0.0


def _unit(vectors: Array) -> Array:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-300)
