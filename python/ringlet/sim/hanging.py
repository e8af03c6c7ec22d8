"""Strands that hang still, and how they move about that."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.motion import CoilLengths, HangingLocks, modes_of
from ringlet.sim.core import Vector
from ringlet.sim.strands import Strands

STILL, STEPS = 1e-7, 40  # motion in a step of 1 s below which locks hang still [m], and the most steps


def hang(strands: Strands, groomed: NDArray[np.floating], gravity: Vector, *, settle: bool = True) -> HangingLocks:
    """Lets strands hang from where they are until they are still.

    groomed: the groom [m], shape (n, 3)
    gravity: [m/s²]
    settle:  False where they are still already
    """
    if settle:
        strands.settle(gravity=gravity, tolerance=STILL, steps=STEPS)
    points, coils = strands.positions.copy(), CoilLengths(strands.curves.with_points(groomed))
    modes = modes_of(strands, points, gravity)
    return HangingLocks(coils.of(points) / coils.of(groomed) - 1.0, modes, strands.material.mass_damping)
