"""Out-of-plane instability of a naturally curved rod that hangs from a vertical clamp: the bend–twist test.

GJ/EI = 2/3. The planar equilibrium is stable for small Γ = w L³ / EI. At the threshold the exact out-of-plane stiffness
has its first zero eigenvalue.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np
from scipy.optimize import root_scalar

from ringlet.validate.case import Case, Row
from ringlet.validate.rods import gravity_for, rod_material, stiffness, strand

LENGTH, RATIO = 0.1, 2 / 3
THRESHOLDS = {"2π": (2 * np.pi, 12.2), "8": (8.0, 19.3), "10": (10.0, 28.8)}  # κ₀L, Γ


@cache
def lowest(curvature: float, gamma: float, edges: int) -> float:
    """Lowest eigenvalue of the out-of-plane stiffness at the planar equilibrium [N/m]."""
    # Three prescribed vertices clamp the frame too; the vertical clamp is at the midpoint of the second edge.
    chord, turn = LENGTH / (edges - 0.5), curvature / (edges - 0.5)
    heading = -np.pi / 2 + turn * np.arange(-1, edges)
    tangents = np.c_[np.cos(heading), np.sin(heading), 0 * heading]
    points = chord * np.concatenate([np.zeros((1, 3)), np.cumsum(tangents, axis=0)])
    material = rod_material(twist_ratio=RATIO)
    rod = strand(points, material, 3)
    rod.settle(gravity=(0.0, -gravity_for(gamma, LENGTH, material), 0.0))
    assert not rod.positions[:, 2].any(), "a planar rod under planar load stays in its plane"
    return float(np.linalg.eigvalsh(stiffness(rod, rod.positions, np.arange(3, edges + 2), axis=2))[0])


def threshold(curvature: float, expected: float, edges: int) -> float:
    """Γ at which the planar state becomes unstable, searched between 0.4 and 2 times the expected value."""
    return float(
        root_scalar(lambda g: lowest(curvature, g, edges), bracket=(0.4 * expected, 2 * expected), rtol=1e-4).root
    )


def run() -> Iterator[Row]:
    for name, (curvature, expected) in THRESHOLDS.items():  # expected values have three digits
        for edges, tolerance in ((25, 4e-2), (50, 1e-2), (100, 5e-3)):
            got = threshold(curvature, expected, edges)
            yield Row(f"planar to 3-D, κ₀L={name} Γ, {edges} edges", expected, got, tolerance)


CASE = Case("out-of-plane", "A naturally curved hanging rod leaves its plane where Kirchhoff's rod does", run)
