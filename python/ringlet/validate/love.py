"""A coil pulled along its axis, with both ends free to rotate: it stays a helix (Love).

GJ(τ−τ₀) sinα + EI(κ−κ₀) cosα = 0,  FR = GJ(τ−τ₀) cosα − EI(κ−κ₀) sinα,  κ = cos²α/R,  τ = sinα cosα/R.
The coil has R = 5 mm and a pitch of 4 mm.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np
from scipy.optimize import root_scalar

from ringlet.validate.case import Case, Row, convergence
from ringlet.validate.rods import bending_stiffness, rod_material, strand

RADIUS, PITCH, TURNS, RATIO = 5e-3, 4e-3, 6, 1 / 1.38
LOADS = (0.02, 0.1, 0.3)  # F R₀² / EI


@cache
def theory(load: float) -> float:
    """Rise per arc length, sin α, of the pulled coil."""
    alpha0 = np.arctan2(PITCH, 2 * np.pi * RADIUS)
    curvature0, torsion0 = np.cos(alpha0) ** 2, np.sin(alpha0) * np.cos(alpha0)  # in 1 / R₀

    def radius(alpha: float) -> float:  # of the first equation, in R₀
        sine, cosine = np.sin(alpha), np.cos(alpha)
        return cosine * (RATIO * sine**2 + cosine**2) / (RATIO * torsion0 * sine + curvature0 * cosine)

    def residual(alpha: float) -> float:  # of the second, which rises from the unloaded coil to the straight one
        sine, cosine, r = np.sin(alpha), np.cos(alpha), radius(alpha)
        twist = RATIO * (sine * cosine / r - torsion0)
        bend = cosine**2 / r - curvature0
        return twist * cosine - bend * sine - load * r

    alpha = root_scalar(residual, bracket=(alpha0, 0.5 * np.pi), xtol=1e-13).root
    return float(np.sin(alpha))


def rise(load: float, per_turn: int, *, correct_resolution: bool) -> float:
    """Rise per arc length of the coil's central turns.

    Stiff radial arms lead from both ends to the axis; the tip of the upper one is fixed, the lower one is pulled.
    """
    turn = 2 * np.pi * np.arange(per_turn * TURNS + 1) / per_turn
    coil = np.c_[RADIUS * np.cos(turn), -PITCH * turn / (2 * np.pi), RADIUS * np.sin(turn)]
    on_axis = np.array([0.0, 1.0, 0.0])
    start, end = coil[0] * on_axis, coil[-1] * on_axis
    points = np.concatenate([[start, 0.5 * (start + coil[0])], coil, [0.5 * (end + coil[-1]), end]])
    stiff = np.ones(len(points))
    stiff[[0, 1, 2, -3, -2, -1]] = 1e3
    material = rod_material(twist_ratio=RATIO, correct_resolution=correct_resolution)
    spring = strand(points, material, 1, {"bend": stiff})
    forces = np.zeros_like(points)
    forces[-1, 1] = -load * bending_stiffness(material) / RADIUS**2
    spring.settle(forces=forces, dt=0.05, tolerance=1e-8)  # a small step: rotation about the axis has no stiffness
    middle = slice(2 + per_turn, -2 - per_turn, per_turn)
    ends = spring.positions[middle][[0, -1]]
    axis = spring.positions[-1] - spring.positions[0]
    arc = np.hypot(2 * np.pi * RADIUS, PITCH) * (len(spring.positions[middle]) - 1)
    return float((ends[1] - ends[0]) @ axis / np.linalg.norm(axis) / arc)


def run() -> Iterator[Row]:
    for load in LOADS:
        case = f"pulled coil FR²/EI={load} rise/L"
        yield from convergence(
            f"{case}, uncorrected",
            theory(load),
            lambda n, f=load: rise(f, n, correct_resolution=False),
            (12, 24, 48),
            5e-3,
            unit="vertices a turn",
        )
        for per_turn, tolerance in ((8, 2e-2), (12, 1e-2)):
            got = rise(load, per_turn, correct_resolution=True)
            yield Row(f"{case}, corrected, {per_turn} vertices a turn", theory(load), got, tolerance)


CASE = Case("pulled-coil", "A coil pulled along its axis lengthens as Love's exact solution does", run)
