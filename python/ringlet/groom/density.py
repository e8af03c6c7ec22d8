"""Density of hairs: how many grow from the share of the scalp that belongs to each lock."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from ringlet.data.mesh import Mesh
from ringlet.data.random import Random

SAMPLES_PER_LOCK = 60
LARGEST_SHARE = 1.5  # of a lock, relative to the median: hair stays sparse where locks are
PER_CM2 = 1e4  # 1/cm² in 1/m²


def lock_areas(scalp: Mesh, region: NDArray[np.int32], roots: NDArray[np.float64]) -> NDArray[np.float64]:
    """Area of the scalp that is nearer to a lock's root than to others [m²], shape (locks,), estimated by samples.

    It is at most 1.5 times the median, so that a hairline with few locks stays sparse.

    region: triangles that carry hair
    roots:  shape (locks, 3) [m]
    """
    places, _ = region_samples(scalp, region, SAMPLES_PER_LOCK * len(roots))
    nearest = np.asarray(KDTree(roots).query(places)[1])
    shares = np.bincount(nearest, minlength=len(roots)) * (region_area(scalp, region) / len(places))
    return np.minimum(shares, LARGEST_SHARE * np.median(shares))


def region_area(scalp: Mesh, region: NDArray[np.int32]) -> float:
    """Area of triangles [m²]."""
    return 0.5 * float(np.linalg.norm(_normals(scalp, region), axis=1).sum())


def region_samples(
    scalp: Mesh, region: NDArray[np.int32], count: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """About ``count`` random samples of triangles, uniform by area: places [m] and unit normals, each (n, 3)."""
    a, b, c = np.asarray(scalp.points, np.float64)[scalp.triangles[region]].transpose(1, 0, 2)
    normals = _normals(scalp, region)
    doubled = np.linalg.norm(normals, axis=1)
    random = Random(0, "density")
    each = np.floor(doubled * (count / doubled.sum()) + random.uniform(region)).astype(np.int64)
    row = np.repeat(np.arange(len(region)), each)
    number = np.arange(len(row))
    root, v = np.sqrt(random.uniform(number, 1))[:, None], random.uniform(number, 2)[:, None]
    places = (1.0 - root) * a[row] + root * (1.0 - v) * b[row] + root * v * c[row]
    return places, normals[row] / np.maximum(doubled, 1e-300)[row, None]


def _normals(scalp: Mesh, region: NDArray[np.int32]) -> NDArray[np.float64]:
    """Normals of triangles times twice their area [m²], shape (n, 3)."""
    a, b, c = np.asarray(scalp.points, np.float64)[scalp.triangles[region]].transpose(1, 0, 2)
    return np.cross(b - a, c - a)
