"""Beads that mark places in a picture: small coloured balls, all of them as one mesh."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.mesh import Mesh
from ringlet.picture.bodies import PosedBody

# A regular icosahedron in a ball of radius 1, its corners on three rectangles with sides in the golden ratio.
_LONG = np.cos(0.5 * np.arctan(2.0))
_SHORT = np.sin(0.5 * np.arctan(2.0))
_CORNERS = np.array([np.roll([0.0, a * _SHORT, b * _LONG], k) for k in range(3) for a in (1, -1) for b in (1, -1)])


def _faces() -> NDArray[np.int32]:
    """Its triangles, counter-clockwise from outside: all three corners that are next to one another."""
    apart = np.linalg.norm(_CORNERS[:, None] - _CORNERS[None], axis=2)
    near = (apart > 0) & (apart < 1.01 * apart[apart > 0].min())
    faces = [
        (i, j, k) for i in range(12) for j in range(12) for k in range(12) if near[i, j] and near[j, k] and near[k, i]
    ]
    outward = [f for f in faces if f[0] == min(f) and np.linalg.det(_CORNERS[list(f)]) > 0]
    return np.array(outward, np.int32)


def beads(places: NDArray[np.floating], colors: NDArray[np.floating], radius: float) -> PosedBody:
    """Balls of one radius [m] at places [m], shape (k, 3), in linear colours, shape (k, 3)."""
    points = (np.asarray(places, np.float64)[:, None] + radius * _CORNERS).reshape(-1, 3)
    faces = _faces()
    triangles = (len(_CORNERS) * np.arange(len(places))[:, None, None] + faces).reshape(-1, 3).astype(np.int32)
    each = np.repeat(np.asarray(colors, np.float64), len(_CORNERS), axis=0)
    return PosedBody(Mesh("beads", points, triangles, colors=each), points)
