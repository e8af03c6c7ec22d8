"""How thick locks with a radius of their own are: strands of braids, knots, locs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.groom import STRAND_PROFILE, STRAND_RADIUS


def own_radii(locks: Curves) -> NDArray[np.float64]:
    """Radius that locks have of their own, at their points [m], shape (n,); 0 for others."""
    own = np.repeat(np.asarray(locks.curve.get(STRAND_RADIUS, np.zeros(len(locks))), np.float64), locks.counts)
    if STRAND_PROFILE in locks.curve:
        own *= _at_points(np.asarray(locks.curve[STRAND_PROFILE], np.float64), locks)
    return own


def _at_points(profile: NDArray[np.float64], locks: Curves) -> NDArray[np.float64]:
    """Values at even steps from root to tip, shape (count, k), at the points, by their number; shape (n,)."""
    steps = np.linspace(0.0, 1.0, profile.shape[1])
    rows = zip(profile, locks.counts, strict=True)
    return np.concatenate([np.interp(np.linspace(0.0, 1.0, count), steps, row) for row, count in rows])
