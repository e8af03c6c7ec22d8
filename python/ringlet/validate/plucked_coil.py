"""Free decay of a coil plucked in its lowest mode, by damping and the integrator, without gravity.

A mode of frequency ω under damping β follows e^{μt} with μ² + βω²μ + ω² = 0. A step h of the integrator multiplies it
by z: 1/z = 1 − hμ (backward Euler) or 1/z = 2 − √(1 + 2hμ) (BDF-2). The expected decay per step is |z|. The error
against e^{μt} is of first order in h for backward Euler and of second order for BDF-2.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.optimize import curve_fit

from ringlet.motion import Integrator, Stepping
from ringlet.shot.solver import Solver
from ringlet.sim.strands import Strands
from ringlet.validate.case import Case, Row
from ringlet.validate.rods import masses, rod_material, strand

RADIUS, PITCH, PER_TURN, VERTICES, PRESCRIBED = 5e-3, 5e-3, 12, 36, 3

Series = NDArray[np.float64]


def coil(damping: float) -> Strands:
    """Three turns that hang from their clamped top; damping β [s]."""
    turn = 2 * np.pi * np.arange(VERTICES) / PER_TURN
    points = np.c_[RADIUS * np.cos(turn), -PITCH * turn / (2 * np.pi), RADIUS * np.sin(turn)]
    material = rod_material(correct_resolution=False).model_copy(update={"damping": damping})
    return strand(points, material, PRESCRIBED)


@cache
def lowest_mode() -> tuple[float, Series, Series]:
    """Angular frequency [1/s], shape and masses [kg] of the lowest mode, one row per coordinate of free vertices."""
    rod = coil(0.0)
    rest, h = rod.curves.points, 1e-6 * RADIUS
    columns = []
    for coordinate in range(3 * PRESCRIBED, rest.size):
        step = np.zeros(rest.size)
        step[coordinate] = h
        up, down = (rod.energy(rest + sign * step.reshape(rest.shape))[1][PRESCRIBED:].ravel() for sign in (1, -1))
        columns.append((up - down) / (2 * h))
    stiffness, mass = np.array(columns), np.repeat(masses(rod)[PRESCRIBED:], 3)
    squares, shapes = eigh(0.5 * (stiffness + stiffness.T), np.diag(mass))
    return float(np.sqrt(squares[0])), shapes[:, 0], mass


def exponent(damping: float) -> complex:
    """Complex exponent μ of the mode under damping β [s], in 1/s."""
    omega = lowest_mode()[0]
    rate = 0.5 * damping * omega**2
    return complex(-rate, np.sqrt(omega**2 - rate**2))


def factor(integrator: Integrator, damping: float, dt: float) -> complex:
    """Amplification factor z of the mode in a step of the integrator."""
    return complex(Stepping(dt, integrator).multiplier(exponent(damping)))


def ring(integrator: Integrator, damping: float, steps_per_period: int, periods: int) -> tuple[Series, Series]:
    """Times [s] since the release, and amplitudes of the mode relative to the initial one."""
    omega, shape, mass = lowest_mode()
    rod = coil(damping)
    rest = rod.curves.points
    pluck = 1e-4 * RADIUS / abs(shape).max()
    start = rest.copy()
    start[PRESCRIBED:] += pluck * shape.reshape(-1, 3)
    rod.place(start)
    dt = 2 * np.pi / omega / steps_per_period
    solver = Solver(integrator=integrator, tolerance=1e-12)
    amplitudes = [1.0]
    for _ in range(periods * steps_per_period):
        rod.step(rest, dt, solver=solver)
        amplitudes.append(float(shape @ (mass * (rod.positions - rest)[PRESCRIBED:].ravel())) / pluck)
    return dt * np.arange(len(amplitudes), dtype=np.float64), np.array(amplitudes)


def error(integrator: Integrator, damping: float, steps_per_period: int) -> float:
    """Largest deviation from the damped rod in the first period, relative to the initial amplitude."""
    times, amplitudes = ring(integrator, damping, steps_per_period, 1)
    mu = exponent(damping)
    exact = np.exp(mu.real * times) * (np.cos(mu.imag * times) - mu.real / mu.imag * np.sin(mu.imag * times))
    return float(abs(amplitudes - exact).max())


def decay(integrator: Integrator, damping: float, steps_per_period: int) -> float:
    """Logarithmic decrement per step, fitted to three periods without the first steps."""
    times, amplitudes = (values[8:] for values in ring(integrator, damping, steps_per_period, 3))
    dt = times[1] - times[0]

    def damped(t: Series, amplitude: float, rate: float, omega: float, phase: float) -> Series:
        return amplitude * np.exp(-rate * t) * np.cos(omega * t + phase)

    z = factor(integrator, damping, dt)
    guess = (1.0, -np.log(abs(z)) / dt, np.angle(z) / dt, 0.0)
    (_, rate, _, _), _ = curve_fit(damped, times, amplitudes, guess)
    return float(rate * dt)


def run() -> Iterator[Row]:
    omega = lowest_mode()[0]
    orders: dict[Integrator, int] = {"backward_euler": 1, "bdf2": 2}
    for integrator, order in orders.items():
        for ratio in (0.0, 0.02, 0.1):  # damping ratio: β = 2 ratio / ω
            damping = 2 * ratio / omega
            expected = float(-np.log(abs(factor(integrator, damping, 2 * np.pi / omega / 40))))
            name = f"plucked coil, {integrator}, {ratio:g} of critical damping"
            yield Row(f"{name}, decay a step at 40 steps a period", expected, decay(integrator, damping, 40), 2e-4)
            coarse, fine = error(integrator, damping, 200), error(integrator, damping, 400)
            yield Row(f"{name}, order in time", order, float(np.log2(coarse / fine)), 0.05)


CASE = Case("plucked-coil", "A plucked coil rings down as its damping and the integrator have it", run)
