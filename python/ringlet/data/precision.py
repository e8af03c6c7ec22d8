"""Single precision for positions: good near the origin of coordinates, or relative to an origin near them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

REACH = 8.0  # farthest from an origin that single precision resolves 0.5 µm [m]


def compact(points: NDArray[np.floating]) -> NDArray[np.floating]:
    """Positions [m] in single precision, or in double precision where single would lose micrometres."""
    return np.asarray(points, np.float32 if np.abs(points).max(initial=0.0) <= REACH else np.float64)


def origin_of(points: NDArray[np.floating], before: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
    """The origin [m] relative to which positions (n, 3) keep micrometres in single precision, shape (3,).

    It is ``before``, by default that of coordinates, as long as that is near enough, or else in their middle, in whole
    metres. Positions that are not finite have none.
    """
    origin = np.zeros(3) if before is None else before
    if len(points) == 0 or np.abs(points - origin).max() <= REACH:
        return origin
    middle = 0.5 * (points.min(axis=0).astype(np.float64) + points.max(axis=0))
    return np.round(middle) if np.isfinite(middle).all() else origin
