"""The smooth step: a cubic from 0 to 1."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def smooth_step(x: ArrayLike) -> NDArray[np.float64]:
    """From 0 to 1 as x goes from 0 to 1, with no slope at the ends, and constant beyond."""
    x = np.clip(np.asarray(x, np.float64), 0.0, 1.0)
    return np.asarray(x * x * (3.0 - 2.0 * x))
