"""Loose waves of type 2A vibrate like the smooth rod, in every direction: the discretisation does not stiffen them.

Expected values: linear theory of a curved rod. A force F at a point r bends and twists the rod between r and the clamp
with the moment m(s) = (r − r(s)) × F. By virtual work the compliance of two forces is
∫ m₁⊥ · m₂⊥ / EI + m₁ₜ m₂ₜ / GJ ds. Compliance and masses give the frequencies.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from ringlet.shot.solver import Continuation
from ringlet.sim.strands import Strands
from ringlet.validate.case import Case, Row, convergence
from ringlet.validate.rods import bending_stiffness, line_density, masses, rod_material, strand

HEIGHT, AMPLITUDE, WAVELENGTH = 0.06, 2e-3, 0.03  # [m]
SHAPES = {"wave in a plane": 0.0, "wave around an axis": 1.0}  # amplitude of the third coordinate
PRESCRIBED = 3  # vertices

Points = NDArray[np.float64]


def wave(shape: str, along: NDArray[np.floating]) -> Points:
    """Points [m] at depths ``along`` [m] below the clamp."""
    phase = 2 * np.pi * np.asarray(along, np.float64) / WAVELENGTH
    return np.c_[AMPLITUDE * np.sin(phase), -np.asarray(along), SHAPES[shape] * AMPLITUDE * np.cos(phase)]


def polyline(shape: str, edges: int) -> Points:
    """Vertices at equal distances [m]; the clamp is at the midpoint of the second edge."""
    along = np.linspace(-HEIGHT, HEIGHT, 40_001)
    steps = np.linalg.norm(np.diff(wave(shape, along), axis=0), axis=1)
    arc = np.append(0.0, np.cumsum(steps)) - steps[: len(steps) // 2].sum()
    return wave(shape, np.interp(arc[-1] * (np.arange(edges + 1) - 1.5) / (edges - 1.5), arc, along))


@cache
def theory(shape: str) -> tuple[float, float]:
    """The two lowest angular frequencies of the smooth rod [1/s]."""
    material, pieces = rod_material(), 400
    ends = wave(shape, np.linspace(0.0, HEIGHT, pieces + 1))
    middle, edges = 0.5 * (ends[1:] + ends[:-1]), np.diff(ends, axis=0)
    lengths = np.linalg.norm(edges, axis=1)
    tangents = edges / lengths[:, None]
    # Moment at piece s of unit forces along the axes at a later piece r, in the order (s, moment, r, axis).
    arms = np.triu(np.ones((pieces, pieces)))[:, :, None] * (middle[None] - middle[:, None])
    moments = np.stack([np.cross(arms, axis) for axis in np.eye(3)], axis=-1).transpose(0, 2, 1, 3)
    twist = np.einsum("smra,sm->sra", moments, tangents)
    bend = moments - tangents[:, :, None, None] * twist[:, None]
    EI = bending_stiffness(material)
    bend *= np.sqrt(lengths / EI)[:, None, None, None]
    twist *= np.sqrt(lengths / (material.twist_ratio * EI))[:, None, None]
    factor = np.concatenate([bend.reshape(3 * pieces, -1), twist.reshape(pieces, -1)])
    factor *= np.sqrt(line_density(material) * np.repeat(lengths, 3))
    first, second = np.linalg.svd(factor, compute_uv=False)[:2]
    return float(1 / first), float(1 / second)


def frequencies(shape: str, edges: int, continuation: Continuation = "material_frame") -> tuple[float, float]:
    """The two lowest angular frequencies of the strand [1/s]."""
    rod: Strands = strand(polyline(shape, edges), rod_material(correct_resolution=False), PRESCRIBED)
    rest = rod.curves.points
    h = 1e-6 * np.linalg.norm(rest[1] - rest[0])
    columns = []
    for coordinate in range(3 * PRESCRIBED, rest.size):
        step = np.zeros(rest.size)
        step[coordinate] = h
        up, down = (
            rod.energy(rest + sign * step.reshape(rest.shape), continuation=continuation)[1][PRESCRIBED:].ravel()
            for sign in (1, -1)
        )
        columns.append((up - down) / (2 * h))
    stiffness = np.array(columns)
    mass = np.diag(np.repeat(masses(rod)[PRESCRIBED:], 3))
    squares = eigh(0.5 * (stiffness + stiffness.T), mass, eigvals_only=True, subset_by_index=(0, 1))
    return float(np.sqrt(squares[0])), float(np.sqrt(squares[1]))


def run() -> Iterator[Row]:
    resolutions, tolerance = (15, 30, 60), 3e-4
    for shape in SHAPES:
        lowest, second = theory(shape)
        yield from convergence(
            f"{shape}, lowest ω", lowest, lambda n, s=shape: frequencies(s, n)[0], resolutions, tolerance
        )
        # The second mode mixes with the close lowest one: its error is as small, but converges less evenly.
        for n in resolutions:
            yield Row(f"{shape}, second ω, {n} edges", second, frequencies(shape, n)[1], tolerance * (60 / n) ** 2)


CASE = Case("loose-waves", "Loose waves swing freely, in their plane and out of it", run)
