"""Texture coordinates: each region of the skin is mapped to its own disc in the unit square, without overlaps.

The scalp is mapped by Lambert's azimuthal equal-area projection, so that a density painted in the texture is the
density on the head. The other regions are mapped harmonically, which is one-to-one for any disc-shaped patch (Tutte,
"How to draw a graph", 1963).
"""

from __future__ import annotations

import numpy as np
from distances import Array
from numpy.typing import NDArray
from regions import NAMES
from remesh import adjacency
from scipy.sparse.csgraph import laplacian
from scipy.sparse.linalg import spsolve

# Centre and radius of each region's disc.
DISCS = {
    "scalp": ((0.28, 0.72), 0.26),
    "face": ((0.77, 0.77), 0.21),
    "neck": ((0.23, 0.22), 0.2),
    "ear_left": ((0.58, 0.28), 0.13),
    "ear_right": ((0.86, 0.28), 0.13),
}
SCALP_AXIS = np.array([0.0, 0.77, -0.64]) / np.hypot(0.77, 0.64)


def unwrap(points: Array, triangles: NDArray, labels: NDArray, skull: Array) -> Array:
    """Texture coordinates of every triangle corner, shape (m, 3, 2).

    skull: middle of the skull, from which the scalp is projected, shape (3,)
    """
    uv = np.zeros((len(triangles), 3, 2))
    for k, name in enumerate(NAMES):
        chosen = np.flatnonzero(labels == k)
        used, local = np.unique(triangles[chosen], return_inverse=True)
        local = local.reshape(-1, 3)
        flat = azimuthal(points[used] - skull) if name == "scalp" else harmonic(points[used], local)
        (u, v), radius = DISCS[name]
        uv[chosen] = (np.array([u, v]) + radius * flat)[local]
    return uv


def azimuthal(direction: Array) -> Array:
    """Equal-area projection of directions from the middle of the skull around the scalp's axis to the unit disc.

    Lambert's radius is √2 sin(θ/2), here scaled so that the disc extends slightly beyond the lowest hair.
    """
    direction = direction / np.linalg.norm(direction, axis=1, keepdims=True)
    right = np.array([1.0, 0.0, 0.0])
    up = np.cross(SCALP_AXIS, right)
    planar = np.stack([direction @ right, direction @ up], axis=1)
    # `planar` has length sin θ = 2 sin(θ/2) cos(θ/2), and 1 + cos θ = 2 cos²(θ/2).
    return planar / np.sqrt(1.6 * (1.0 + direction @ SCALP_AXIS))[:, None]


def harmonic(points: Array, triangles: NDArray) -> Array:
    """Harmonic map of a patch with one border to the unit disc: each inner vertex is the mean of its neighbours."""
    loop = border(triangles)
    steps = np.linalg.norm(points[np.roll(loop, -1)] - points[loop], axis=1)
    turn = 2.0 * np.pi * (np.cumsum(steps) - steps) / steps.sum()
    flat = np.zeros((len(points), 2))
    flat[loop] = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    halves = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    link = adjacency(np.unique(np.sort(halves, axis=1), axis=0), len(points)).astype(float)
    inner = np.setdiff1d(np.arange(len(points)), loop)
    rows = laplacian(link).tocsr()[inner]
    flat[inner] = spsolve(rows[:, inner].tocsc(), -(rows[:, loop] @ flat[loop]))
    return flat


def border(triangles: NDArray) -> NDArray:
    """The closed border of a patch, counter-clockwise; raises ValueError for more than one."""
    halves = {(int(a), int(b)) for a, b in zip(triangles.ravel(), np.roll(triangles, -1, axis=1).ravel(), strict=True)}
    successor = {a: b for a, b in halves if (b, a) not in halves}
    loop = [min(successor)]
    while (after := successor[loop[-1]]) != loop[0]:
        loop.append(after)
    if len(loop) != len(successor):
        raise ValueError(f"a patch of {len(triangles)} triangles has more than one border; change the regions")
    return np.array(loop)
