"""Penetration: the depth of points inside closed meshes, of curves beyond sheets and of strands in one another."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from ringlet import _core
from ringlet.data.winding import winding_numbers

Array = NDArray[np.float64]
Indices = NDArray[np.integer]

PARALLEL = 1e-9  # the sine below which a segment counts as lying in the plane of a triangle


def penetration_depths(
    points: NDArray[np.floating], triangles: NDArray[np.int32], corners: NDArray[np.floating], least: float = 0.0
) -> Array:
    """The depth of points inside a closed mesh with those corners [m], 0 outside or up to ``least``; shape (n,).

    Points behind their nearest triangle are candidates; those with a winding number above ½ are inside.
    """
    depth = np.zeros(len(points))
    near = np.flatnonzero(((points > corners.min(axis=0)) & (points < corners.max(axis=0))).all(axis=1))
    places, surface = np.asarray(points[near], np.float64), np.asarray(corners, np.float64)
    triangle, barycentric, distance = _core.bind_roots(surface, triangles, places)
    foot, axes = _core.root_frames(surface, triangles, triangle, barycentric)
    behind = np.flatnonzero((np.einsum("ni,ni->n", places - foot, axes[:, :, 2]) < 0.0) & (distance > least))
    inside = behind[winding_numbers(places[behind], surface[triangles]) > 0.5]
    depth[near[inside]] = distance[inside]
    return depth


def depths_beyond(
    points: Array, offsets: Indices, triangles: NDArray[np.int32], corners: NDArray[np.floating], least: float = 0.0
) -> Array:
    """The distance from a sheet with those corners [m] of the points of curves that are on its other side than their
    root is; 0 of all others, and up to ``least``; shape (n,). A curve changes sides where an edge of it intersects."""
    depth, surface = np.zeros(len(points)), np.asarray(corners, np.float64)
    last = np.delete(np.arange(len(points)), offsets[:-1])  # points at which edges end
    ends = np.stack([points[last - 1], points[last]], axis=1)
    crossed = np.zeros(len(points), np.int64)
    crossed[last[edge_triangle_intersections(ends, surface[triangles])[:, 0]]] = 1
    sides = np.cumsum(crossed)
    beyond = np.flatnonzero((sides - np.repeat(sides[offsets[:-1]], np.diff(offsets))) % 2)
    distance = _core.bind_roots(surface, triangles, points[beyond])[2] if len(beyond) else np.zeros(0)
    depth[beyond] = np.where(distance > least, distance, 0.0)
    return depth


def edge_triangle_intersections(ends: Array, corners: Array) -> NDArray[np.int64]:
    """Pairs of a segment and a triangle that intersect, shape (k, 2), by Möller and Trumbore 1997.

    ends:    of the segments [m], shape (n, 2, 3)
    corners: of the triangles [m], shape (m, 3, 3)
    """
    pairs = _near(ends, corners)
    start, direction = ends[pairs[:, 0], 0], ends[pairs[:, 0], 1] - ends[pairs[:, 0], 0]
    a, b, c = (corners[pairs[:, 1], k] for k in range(3))
    # start + t direction = a + u (b − a) + v (c − a)
    across, turned = np.cross(direction, c - a), np.cross(start - a, b - a)
    determinant = _dot(b - a, across)
    sizes = np.linalg.norm(direction, axis=1) * np.linalg.norm(b - a, axis=1) * np.linalg.norm(c - a, axis=1)
    slanted = np.abs(determinant) > PARALLEL * sizes
    determinant[~slanted] = 1.0
    u, v = _dot(start - a, across) / determinant, _dot(direction, turned) / determinant
    t = _dot(c - a, turned) / determinant
    return pairs[slanted & (u >= 0) & (v >= 0) & (u + v <= 1) & (t >= 0) & (t <= 1)]


def mesh_edges(triangles: Indices) -> NDArray[np.int64]:
    """Every edge of a mesh once, shape (k, 2)."""
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    return np.unique(np.sort(sides.astype(np.int64), axis=1), axis=0)


def _near(ends: Array, corners: Array) -> NDArray[np.int64]:
    """Pairs of a segment and a triangle whose bounding spheres overlap, shape (k, 2)."""
    segments, triangles = _within(ends, corners), _within(corners, ends)
    none = np.zeros((0, 2), np.int64)
    if not len(segments) or not len(triangles):
        return none
    middles, centres = ends[segments].mean(axis=1), corners[triangles].mean(axis=1)
    reach = np.linalg.norm(ends[segments, 0] - middles, axis=1)
    radius = np.linalg.norm(corners[triangles] - centres[:, None], axis=2).max(axis=1)
    found = KDTree(middles).query_ball_point(centres, radius + reach.max())
    counts = np.array([len(each) for each in found])
    if not counts.any():
        return none
    near = np.concatenate([np.asarray(each, np.int64) for each in found])
    return np.stack([segments[near], triangles[np.repeat(np.arange(len(counts)), counts)]], axis=1)


def _within(these: Array, others: Array) -> NDArray[np.int64]:
    """The shapes (n, k, 3) whose bounding box meets that of all others."""
    if not len(these) or not len(others):
        return np.zeros(0, np.int64)
    low, high = others.min(axis=(0, 1)), others.max(axis=(0, 1))
    return np.flatnonzero(((these.min(axis=1) <= high) & (these.max(axis=1) >= low)).all(axis=1))


def _dot(a: Array, b: Array) -> Array:
    return np.einsum("ni,ni->n", a, b)
