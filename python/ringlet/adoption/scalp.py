"""A surface through the roots of hair that comes without a head."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, Delaunay, KDTree

from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh

MARGIN = 2.0  # of the surface around the roots, in spacings of roots
GRID = 5e-4  # [m] roots that are nearer to one another become one point
NARROW = 1e-3  # width of projected roots, relative to their distance, below which they count as on a line


def scalp_of_roots(roots: NDArray[np.float64], name: str) -> Mesh:
    """A triangulation of roots: their Delaunay triangulation after a stereographic projection from below.

    Hair grows upwards from what lies around one centre, as on a head. The surface faces away from that.

    roots: [m], shape (k, 3)
    name:  of the mesh

    Raises UserError for roots that span no surface.
    """
    points = roots[np.unique(np.round(roots / GRID), axis=0, return_index=True)[1]]
    if len(points) < 3:
        raise UserError(f"{name}: has {len(points)} different roots, which span no surface; give it a head with --head")
    spacing = float(np.median(KDTree(points).query(points, k=2)[0][:, 1]))
    middle = points.mean(axis=0)
    axes = np.linalg.svd(points - middle, full_matrices=False)[2]
    if (width := float(np.ptp((points - middle) @ axes[1]))) < GRID:
        raise UserError(
            f"{name}: its roots lie on a line, {1e3 * width:.2g} mm wide, which spans no surface; give it a head with "
            "--head"
        )
    across = axes[2] if axes[2, 1] >= 0.0 else -axes[2]
    below = middle - float(np.linalg.norm(np.ptp(points, axis=0))) * across
    center, pole, flat = _seen_from(_center(points, middle, below), points)
    if np.linalg.svd(flat - flat.mean(axis=0), compute_uv=False)[1] < NARROW:  # roots on a circle about the centre
        center, pole, flat = _seen_from(below, points)
    hull = ConvexHull(flat).vertices
    scale = MARGIN * spacing / float(np.median(np.linalg.norm(points - center, axis=1)))
    rim = flat[hull] + scale * _unit(flat[hull] - flat[hull].mean(axis=0))
    distance = np.linalg.norm(points[hull] - center, axis=1)
    rim_points = center + distance[:, None] * _unprojected(rim, pole)
    every = np.concatenate([points, rim_points])
    triangles = Delaunay(np.concatenate([flat, rim])).simplices  # counter-clockwise, seen from the pole
    normals = np.cross(every[triangles[:, 1]] - every[triangles[:, 0]], every[triangles[:, 2]] - every[triangles[:, 0]])
    kept = np.linalg.norm(normals, axis=1) > 1e-14 * np.ptp(every, axis=0).max() ** 2
    used, index = np.unique(triangles[kept], return_inverse=True)
    return Mesh(name, every[used], index.reshape(-1, 3).astype(np.int32))


def _seen_from(center: NDArray, points: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """A centre [m], the mean direction of points from there, shape (3,) each, and their projections, shape (k, 2)."""
    outward = _unit(points - center)
    pole = _unit(outward.mean(axis=0, keepdims=True))
    return center, pole[0], _projected(outward, pole[0])


def _center(points: NDArray, middle: NDArray, below: NDArray) -> NDArray[np.float64]:
    """Centre of the sphere that fits points best, or ``below`` them where they are nearly flat."""
    rows = np.concatenate([2.0 * (points - middle), np.ones((len(points), 1))], axis=1)
    fitted = np.linalg.lstsq(rows, ((points - middle) ** 2).sum(axis=1), rcond=1e-6)[0][:3]
    size = float(np.linalg.norm(middle - below))
    return middle + fitted if 0.2 * size < np.linalg.norm(fitted) < 5.0 * size and fitted[1] <= 0.3 * size else below


def _projected(outward: NDArray, pole: NDArray) -> NDArray[np.float64]:
    """Stereographic projection of directions from the point opposite the pole, shape (k, 2)."""
    along = outward @ pole
    return (outward @ _plane(pole).T) / np.maximum(1.0 + along, 1e-3)[:, None]


def _unprojected(flat: NDArray, pole: NDArray) -> NDArray[np.float64]:
    """Directions of projected points, shape (k, 3)."""
    squared = (flat**2).sum(axis=1)[:, None]
    return (2.0 * flat @ _plane(pole) + (1.0 - squared) * pole) / (1.0 + squared)


def _plane(pole: NDArray) -> NDArray[np.float64]:
    """Two unit directions across the pole, shape (2, 3), that turn right-handed about it."""
    first = _unit(np.cross(pole, np.eye(3)[np.abs(pole).argmin()])[None])[0]
    return np.stack([first, np.cross(pole, first)])


def _unit(vectors: NDArray) -> NDArray[np.float64]:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-12)
