"""The bounds of all positions that are computed: finite, and in a box around the head."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.precision import extent

LEAST_REACH = 10.0  # how far hair and cloth may be from the head, however small that is [m]
REACH_TIMES = 100.0  # or so many times the diagonal of the head's bounding box, whichever is more
WORLD = 1e7  # largest coordinate [m]


def check_positions(points: NDArray, around: NDArray, where: str, name: Callable[[int], str], remedy: str) -> None:
    """Raises UserError for a position that is not finite or too far from the head.

    points: positions [m], shape (n, 3)
    around: points of the head [m], shape (k, 3)
    where:  the result and its frame, for the message
    name:   gives the name of a row of ``points``
    remedy: what to do, where the points come from
    """
    if not len(points):
        return
    low, high, reach = _box(around)
    least, largest = extent(points)
    if (least >= low).all() and (largest <= high).all():  # false for NaN
        return
    outside = ~((points >= low) & (points <= high)).all(axis=1)  # also true for NaN
    row = int(outside.argmax())
    place = ", ".join(f"{x:.4g}" for x in points[row])
    raise UserError(
        f"{where}: {name(row)} is at ({place}) m, {outside.sum()} of {len(points)} points are wrong; must be "
        f"finite and at most {reach:.3g} m from the head, so nothing is written: {remedy}"
    )


def check_curves(curves: Curves, points: NDArray, around: NDArray, where: str, remedy: str) -> None:
    """``check_positions`` of the points of curves."""

    def name(row: int) -> str:
        curve = int(np.searchsorted(curves.offsets, row, side="right") - 1)
        return f"curve {curves.ids[curve]}, point {row - curves.offsets[curve]}"

    check_positions(points, around, where, name, remedy)


def _box(around: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    low, high = (np.asarray(bound, np.float64) for bound in extent(around))
    reach = max(LEAST_REACH, REACH_TIMES * float(np.linalg.norm(high - low)))
    return np.maximum(low - reach, -WORLD), np.minimum(high + reach, WORLD), reach
