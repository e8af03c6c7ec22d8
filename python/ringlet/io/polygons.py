"""Triangulation of polygons."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError

FLAT = 1e-9  # twice the area of a triangle, relative to its longest edge squared, at which it counts as flat


def check_polygons(counts: NDArray, indices: NDArray, points: int, where: str) -> None:
    """Raises UserError for an empty list of polygons, fewer than 3 corners, or indices out of range.

    counts:  corners per polygon, shape (f,)
    indices: point of each corner, polygon by polygon
    points:  number of points
    where:   name of the mesh, for messages
    """
    if len(counts) == 0:
        raise UserError(f"{where}: has no faces; export it again or choose another mesh")
    if counts.min() < 3:
        raise UserError(f"{where}: face {counts.argmin()} has {counts.min()} corners; must have at least 3")
    if counts.sum() != len(indices):
        raise UserError(
            f"{where}: its faces have {counts.sum()} corners, but there are {len(indices)} indices; export it again"
        )
    if (bad := np.flatnonzero((indices < 0) | (indices >= points))).size:
        raise UserError(f"{where}: a face uses point {indices[bad[0]]}; must be from 0 to {points - 1}")


def triangulate(
    points: NDArray, counts: NDArray, indices: NDArray, *, clockwise: bool = False
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Triangulates polygons: corners of each triangle, shape (m, 3), and its polygon, shape (m,), ascending.

    A polygon becomes the fan of its first corner where every triangle of it faces as the polygon does. Others, such as
    concave ones, are cut by ear clipping (Meisters 1975) in the plane of their area vector.

    points:    positions, shape (n, 3)
    counts:    corners per polygon, shape (f,)
    indices:   point of each corner, polygon by polygon
    clockwise: corners are in clockwise order, seen from outside; those of the triangles are counter-clockwise
    """
    starts, faces = np.cumsum(counts) - counts, np.repeat(np.arange(len(counts)), counts - 2)
    corners = np.arange(len(indices))
    if clockwise:  # reverses the winding, from the same first corner
        first, count = np.repeat(starts, counts), np.repeat(counts, counts)
        corners = first + (count - (corners - first)) % count
    cuts = np.cumsum(counts - 2) - (counts - 2)
    step = np.arange(len(faces)) - cuts[faces]
    triangles = starts[faces][:, None] + np.stack([np.zeros_like(step), step + 1, step + 2], axis=1)
    more = counts[faces] > 3
    if not more.any():
        return corners[triangles], faces
    places = np.asarray(points, np.float64)[indices[corners]]
    folded, normals = _folded(places, triangles[more], faces[more], len(counts))
    quads = folded[counts[folded] == 4]
    for half, local in enumerate(([0, 1, 3], [1, 2, 3])):  # the other diagonal
        triangles[cuts[quads] + half] = starts[quads][:, None] + local
    others = counts[folded] > 4
    for face, normal in zip(folded[others], normals[others], strict=True):
        start, count = starts[face], counts[face]
        flat = (places[start : start + count] - places[start]) @ _plane(normal)
        triangles[cuts[face] : cuts[face] + count - 2] = start + _ears(flat)
    return corners[triangles], faces


def _folded(places: NDArray, triangles: NDArray, faces: NDArray, count: int) -> tuple[NDArray[np.int64], NDArray]:
    """Polygons with a triangle that is flat or faces against the polygon, shape (k,), and their unit normals, (k, 3).

    A polygon without area, or with an area beyond double precision, has no such side.
    """
    a, b, c = (places[triangles[:, k]] for k in range(3))
    with np.errstate(over="ignore", invalid="ignore"):
        area = np.cross(b - a, c - a)
        longest = np.max([np.sum(edge**2, axis=1) for edge in (b - a, c - b, a - c)], axis=0)
        whole = np.stack([np.bincount(faces, area[:, k], count) for k in range(3)], axis=1)
        size = np.zeros(count)
        np.maximum.at(size, faces, longest)
        length = np.linalg.norm(whole, axis=1)
        normals = whole / np.maximum(length, np.finfo(float).tiny)[:, None]
        folded = np.unique(faces[np.sum(area * normals[faces], axis=1) <= FLAT * longest])
    folded = folded[(length[folded] > FLAT * size[folded]) & np.isfinite(length[folded])]
    return folded, normals[folded]


def _plane(normal: NDArray) -> NDArray[np.float64]:
    """Two orthonormal directions across a unit normal, as columns, shape (3, 2); they turn right-handed about it."""
    first = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(normal, first)], axis=1)


def _ears(places: NDArray) -> NDArray[np.int64]:
    """Triangles of a counter-clockwise polygon in the plane, shape (n - 2, 3), each from its first corner on.

    The best-shaped ear is cut first, and none is flat in a simple polygon.
    """
    left, ears = list(range(len(places))), []
    while len(left) > 3:
        k = _best_ear(places[left])
        ears.append((left[k - 1], left[k], left[(k + 1) % len(left)]))
        del left[k]
    ears.append(tuple(left))
    return np.array(sorted(ear[(first := ear.index(min(ear))) :] + ear[:first] for ear in ears))


def _best_ear(ring: NDArray) -> int:
    """The corner whose triangle with its two neighbours is of the best shape and holds no other corner.

    A polygon that crosses itself may have none; then its best-shaped corner.
    """
    before, after = np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0)
    longest = np.max([np.sum(edge**2, axis=1) for edge in (ring - before, after - ring, before - after)], axis=0)
    shape = _cross(ring - before, after - ring) / np.maximum(longest, np.finfo(float).tiny)
    order = np.argsort(-shape, kind="stable")
    for k in order[shape[order] > FLAT]:
        corners = np.stack([before[k], ring[k], after[k]])
        # A polygon with a bridge to a hole passes its corners there twice.
        others = ring[~(ring[:, None] == corners).all(axis=2).any(axis=1)]
        sides = [_cross(corners[i] - corners[i - 1], others - corners[i - 1]) for i in range(3)]
        if not np.all(np.array(sides) >= -FLAT * longest[k], axis=0).any():
            return int(k)
    return int(order[0])


def _cross(a: NDArray, b: NDArray) -> NDArray[np.float64]:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def polygon_places(counts: NDArray) -> NDArray[np.float64]:
    """Parametric coordinates (u, v) of the corners of polygons, as in Houdini, shape (corners, 2).

    Triangles have (0,0) (1,0) (0,1); quads (0,0) (0,1) (1,1) (1,0), whose last is that of all further corners.
    """
    polygon = np.repeat(np.arange(len(counts)), counts)
    local = np.arange(len(polygon)) - (np.cumsum(counts) - counts)[polygon]
    triangle, quad = [[0, 0], [1, 0], [0, 1]], [[0, 0], [0, 1], [1, 1], [1, 0]]
    return np.array(triangle + quad, float)[np.where(counts[polygon] == 3, local, 3 + np.minimum(local, 3))]
