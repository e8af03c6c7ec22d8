"""Buckling load of a straight column: the load at which its lateral stiffness has the first zero eigenvalue.

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
    """Factor on ``thrust`` at which the column buckles.

    free:   vertices that are not prescribed
    thrust: compression of each edge [N], shape (n − 1,)

    The lateral stiffness is linear in the thrust of a nearly incompressible column, so two evaluations suffice.
    """
    rest = rod.curves.points
    lengths = np.linalg.norm(np.diff(rest, axis=0), axis=1)
    area = np.pi * rod.material.radius**2
    small = 1e-3
    compressed = rest.copy()
    compressed_lengths = lengths * (1 - small * thrust / (rod.material.youngs_modulus * area))
    compressed[1:, 0] = rest[0, 0] + np.cumsum(compressed_lengths)
    unloaded = stiffness(rod, rest, free, axis=1)
    geometric = (stiffness(rod, compressed, free, axis=1) - unloaded) / small
    # unloaded v = −factor geometric v; the largest 1/factor is the first buckling load.
    return float(1.0 / eigh(-geometric, unloaded, eigvals_only=True)[-1])


def clamped_free(edges: int) -> float:
    """Critical end load, in EI/L²."""
    rod = straight_rod(LENGTH, edges, rod_material())
    load = bending_stiffness(rod.material) / LENGTH**2
    return critical(rod, np.arange(2, edges + 1), np.full(edges, load))


def clamped_clamped(edges: int) -> float:
    """Critical end load, in EI/L²; each clamp is at the midpoint of an end edge."""
    material = rod_material()
    x = LENGTH * (np.arange(edges + 1) - 0.5) / (edges - 1)
    rod = strand(np.c_[x, 0 * x, 0 * x], material, 2)
    return critical(rod, np.arange(2, edges - 1), np.full(edges, bending_stiffness(material) / LENGTH**2))


def own_weight(edges: int) -> float:
    """Critical Γ."""
    rod = straight_rod(LENGTH, edges, rod_material())
    weight = gravity_for(1.0, LENGTH, rod.material) * masses(rod)
    thrust = np.cumsum(weight[::-1])[::-1][1:]  # weight above each edge
    return critical(rod, np.arange(2, edges + 1), thrust)


def run() -> Iterator[Row]:
    resolutions = (12, 25, 50)
    yield from convergence("Euler buckling, clamped–free PL²/EI", np.pi**2 / 4, clamped_free, resolutions, 1e-3)
    yield from convergence("Euler buckling, clamped–clamped PL²/EI", 4 * np.pi**2, clamped_clamped, resolutions, 4e-3)
    yield from convergence("self-buckling Γ", SELF_BUCKLING, own_weight, resolutions, 1e-3)


CASE = Case("buckling", "A straight column buckles at the loads of Euler and Greenhill", run)
