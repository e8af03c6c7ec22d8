"""Rods of the validation: a hair of typical material, without damping and drag."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.shot.material import Material
from ringlet.sim.strands import Strands


def rod_material(*, twist_ratio: float = 0.72, correct_resolution: bool = True) -> Material:
    """Material of a hair (E 4 GPa, r 35 µm) with its full stretch stiffness."""
    return Material(
        stretch_scale=1.0, twist_ratio=twist_ratio, damping=0.0, drag=0.0, correct_resolution=correct_resolution
    )


def bending_stiffness(material: Material) -> float:
    """Bending stiffness EI [N m²]."""
    return material.youngs_modulus * np.pi * material.radius**4 / 4


def line_density(material: Material) -> float:
    """Mass per length [kg/m]."""
    return material.density * np.pi * material.radius**2


def gravity_for(gamma: float, length: float, material: Material) -> float:
    """Gravity [m/s²] for a given Γ = w L³ / EI."""
    return gamma * bending_stiffness(material) / (line_density(material) * length**3)


def strand(
    points: NDArray[np.floating],
    material: Material,
    held: int | NDArray[np.bool_],
    variation: Mapping[str, NDArray[np.float64]] | None = None,
) -> Strands:
    """One strand with the rest shape ``points`` [m], shape (n, 3).

    held: number of prescribed vertices at the root, or a mask of them, shape (n,)
    """
    return Strands(Curves.from_list([points]), material, held, variation or {})


def masses(rod: Strands) -> NDArray[np.float64]:
    """Mass of each vertex [kg], shape (n,): half of each adjacent edge."""
    edges = line_density(rod.material) * np.linalg.norm(np.diff(rod.curves.points, axis=0), axis=1)
    return 0.5 * (np.append(edges, 0.0) + np.append(0.0, edges))


def stiffness(
    rod: Strands, positions: NDArray[np.floating], vertices: NDArray[np.int64], axis: int
) -> NDArray[np.float64]:
    """Exact Hessian of the elastic energy [N/m] in the coordinates of vertices along ``axis``.

    Uses differences of the gradient: the solver's Hessian is projected to be positive, and a stability threshold is the
    first negative eigenvalue of the exact one.
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
    """A rod along +x, clamped at x = 0, the midpoint of its first edge, whose two vertices are prescribed.

    A bend acts over half an edge on either side of its vertex, so a prescribed edge is a clamp at its midpoint.
    """
    x = length * (np.arange(edges + 1) - 0.5) / (edges - 0.5)
    return strand(np.c_[x, 0 * x, 0 * x], material, 2)
