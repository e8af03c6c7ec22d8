"""Beads that mark places in a picture: small coloured balls, merged into one mesh."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.mesh import Mesh
from ringlet.picture.bodies import PosedBody

# A regular icosahedron of circumradius 1, with corners on three golden rectangles.
_LONG = np.cos(0.5 * np.arctan(2.0))
_SHORT = np.sin(0.5 * np.arctan(2.0))
_CORNERS = np.array([np.roll([0.0, a * _SHORT, b * _LONG], k) for k in range(3) for a in (1, -1) for b in (1, -1)])


def _faces() -> NDArray[np.int32]:
    """Triangles of the icosahedron, counter-clockwise from outside: all triples of adjacent corners, shape (20, 3)."""
    distance = np.linalg.norm(_CORNERS[:, None] - _CORNERS[None], axis=2)
    adjacent = (distance > 0) & (distance < 1.01 * distance[distance > 0].min())
    faces = [
        (i, j, k)
        for i in range(12)
        for j in range(12)
        for k in range(12)
        if adjacent[i, j] and adjacent[j, k] and adjacent[k, i]
    ]
    outward = [f for f in faces if f[0] == min(f) and np.linalg.det(_CORNERS[list(f)]) > 0]
    return np.array(outward, np.int32)


def beads(places: NDArray[np.floating], colors: NDArray[np.floating], radius: float) -> PosedBody:
    """Makes balls at places [m], shape (k, 3), of one radius [m], in linear colours, shape (k, 3)."""
    points = (np.asarray(places, np.float64)[:, None] + radius * _CORNERS).reshape(-1, 3)
    faces = _faces()
    triangles = (len(_CORNERS) * np.arange(len(places))[:, None, None] + faces).reshape(-1, 3).astype(np.int32)
    each = np.repeat(np.asarray(colors, np.float64), len(_CORNERS), axis=0)
    return PosedBody(Mesh("beads", points, triangles, colors=each), points)
