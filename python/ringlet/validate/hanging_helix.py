"""A coil that hangs from its clamped top and lengthens under its own weight, like a curl.

R 5 mm, pitch 4 mm, 6 turns, GJ/EI = 1/1.38. Expected values: Kirchhoff's rod solved as a boundary value problem.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ringlet.validate.case import Case, Row, convergence
from ringlet.validate.rods import gravity_for, rod_material, strand

RADIUS, PITCH, TURNS, RATIO = 5e-3, 4e-3, 6, 1 / 1.38
EXTENSION = {1: 0.000475, 5: 0.002372, 20: 0.009429, 50: 0.02336, 100: 0.046094}  # relative to the arc length L


def extension(gamma: float, per_turn: int, *, correct_resolution: bool) -> float:
    """Displacement of the tip relative to the arc length, at ``per_turn`` vertices a turn."""
    edges = per_turn * TURNS
    # Three prescribed vertices clamp position and frame. A bend acts half an edge beyond its vertex, so the clamp is at
    # the midpoint of edge 1.
    turn = 2 * np.pi * (np.arange(edges + 3) - 1.5) / per_turn
    turn[-1] = 2 * np.pi * TURNS
    points = np.c_[RADIUS * np.cos(turn), -PITCH * turn / (2 * np.pi), RADIUS * np.sin(turn)]
    length = TURNS * np.hypot(2 * np.pi * RADIUS, PITCH)
    material = rod_material(twist_ratio=RATIO, correct_resolution=correct_resolution)
    coil = strand(points, material, 3)
    coil.settle(gravity=(0.0, -gravity_for(gamma, length, material), 0.0))
    return float(points[-1, 1] - coil.positions[-1, 1]) / length


def run() -> Iterator[Row]:
    for gamma, expected in EXTENSION.items():
        case = f"hanging helix Γ={gamma} extension/L"
        yield from convergence(
            f"{case}, uncorrected",
            expected,
            lambda n, g=gamma: extension(g, n, correct_resolution=False),
            (12, 24, 48),
            7e-3,
            unit="vertices a turn",
        )
        for per_turn, tolerance in ((8, 2e-2), (12, 1e-2), (24, 5e-3)):
            got = extension(gamma, per_turn, correct_resolution=True)
            yield Row(f"{case}, corrected, {per_turn} vertices a turn", expected, got, tolerance)


CASE = Case("hanging-helix", "A hanging coil lengthens as Kirchhoff's rod does", run)
