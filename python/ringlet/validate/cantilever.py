"""A clamped rod that bends under its own weight: Γ = w L³ / EI, with drop H and reach W of the tip.

Expected values: the planar elastica solved as a boundary value problem.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

from ringlet.validate.case import Case, Row, convergence
from ringlet.validate.rods import gravity_for, rod_material, straight_rod

LENGTH = 0.1  # [m]
DROP = {1: 0.123471, 4: 0.425159, 8: 0.640631, 20: 0.829881, 50: 0.907917, 100: 0.937524, 500: 0.973117}  # H / L
SLOPE = {1: 0.124562, 4: 0.477648, 8: 0.884330, 20: 1.86393, 50: 3.70556, 100: 5.88811, 500: 14.7688}  # H / W


@cache
def tip(gamma: float, edges: int) -> tuple[float, float]:
    """Reach and drop of the tip [m]."""
    material = rod_material()
    rod = straight_rod(LENGTH, edges, material)
    rod.settle(gravity=(0.0, -gravity_for(gamma, LENGTH, material), 0.0))
    x, y, _ = rod.positions[-1]
    return float(x), float(-y)


def run() -> Iterator[Row]:
    for gamma, expected in DROP.items():
        yield from convergence(
            f"cantilever Γ={gamma} H/L", expected, lambda n, g=gamma: tip(g, n)[1] / LENGTH, (25, 50, 100), 5e-4
        )
    for gamma, expected in SLOPE.items():
        yield from convergence(
            f"cantilever Γ={gamma} H/W", expected, lambda n, g=gamma: tip(g, n)[1] / tip(g, n)[0], (25, 50, 100), 2e-3
        )


CASE = Case("cantilever", "A clamped rod sags under its own weight as the elastica does", run)
