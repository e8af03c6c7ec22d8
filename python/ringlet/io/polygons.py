"""Triangulation of polygons."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError


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
        raise UserError(f"{where}: its faces have {counts.sum()} corners, but there are {len(indices)} indices")
    if (bad := np.flatnonzero((indices < 0) | (indices >= points))).size:
        raise UserError(f"{where}: a face uses point {indices[bad[0]]}; must be from 0 to {points - 1}")


def fans(counts: NDArray, *, clockwise: bool = False) -> tuple[NDArray, NDArray]:
    """Triangulates polygons as fans: corners of each triangle, shape (m, 3), and its polygon, shape (m,)."""
    faces = np.repeat(np.arange(len(counts)), counts - 2)
    starts, cuts = np.cumsum(counts) - counts, np.cumsum(counts - 2) - (counts - 2)
    step = np.arange(len(faces)) - cuts[faces]
    local = np.stack([np.zeros_like(step), step + 1, step + 2], axis=1)
    if clockwise:  # reverses the winding, from the same first corner
        local[:, 1:] = counts[faces][:, None] - local[:, 1:]
    return starts[faces][:, None] + local, faces


def polygon_places(counts: NDArray) -> NDArray[np.float64]:
    """Parametric coordinates (u, v) of the corners of polygons, as in Houdini, shape (corners, 2).

    Triangles have (0,0) (1,0) (0,1); quads (0,0) (0,1) (1,1) (1,0), whose last is that of all further corners.
    """
    polygon = np.repeat(np.arange(len(counts)), counts)
    local = np.arange(len(polygon)) - (np.cumsum(counts) - counts)[polygon]
    triangle, quad = np.array([[0, 0], [1, 0], [0, 1]], float), np.array([[0, 0], [0, 1], [1, 1], [1, 0]], float)
    return np.where((counts[polygon] == 3)[:, None], triangle[np.minimum(local, 2)], quad[np.minimum(local, 3)])
