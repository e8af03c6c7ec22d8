"""Texture coordinates: each region of the skin has a disc of its own in the unit square, without overlaps.

The scalp, which carries the hair, is unrolled from its middle with areas kept (Lambert's azimuthal projection), so
that a density painted in the texture is the density on the head. The other regions are mapped harmonically onto their
disc, which is one-to-one for any disc-shaped patch (Tutte, "How to draw a graph", 1963).
"""

from __future__ import annotations

import numpy as np
from distances import Array
from numpy.typing import NDArray
from regions import NAMES, SKULL_CENTRE
from remesh import adjacency
from scipy.sparse.csgraph import laplacian
from scipy.sparse.linalg import spsolve

# Middle and radius of each region's disc.
DISCS = {
    "scalp": ((0.28, 0.72), 0.26),
    "face": ((0.77, 0.77), 0.21),
    "neck": ((0.23, 0.22), 0.2),
    "ear_left": ((0.58, 0.28), 0.13),
    "ear_right": ((0.86, 0.28), 0.13),
}
SCALP_AXIS = np.array([0.0, 0.77, -0.64]) / np.hypot(0.77, 0.64)


def unwrap(points: Array, triangles: NDArray, labels: NDArray) -> Array:
    """Texture coordinates of every triangle corner, shape (m, 3, 2)."""
    uv = np.zeros((len(triangles), 3, 2))
    for k, name in enumerate(NAMES):
        chosen = np.flatnonzero(labels == k)
        used, local = np.unique(triangles[chosen], return_inverse=True)
        local = local.reshape(-1, 3)
        flat = azimuthal(points[used]) if name == "scalp" else harmonic(points[used], local)
        (u, v), radius = DISCS[name]
        uv[chosen] = (np.array([u, v]) + radius * flat)[local]
    return uv


def azimuthal(points: Array) -> Array:
    """Directions from the middle of the skull, unrolled from the scalp's axis into the unit disc; areas are kept.

    Lambert's radius is √2 sin(θ/2); here it is scaled so that the disc reaches a little past the lowest hair.
    """
    out = points - SKULL_CENTRE
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    right = np.array([1.0, 0.0, 0.0])
    up = np.cross(SCALP_AXIS, right)
    across = np.stack([out @ right, out @ up], axis=1)
    # `across` has length sin θ = 2 sin(θ/2) cos(θ/2), and 1 + cos θ = 2 cos²(θ/2).
    return across / np.sqrt(1.6 * (1.0 + out @ SCALP_AXIS))[:, None]


def harmonic(points: Array, triangles: NDArray) -> Array:
    """A patch with one border laid into the unit disc, every inner vertex at the mean of its neighbours."""
    loop = border(triangles)
    steps = np.linalg.norm(points[np.roll(loop, -1)] - points[loop], axis=1)
    turn = 2.0 * np.pi * (np.cumsum(steps) - steps) / steps.sum()
    flat = np.zeros((len(points), 2))
    flat[loop] = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    halves = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    link = adjacency(np.unique(np.sort(halves, axis=1), axis=0), len(points)).astype(float)
    inner = np.setdiff1d(np.arange(len(points)), loop)
    pull = laplacian(link).tocsr()[inner]
    flat[inner] = spsolve(pull[:, inner].tocsc(), -(pull[:, loop] @ flat[loop]))
    return flat


def border(triangles: NDArray) -> NDArray:
    """The one closed border of a patch, counter-clockwise around it."""
    halves = {(int(a), int(b)) for a, b in zip(triangles.ravel(), np.roll(triangles, -1, axis=1).ravel(), strict=True)}
    follow = {a: b for a, b in halves if (b, a) not in halves}
    loop = [min(follow)]
    while (after := follow[loop[-1]]) != loop[0]:
        loop.append(after)
    if len(loop) != len(follow):
        raise ValueError(f"a patch of {len(triangles)} triangles has more than one border; change the regions")
    return np.array(loop)
