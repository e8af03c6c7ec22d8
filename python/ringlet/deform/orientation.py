"""Orientation of surfaces: which triangles face the inside of what they enclose."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.winding import winding_numbers

PLACES = 16  # of a head, which say whether a surface is around it


def facing_inside(points: NDArray, triangles: NDArray, head: NDArray | None = None) -> NDArray[np.bool_]:
    """Mask of the triangles that face the inside of a closed surface, or of one with small openings, shape (m,).

    How that is known stands in the core (geometry/orientation.h).

    head: points of a head [m], shape (k, 3). A surface around it that faces it is a room, and stays as it is
    """
    places = np.ascontiguousarray(points, np.float64)
    part = _core.parts_facing_inside(places, np.ascontiguousarray(triangles, np.int32))
    found: NDArray[np.bool_] = part >= 0
    if head is None or not found.any():
        return found
    inside = np.asarray(head, np.float64)[:: max(1, len(head) // PLACES)]
    for one in np.unique(part[found]):
        own = part == one
        if np.median(winding_numbers(inside, places[triangles[own]])) < -0.5:
            found[own] = False
    return found


def outward(points: NDArray, triangles: NDArray, head: NDArray | None = None) -> NDArray[np.int32]:
    """Triangles with those that face the inside turned over, contiguous, shape (m, 3); see ``facing_inside``."""
    return turned(triangles, facing_inside(points, triangles, head))


def turned(triangles: NDArray, mask: NDArray[np.bool_]) -> NDArray[np.int32]:
    """Triangles with those of a mask turned over, contiguous, shape (m, 3)."""
    return np.ascontiguousarray(np.where(mask[:, None], triangles[:, ::-1], triangles), np.int32)
