"""Rods for the known answers: a hair of Ringlet's typical material with no damping and no drag."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.shot.material import Material
from ringlet.sim.strands import Strands


def rod_material(*, twist_ratio: float = 0.72, correct_resolution: bool = True) -> Material:
    """A hair (E 4 GPa, r 35 µm), with its full resistance to stretch."""
    return Material(
        stretch_scale=1.0, twist_ratio=twist_ratio, damping=0.0, drag=0.0, correct_resolution=correct_resolution
    )


def bending_stiffness(material: Material) -> float:
    """EI [N m²]."""
    return material.youngs_modulus * np.pi * material.radius**4 / 4


def line_density(material: Material) -> float:
    """Mass per length [kg/m]."""
    return material.density * np.pi * material.radius**2


def gravity_for(gamma: float, length: float, material: Material) -> float:
    """The gravity [m/s²] that gives Γ = w L³ / EI."""
    return gamma * bending_stiffness(material) / (line_density(material) * length**3)


def strand(
    points: NDArray[np.floating],
    material: Material,
    held: int | NDArray[np.bool_],
    variation: Mapping[str, NDArray[np.float64]] | None = None,
) -> Strands:
    """One strand at rest in the shape of ``points`` [m], shape (n, 3)."""
    return Strands(Curves.from_list([points]), material, held, variation or {})


def masses(rod: Strands) -> NDArray[np.float64]:
    """Mass of each vertex [kg], shape (n,): half of each edge beside it."""
    edges = line_density(rod.material) * np.linalg.norm(np.diff(rod.curves.points, axis=0), axis=1)
    return 0.5 * (np.append(edges, 0.0) + np.append(0.0, edges))


def stiffness(
    rod: Strands, positions: NDArray[np.floating], vertices: NDArray[np.int64], axis: int
) -> NDArray[np.float64]:
    """Exact second derivative [N/m] of the elastic energy by the given vertices' coordinates along ``axis``.

    By differences of the gradient: the solver's own Hessian leaves negative eigenvalues out, and thresholds are where
    the exact one has its first.
    """
    h = 1e-6 * np.linalg.norm(rod.curves.points[1] - rod.curves.points[0])
    columns = []
    for vertex in vertices:
        step = np.zeros_like(positions)
        step[vertex, axis] = h
        up, down = (rod.energy(positions + sign * step)[1][vertices, axis] for sign in (1, -1))
        columns.append((up - down) / (2 * h))
    result = np.array(columns)
    return 0.5 * (result + result.T)


def straight_rod(length: float, edges: int, material: Material) -> Strands:
    """A rod along +x, clamped at x = 0, which is the middle of its first edge: the two vertices of that edge are held.

    A bend acts over half an edge on either side of its vertex, so a clamp by a held edge stands in the middle of it.
    """
    x = length * (np.arange(edges + 1) - 0.5) / (edges - 0.5)
    return strand(np.c_[x, 0 * x, 0 * x], material, 2)
