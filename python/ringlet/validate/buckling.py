"""When a straight column gives way: the load at which the exact stiffness across it has its first zero eigenvalue.

Clamped–free π²EI/4L² and clamped–clamped 4π²EI/L² (Euler); under its own weight Γ = w L³ / EI = 7.83735 (Greenhill).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from ringlet.sim.strands import Strands
from ringlet.validate.case import Case, Row, convergence
from ringlet.validate.rods import bending_stiffness, gravity_for, masses, rod_material, stiffness, straight_rod, strand

LENGTH = 0.1  # [m]
SELF_BUCKLING = 7.83735


def critical(rod: Strands, free: NDArray[np.int64], thrust: NDArray[np.float64]) -> float:
    """The factor on ``thrust`` (compression of each edge [N], shape (n − 1,)) at which the column buckles.

    The stiffness across is linear in the thrust while the column is hard to compress, so two of them tell.
    """
    rest = rod.curves.points
    lengths = np.linalg.norm(np.diff(rest, axis=0), axis=1)
    area = np.pi * rod.material.radius**2
    small = 1e-3
    pressed = rest.copy()
    shorter = lengths * (1 - small * thrust / (rod.material.youngs_modulus * area))
    pressed[1:, 0] = rest[0, 0] + np.cumsum(shorter)
    unloaded = stiffness(rod, rest, free, axis=1)
    by_thrust = (stiffness(rod, pressed, free, axis=1) - unloaded) / small
    # unloaded v = −factor by_thrust v; the largest 1/factor belongs to the first load.
    return float(1.0 / eigh(-by_thrust, unloaded, eigvals_only=True)[-1])


def clamped_free(edges: int) -> float:
    """Critical end load, in EI/L²."""
    rod = straight_rod(LENGTH, edges, rod_material())
    load = bending_stiffness(rod.material) / LENGTH**2
    return critical(rod, np.arange(2, edges + 1), np.full(edges, load))


def clamped_clamped(edges: int) -> float:
    """Critical end load, in EI/L²: both clamps stand in the middle of an end edge."""
    material = rod_material()
    x = LENGTH * (np.arange(edges + 1) - 0.5) / (edges - 1)
    rod = strand(np.c_[x, 0 * x, 0 * x], material, 2)
    return critical(rod, np.arange(2, edges - 1), np.full(edges, bending_stiffness(material) / LENGTH**2))


def own_weight(edges: int) -> float:
    """Critical Γ."""
    rod = straight_rod(LENGTH, edges, rod_material())
    weight = gravity_for(1.0, LENGTH, rod.material) * masses(rod)
    above = np.cumsum(weight[::-1])[::-1][1:]  # what each edge carries
    return critical(rod, np.arange(2, edges + 1), above)


def run() -> Iterator[Row]:
    resolutions = (12, 25, 50)
    yield from convergence("Euler buckling, clamped–free PL²/EI", np.pi**2 / 4, clamped_free, resolutions, 1e-3)
    yield from convergence("Euler buckling, clamped–clamped PL²/EI", 4 * np.pi**2, clamped_clamped, resolutions, 4e-3)
    yield from convergence("self-buckling Γ", SELF_BUCKLING, own_weight, resolutions, 1e-3)


CASE = Case("buckling", "A straight column buckles at the loads of Euler and Greenhill", run)
