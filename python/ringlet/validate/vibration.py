"""Vibration of a clamped–free rod at ω = (βL)² √(EI/λ) / L², without gravity.

Two measurements: the eigenvalues of stiffness and masses at rest, and the motion of a released rod.
A step of backward Euler with damping β multiplies a mode by z with z² (1 + βω²h + ω²h²) − z (2 + βω²h) + 1 = 0.
A mode therefore decays by 1/√(1 + βω²h + ω²h²) a step. Without damping it oscillates at atan(ωh)/h.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.optimize import curve_fit

from ringlet.shot.solver import Solver
from ringlet.sim.strands import Strands
from ringlet.validate.case import Case, Row, convergence
from ringlet.validate.rods import bending_stiffness, line_density, masses, rod_material, stiffness, straight_rod

LENGTH = 0.1  # [m]
BETA = (1.875104, 4.694091, 7.854757)  # βL, from cos βL cosh βL = −1


def theory(mode: int) -> float:
    """Theoretical angular frequency of a mode [1/s]."""
    material = rod_material()
    return BETA[mode] ** 2 * np.sqrt(bending_stiffness(material) / line_density(material)) / LENGTH**2


def modes(rod: Strands) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Squared frequencies ω² [1/s²] and mode shapes (columns; rows are free vertices) along y about the rest shape."""
    free = np.arange(2, len(rod.curves.points))
    return eigh(stiffness(rod, rod.curves.points, free, axis=1), np.diag(masses(rod)[free]))


def eigenfrequency(mode: int, edges: int) -> float:
    """Angular frequency of a mode of the discrete rod [1/s]."""
    squares, _ = modes(straight_rod(LENGTH, edges, rod_material()))
    return float(np.sqrt(squares[mode]))


def swing(edges: int, steps_per_period: int, damping: float = 0.0) -> tuple[float, float]:
    """Angular frequency [1/s] and amplitude ratio per step of a rod released in its first mode; damping β [s]."""
    rod = straight_rod(LENGTH, edges, rod_material().model_copy(update={"damping": damping}))
    rest = rod.curves.points
    shape = modes(rod)[1][:, 0]
    start = rest.copy()
    start[2:, 1] = 1e-4 * LENGTH * shape / abs(shape).max()
    rod.place(start)
    dt = 2 * np.pi / theory(0) / steps_per_period
    solver = Solver(newton=20, tolerance=1e-13)
    tip = []
    for _ in range(3 * steps_per_period):
        rod.step(rest, dt, solver=solver)
        tip.append(rod.positions[-1, 1])
    times = dt * np.arange(1, len(tip) + 1)

    def damped(t: np.ndarray, amplitude: float, rate: float, omega: float, phase: float) -> np.ndarray:
        return amplitude * np.exp(-rate * t) * np.cos(omega * t + phase)

    guess = (start[-1, 1], 0.5 * theory(0) ** 2 * (damping + dt), theory(0), 0.0)
    (_, rate, omega, _), _ = curve_fit(damped, times, tip, guess)
    return float(omega), float(np.exp(-rate * dt))


def run() -> Iterator[Row]:
    for mode in range(len(BETA)):
        yield from convergence(
            f"clamped–free mode {mode + 1} ω",
            theory(mode),
            lambda n, m=mode: eigenfrequency(m, n),
            (12, 25, 50),
            (2e-3, 4e-3, 8e-3)[mode],
        )
    steps, edges = 200, 50
    angle = 2 * np.pi / steps  # ωh
    omega, _ = swing(edges, steps)
    yield Row("released rod ω, 50 edges, 200 steps a period", theory(0) * np.arctan(angle) / angle, omega, 2e-3)
    for damping_ratio in (0.0, 0.02, 0.1):  # β = 2 damping_ratio / ω
        _, ratio = swing(edges, steps, 2 * damping_ratio / theory(0))
        decay = 0.5 * np.log(1 + 2 * damping_ratio * angle + angle**2)
        yield Row(f"released rod, decay a step at {damping_ratio:g} of critical damping", decay, -np.log(ratio), 2e-3)


CASE = Case("clamped-free", "A clamped rod vibrates at the frequencies of beam theory", run)
