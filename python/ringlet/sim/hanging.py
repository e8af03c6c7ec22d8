"""Strands that hang still, and how they move about that."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.motion import CoilLengths, HangingLocks, modes_of
from ringlet.sim.core import Vector
from ringlet.sim.strands import Strands

STILL = 1e-7, 1e-9  # motion in a step, and in an iteration, below which locks hang still [m]
NEARLY_STILL = 1e-4, 1e-4  # and below which the square of a frequency is right to 1 % or better
STEP, STEPS = 100.0, 40  # length of a step [s], in which inertia counts for nothing, and the most of them


def hang(
    strands: Strands,
    groomed: NDArray[np.floating],
    gravity: Vector,
    *,
    settle: bool = True,
    still: tuple[float, float] = STILL,
) -> HangingLocks:
    """Lets strands hang from where they are until they are still.

    groomed: the groom [m], shape (n, 3)
    gravity: [m/s²]
    settle:  False where they are still already
    still:   motion in a step, and in an iteration of it, below which they are [m]
    """
    if settle:
        strands.settle(gravity=gravity, tolerance=still[0], within=still[1], dt=STEP, steps=STEPS)
    points, coils = strands.positions.copy(), CoilLengths(strands.curves.with_points(groomed))
    modes = modes_of(strands, points, gravity)
    return HangingLocks(coils.of(points) / coils.of(groomed) - 1.0, modes, strands.material.mass_damping)
