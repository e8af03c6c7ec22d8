"""What the steps of an integrator make of a motion: its frequency, and how soon it has settled.

A motion e^{μt} is multiplied by z in a step h: 1/z = 1 - hμ (backward Euler) or 1/z = 2 - √(1 + 2hμ) (BDF-2).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

Integrator = Literal["backward_euler", "bdf2"]
INTEGRATORS: tuple[Integrator, ...] = get_args(Integrator)
Array = NDArray[np.float64]

SETTLED = 0.05  # part of its amplitude at which a motion has settled
MOST_SUBSTEPS = 64  # that are advised
HALVINGS = 50


@dataclass(frozen=True)
class Stepping:
    """The steps of a shot.

    dt: length of a step [s]
    """

    dt: float
    integrator: Integrator = "backward_euler"

    def multiplier(self, exponent: ArrayLike) -> NDArray[np.complex128]:
        """z of a motion with the exponent μ [1/s]."""
        step = self.dt * np.asarray(exponent, np.complex128)
        with np.errstate(invalid="ignore"):  # NaN of locks without a motion
            inverse = 1.0 - step if self.integrator == "backward_euler" else 2.0 - np.sqrt(1.0 + 2.0 * step)
            return np.reciprocal(inverse, dtype=np.complex128)

    def exponent(self, multiplier: ArrayLike) -> NDArray[np.complex128]:
        """μ [1/s] of a motion that a step multiplies by z."""
        inverse = 1.0 / np.asarray(multiplier, np.complex128)
        step = 1.0 - inverse if self.integrator == "backward_euler" else 0.5 * ((2.0 - inverse) ** 2 - 1.0)
        return step / self.dt

    def shown(self, exponent: ArrayLike) -> tuple[Array, Array]:
        """Frequency [Hz] and time to settle [s] that the steps show of a motion; 0 Hz where it does not ring."""
        return shown_by_itself(np.log(self.multiplier(exponent)) / self.dt)

    def wanted(self, frequency: ArrayLike, settle: ArrayLike) -> NDArray[np.complex128]:
        """The exponent [1/s] of which the steps show a frequency [Hz] and a time to settle [s]."""
        log = np.log(SETTLED) / np.asarray(settle) + 2j * np.pi * np.asarray(frequency)
        return self.exponent(np.exp(self.dt * log))

    def longest(self, frequency: float) -> float:
        """The longest time to settle [s] at a frequency [Hz]: that of a motion without damping; 0 where none rings."""
        low, high = 1e-6 / self.dt, 1e6 / self.dt  # [1/s]
        for _ in range(HALVINGS):
            middle = np.sqrt(low * high)
            low, high = (middle, high) if self.shown(1j * middle)[0] < frequency else (low, middle)
        shown, settle = self.shown(1j * high)
        return float(settle) if abs(shown - frequency) <= 1e-3 * frequency else 0.0


def advised_steps(frequency: float, settle: float, fps: float) -> dict[Integrator, int]:
    """The fewest steps a frame at which a motion of a frequency [Hz] can take so long to settle [s], by integrator."""
    found: dict[Integrator, int] = {}
    for integrator in INTEGRATORS:
        for substeps in range(1, MOST_SUBSTEPS + 1):
            if Stepping(1.0 / (fps * substeps), integrator).longest(frequency) >= settle:
                found[integrator] = substeps
                break
    return found


def shown_by_itself(exponent: ArrayLike) -> tuple[Array, Array]:
    """Frequency [Hz] and time to settle [s] of a motion itself; 0 Hz where it does not ring."""
    exponent = np.asarray(exponent, np.complex128)
    with np.errstate(divide="ignore"):
        return np.abs(exponent.imag) / (2.0 * np.pi), np.log(SETTLED) / np.minimum(exponent.real, -0.0)


def damped_exponent(stiffness: Array, damping: Array) -> NDArray[np.complex128]:
    """The slower root of μ² + damping μ + stiffness = 0 [1/s], of [1/s] and [1/s²]."""
    root = np.sqrt((damping**2 - 4.0 * stiffness).astype(np.complex128))
    return (0.5 * (root - damping)).astype(np.complex128)
