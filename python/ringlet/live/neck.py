"""Where a head turns."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.groom import Groom

BELOW = 1.0  # height below the roots in which the neck is looked for, relative to the width of what they cover
SLICE = 0.01  # height of the slices [m]


def neck(groom: Groom) -> NDArray[np.float64]:
    """Where a head turns on its neck: in the first narrow slice of its mesh below the roots [m], shape (3,)."""
    roots, points = (
        np.asarray(of, np.float64) for of in (groom.locks.points[groom.locks.offsets[:-1]], groom.scalp.points)
    )
    low, high = roots.min(axis=0), roots.max(axis=0)
    below = points[(points[:, 1] < low[1]) & (points[:, 1] > low[1] - BELOW * (high[0] - low[0]))]
    if not len(below):
        return np.array([0.5 * (low[0] + high[0]), low[1], 0.5 * (low[2] + high[2])])
    slices = np.floor(below[:, 1] / SLICE)
    each = [below[slices == number] for number in np.unique(slices)[::-1]]  # from above
    sizes = np.array([np.ptp(of[:, 0]) * np.ptp(of[:, 2]) for of in each])
    near = [sizes[max(k - 2, 0) : k + 3].min() for k in range(len(sizes))]
    narrow = each[int(np.argmax(sizes <= near))]
    return 0.5 * (narrow.min(axis=0) + narrow.max(axis=0))
