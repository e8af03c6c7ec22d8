"""Single precision for positions: good near the origin of coordinates, or relative to an origin near them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

REACH = 8.0  # farthest from an origin that single precision resolves 0.5 µm [m]
FOLD = 64  # positions that are reduced side by side: NumPy is slow on rows of three numbers


def compact(points: NDArray[np.floating]) -> NDArray[np.floating]:
    """Positions [m] in single precision, or in double precision where single would lose micrometres."""
    return np.asarray(points, np.float32 if np.abs(points).max(initial=0.0) <= REACH else np.float64)


def origin_of(points: NDArray[np.floating], before: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
    """The origin [m] relative to which positions (n, 3) keep micrometres in single precision, shape (3,).

    It is ``before``, by default that of coordinates, as long as that is near enough, or else in their middle, in whole
    metres. Positions that are not finite have none.
    """
    origin = np.zeros(3) if before is None else before
    if len(points) == 0:
        return origin
    low, high = extent(points)
    if max((high - origin).max(), (origin - low).max()) <= REACH:
        return origin
    middle = 0.5 * (low.astype(np.float64) + high)
    return np.round(middle) if np.isfinite(middle).all() else origin


def extent(points: NDArray[np.floating]) -> tuple[NDArray[np.floating], NDArray[np.floating]]:
    """Least and largest coordinates of positions (n, 3), n ≥ 1, each of shape (3,); NaN where one of them is."""
    folded = len(points) // FOLD * FOLD

    def of(reduce: Callable[..., NDArray]) -> NDArray:
        first = reduce(points[:folded].reshape(-1, 3 * FOLD), axis=0) if folded else points[:1]
        return reduce(np.concatenate([first.reshape(-1, 3), points[folded:]]), axis=0)

    return of(np.min), of(np.max)
