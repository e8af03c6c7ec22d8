"""Converts a pull of a lock in world space to an edit of the recipe."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.groom import Groom
from ringlet.groom.edits import shape_frames
from ringlet.groom.scalp import Scalp


def pulled(groom: Groom, row: int, at: float, by: NDArray[np.float64]) -> NDArray[np.float64]:
    """Displacement [m], shape (3,), in the frame of a lock's shape, as in ``move.by`` of an edit.

    row: row of the lock
    at:  parameter on the lock, from root (0) to tip (1)
    by:  displacement in world space [m], shape (3,)
    """
    root = Scalp(groom.scalp, groom.region).frames(groom.locks)[row]
    frame = shape_frames(groom.shapes or groom.locks, row, root, np.array([at]))[0]
    return frame.T @ by
