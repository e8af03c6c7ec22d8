"""Polygons of a file as triangles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError


def check_polygons(counts: NDArray, indices: NDArray, points: int, where: str) -> None:
    """Refuses polygons that are none, too small, or use points that are not there.

    counts:  corners per polygon, shape (f,)
    indices: the point of each corner, polygon after polygon
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
    """Cuts polygons into fans: the corners of each triangle, shape (m, 3), and its polygon, shape (m,)."""
    faces = np.repeat(np.arange(len(counts)), counts - 2)
    starts, cuts = np.cumsum(counts) - counts, np.cumsum(counts - 2) - (counts - 2)
    step = np.arange(len(faces)) - cuts[faces]
    around = np.stack([np.zeros_like(step), step + 1, step + 2], axis=1)
    if clockwise:  # walk round the other way, from the same first corner
        around[:, 1:] = counts[faces][:, None] - around[:, 1:]
    return starts[faces][:, None] + around, faces
