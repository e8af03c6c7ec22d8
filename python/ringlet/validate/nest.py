"""A nest of equal locks in contact that can move together, compared with one lock alone.

Each lock is the image of the next by a shift, so that nearly all of the motion is common. Straight locks in contact,
side by side across their motion, have no reason to move apart: they swing exactly as one does. Coils of one phase lie
in one another and hold each other back where they hook in; their answer is the converged solution.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.shot.contact import Contact
from ringlet.shot.material import Material
from ringlet.shot.solver import Solver
from ringlet.sim.scene import Scene
from ringlet.sim.strands import Strands
from ringlet.validate.case import Case, Row

RADIUS = 4e-4  # of contact [m]
SPACING = 1.02  # of neighbours, in diameters
FRAMES, DT = 8, 1 / 24  # [s]
TILT = 0.6  # of the field from the locks [rad]
GRAVITY = (9.81 * float(np.sin(TILT)), -9.81 * float(np.cos(TILT)), 0.0)  # [m/s²]
LENGTH, POINTS = 0.1, 96  # of a lock [m]
PITCH, WIDTH = 0.012, 0.008  # of a coil [m]
CONVERGED = Solver(newton=100, linear_tolerance=1e-2)


def hexagon(rings: int) -> NDArray[np.float64]:
    """Places of a middle and the rings about it [m], shape (n, 2); the row through the middle is along the motion."""
    cells = [(a, b) for a in range(-rings, rings + 1) for b in range(-rings, rings + 1) if abs(a + b) <= rings]
    return np.array([(a + 0.5 * b, b * np.sqrt(0.75)) for a, b in cells]) * 2 * RADIUS * SPACING


def row(count: int) -> NDArray[np.float64]:
    """Places of locks side by side across the motion [m], shape (count, 2)."""
    return np.c_[np.zeros(count), np.arange(count)] * 2 * RADIUS * 0.9


def locks(places: NDArray[np.float64], width: float) -> Curves:
    """Locks that hang from ``places``; coils as wide as ``width`` [m]."""
    y = -np.linspace(0.0, LENGTH, POINTS)
    angle = 2 * np.pi * y / PITCH
    w = 0.5 * width * np.clip(-y / 0.01, 0.0, 1.0)
    return Curves.from_list([np.c_[x + w * np.cos(angle), y, z + w * np.sin(angle)] for x, z in places])


def scene(curves: Curves, friction: float = 0.0) -> Scene:
    """The locks in contact, at rest and held by their roots."""
    strands = Strands(curves, Material(bend_scale=6.0, damping=0.004, drag=0.0), 2)
    return Scene(strands, contact=Contact(radius=RADIUS, friction=friction))


def tips(curves: Curves, solver: Solver, friction: float = 0.0) -> NDArray[np.float64]:
    """Displacement of each tip by frame [m], in a field at an angle to the locks, shape (frames, n, 3)."""
    nest = scene(curves, friction)
    frames = []
    for _ in range(FRAMES):
        nest.step(curves.points, DT, gravity=GRAVITY, solver=solver)
        frames.append((nest.strands.positions - curves.points)[curves.offsets[1:] - 1])
    return np.array(frames)


def swing(ends: NDArray[np.float64]) -> float:
    """Range of the mean tip's displacement across the locks [m]."""
    return float(np.ptp(ends[:, :, 0].mean(axis=1)))


def run() -> Iterator[Row]:
    one = tips(locks(np.zeros((1, 2)), 0.0), CONVERGED)
    together = tips(locks(row(12), 0.0), Solver())
    yield Row("nest, 12 straight locks side by side swing as one", swing(one), swing(together), 0.03)
    coil = swing(tips(locks(np.zeros((1, 2)), WIDTH), CONVERGED))
    for rings, converged in ((1, 0.975), (3, 0.930)):
        places = hexagon(rings)
        got = swing(tips(locks(places, WIDTH), CONVERGED)) / coil
        yield Row(f"nest, {len(places)} coils, swing over that of one", converged, got, 0.01)


CASE = Case("nest", "Locks in contact swing together as their converged solution does", run)
