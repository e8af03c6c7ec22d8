"""The binding of curves to a mesh: where their roots are on it, and whether they begin there."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError

ROOT_TOLERANCE = 1e-4  # farthest that a root of a groom is from its place on the scalp [m]


def root_places(curves: Curves, points: NDArray, triangles: NDArray) -> NDArray[np.float64]:
    """Places of the roots on a mesh with points [m], shape (n, 3), by triangle and weights; shape (count, 3)."""
    corners = np.asarray(points, np.float64)[triangles[curves.curve["root_triangle"]]]
    return np.einsum("nk,nkd->nd", curves.curve["root_barycentric"], corners)


def check_roots(roots: NDArray, places: NDArray, ids: NDArray, what: str, remedy: str, allowed: float = 0.0) -> None:
    """Raises UserError when roots are farther from their places on the scalp than a tolerance.

    roots, places: positions [m], shape (count, 3)
    ids:           of the curves
    what:          what they belong to, for the message
    allowed:       distance beyond the tolerance [m]
    """
    distance = np.linalg.norm(roots - places, axis=1)
    if (off := ~(distance <= ROOT_TOLERANCE + allowed)).any():  # also true for NaN
        worst = int(np.nan_to_num(distance, nan=np.inf).argmax())
        raise UserError(
            f"{what}: {off.sum()} of {len(off)} roots are off the scalp, that of lock {ids[worst]} by "
            f"{1e3 * distance[worst]:.3g} mm; the head has changed: {remedy}"
        )
