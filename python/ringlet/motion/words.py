"""Motion of hanging locks in the words of those who judge it: words from the material, and the material from words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet.motion.modes import Mode, Modes
from ringlet.motion.stepping import Stepping, damped_exponent, shown_by_itself

Array = NDArray[np.float64]
Wanted = Array | float | None

SOFTEST, STIFFEST = 1e-4, 1e6  # factors on the stiffness between which words are sought
HALVINGS = 40
MET = 0.05  # deviation from a word that counts as met, relative to it


@dataclass
class Words:
    """What each lock shows, shapes (count,). NaN for a lock that is pinned, limp, or falls over.

    bounce: frequency along the lock, from root to tip [Hz]; 0 where it does not ring
    settle: time until a bounce has gone to a twentieth [s]
    sag:    how much longer the lock hangs along its coil than it is groomed, as a fraction
    swing:  frequency of the whole lock sideways [Hz]
    """

    bounce: Array
    settle: Array
    sag: Array
    swing: Array


@dataclass
class HangingLocks:
    """Locks that hang still, and how they move about that.

    sag:          as in ``Words``
    mass_damping: rate at which all velocities decay [1/s]
    """

    sag: Array
    modes: Modes
    mass_damping: float

    def words(self, steps: Stepping | None = None) -> Words:
        """What the steps of a shot show of the locks; None: what the locks do themselves."""
        bounce, swing = (self._exponent(mode) for mode in (self.modes.bounce(), self.modes.swing()))
        shown = steps.shown if steps else shown_by_itself
        return Words(*shown(bounce), self.sag, shown(swing)[0])

    def material(self, steps: Stepping, bounce: Wanted, settle: Wanted = None) -> tuple[Array, Array]:
        """Factors on the stiffness against bend and twist, and on the damping, with which the steps of a shot show a
        bounce [Hz] and a time to settle [s]; shapes (count,), NaN where none do.

        A word that is None leaves its factor at 1. Where steps and air alone settle a bounce sooner, the damping is 0.
        The locks are to hang in the same shape however stiff they are, as with a rest shape of equilibrium.
        """
        if bounce is None:
            return np.ones(len(self.sag)), self._damped(steps, settle)
        if settle is None:
            stiffer = self._stiffer(lambda mode: self._shown(steps, mode), bounce)
            return stiffer, np.ones_like(stiffer)
        wanted = steps.wanted(bounce, settle)
        stiffer = self._stiffer(lambda mode: np.sqrt(mode.elastic + mode.weight), np.abs(wanted))
        return stiffer, self._damping(self.modes.bounce(stiffer), wanted)

    def nearer_material(self, steps: Stepping, bounce: Wanted, settle: Wanted = None) -> tuple[Array, Array]:
        """The same factors where the shape in which locks hang depends on them: once the first is 1, both are found.

        In between it is one that brings the bounce nearer, as its square grows with the stiffness at most.
        """
        mode = self.modes.bounce()
        if bounce is None:
            return np.ones(len(self.sag)), self._damped(steps, settle)
        if settle is None:
            return (bounce / self._shown(steps, mode)) ** 2, np.ones(len(self.sag))
        wanted = steps.wanted(bounce, settle)
        return np.abs(wanted) ** 2 / (mode.elastic + mode.weight), self._damping(mode, wanted)

    def _damping(self, mode: Mode, wanted: NDArray[np.complex128]) -> Array:
        """The factor on the damping of a mode that has a wanted exponent [1/s]."""
        damping = (-2.0 * wanted.real - self.mass_damping - mode.drag).clip(0.0)
        return damping / _positive(mode.damping)

    def _shown(self, steps: Stepping, mode: Mode) -> Array:
        """The frequency that steps show, until it falls again as locks stiffen, from √½ of critical damping on."""
        too_stiff = mode.damping**2 > 2.0 * (mode.elastic + mode.weight)
        return np.where(too_stiff, np.inf, steps.shown(self._exponent(mode))[0])

    def _damped(self, steps: Stepping, settle: Wanted) -> Array:
        """The factor on the damping, up to critical, with which the steps show a time to settle [s]; 1 for None."""
        if settle is None:
            return np.ones(len(self.sag))
        mode = self.modes.bounce()
        stiffness = mode.elastic + mode.weight
        least, most = self.mass_damping + mode.drag, 2.0 * np.sqrt(stiffness)
        low, high = least, most
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            later = steps.shown(damped_exponent(stiffness, middle))[1] > settle
            low, high = np.where(later, middle, low), np.where(later, high, middle)
        return np.where(high < most, (low - least) / _positive(mode.damping), np.nan)

    def _stiffer(self, measure: Callable[[Mode], Array], wanted: Array | float) -> Array:
        """The factor on the stiffness at which a measure of the bounce, which grows with it, is nearest to one wanted.

        The measure jumps where the bounce passes from one of two modes to another.
        """
        bounds = [np.full(len(self.sag), np.log(bound)) for bound in (SOFTEST, STIFFEST)]
        for _ in range(HALVINGS):
            middle = 0.5 * (bounds[0] + bounds[1])
            below = ~(measure(self.modes.bounce(np.exp(middle))) >= wanted)  # too soft where it does not stay in place
            bounds = [np.where(below, middle, bounds[0]), np.where(below, bounds[1], middle)]
        found = np.exp(bounds)
        off = np.array([np.abs(measure(self.modes.bounce(each)) / wanted - 1.0) for each in found])
        return np.where(off.min(axis=0) <= MET, np.where(off[0] <= off[1], *found), np.nan)

    def _exponent(self, mode: Mode) -> NDArray[np.complex128]:
        return damped_exponent(mode.elastic + mode.weight, mode.damping + mode.drag + self.mass_damping)


def _positive(values: Array) -> Array:
    """The same values, NaN where they are not positive."""
    return np.where(values > 0.0, values, np.nan)
