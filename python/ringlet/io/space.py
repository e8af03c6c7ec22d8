"""Conversion of points between the space of a file and metres, Y-up."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data import limits
from ringlet.data.errors import UserError
from ringlet.data.stage import StageSpace


def to_metres(points: NDArray, space: StageSpace) -> NDArray:
    """Converts points of a file, shape (n, 3), to metres, Y-up; keeps their type."""
    scaled = points * points.dtype.type(space.meters_per_unit)
    if space.up_axis == "Z":  # a quarter turn about x
        scaled = np.stack([scaled[:, 0], scaled[:, 2], -scaled[:, 1]], axis=1)
    return scaled


def to_file(points: NDArray, space: StageSpace) -> NDArray:
    """Converts points [m], Y-up, shape (n, 3), to the space of a file; keeps their type."""
    scaled = points * points.dtype.type(1.0 / space.meters_per_unit)
    if space.up_axis == "Z":
        scaled = np.stack([scaled[:, 0], -scaled[:, 2], scaled[:, 1]], axis=1)
    return scaled


def from_metres(points: NDArray, space: StageSpace) -> NDArray[np.float32]:
    """Converts points [m], Y-up, shape (n, 3), to the space of a file, float32."""
    return np.ascontiguousarray(to_file(points, space), np.float32)


def check_points(points: NDArray, where: str) -> None:
    """Raises UserError for an empty list of points, shape (n, 3), or points that are not finite or too far away."""
    if len(points) == 0:
        raise UserError(f"{where}: has no points; export it again or choose another")
    if not (near := (np.abs(points) <= limits.FARTHEST).all(axis=1)).all():
        row = int(np.flatnonzero(~near)[0])
        raise UserError(
            f"{where}: point {row} is {points[row]}; must be finite, and at most {limits.FARTHEST:g} from 0"
        )
