"""From where a hand pulls a lock to what an edit of the recipe says."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.groom import Groom
from ringlet.groom.edits import shape_frames
from ringlet.groom.scalp import Scalp


def pulled(groom: Groom, row: int, at: float, by: NDArray[np.float64]) -> NDArray[np.float64]:
    """A way in space [m] in the frame of a lock's shape: what ``move.by`` of an edit is in.

    row: the place of the lock in the list of locks
    at:  where on the lock, from root (0) to tip (1)
    """
    root = Scalp(groom.scalp, groom.region).frames(groom.locks)[row]
    frame = shape_frames(groom.shapes or groom.locks, row, root, np.array([at]))[0]
    return frame.T @ by
