"""A weightless clamped rod, bent by a transverse force at its tip: P L² / EI, with drop H and reach W of the tip.

Expected values: the elastica in elliptic integrals.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np

from ringlet.validate.case import Case, Row, convergence
from ringlet.validate.rods import bending_stiffness, rod_material, straight_rod

LENGTH = 0.1  # [m]
TIP = {1: (0.301721, 0.943567), 2: (0.493457, 0.839358), 5: (0.713792, 0.612372), 10: (0.810609, 0.445004)}  # H/L, W/L


@cache
def tip(load: float, edges: int) -> tuple[float, float]:
    """Drop and reach of the tip, relative to the length."""
    material = rod_material()
    rod = straight_rod(LENGTH, edges, material)
    forces = np.zeros_like(rod.curves.points)
    forces[-1, 1] = -load * bending_stiffness(material) / LENGTH**2
    rod.settle(forces=forces)
    x, y, _ = rod.positions[-1] / LENGTH
    return float(-y), float(x)


def run() -> Iterator[Row]:
    for load, expected in TIP.items():
        for index, name in enumerate(("H/L", "W/L")):
            yield from convergence(
                f"tip load PL²/EI={load} {name}",
                expected[index],
                lambda n, p=load, k=index: tip(p, n)[k],
                (25, 50, 100),
                5e-4,
            )


CASE = Case("tip-load", "A force at its tip bends a clamped rod into the elastica", run)
