"""Motion of hanging locks in the words of those who judge it: words from the material, and the material from words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet.motion.modes import Mode, Modes
from ringlet.motion.search import find_stiffness
from ringlet.motion.stepping import Stepping, damped_exponent, shown_by_itself

Array = NDArray[np.float64]
Wanted = Mapping[str, Array | float]  # words by name, for each lock or for all; of STIFFNESS one at most

STIFFNESS = {"bounce", "sag", "swing"}  # words that a lock shows by its stiffness

HALVINGS = 40


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

    def material(self, steps: Stepping, wanted: Wanted) -> tuple[Array, Array]:
        """Factors on the stiffness against bend and twist, and on the damping, with which the steps of a shot show
        some words; shapes (count,), NaN where none do.

        Where steps and air alone settle a bounce sooner, the damping is 0. The locks are to hang in the same shape
        however stiff they are, as with a rest shape of equilibrium; there is no ``sag`` then.
        """
        stiffer = np.ones(len(self.sag))
        if STIFFNESS & wanted.keys():
            logarithm, met = find_stiffness(
                lambda which, at: self.excess(steps, wanted, _of_all(which, np.exp(at)))[which], np.log(stiffer)
            )
            stiffer = np.where(met, np.exp(logarithm), np.nan)
        return stiffer, self.damping(steps, wanted, stiffer)

    def excess(self, steps: Stepping, wanted: Wanted, stiffer: Array | float = 1.0) -> Array:
        """By how much locks are too stiff for a word, shape (count,): it grows as the logarithm of stiffness at most.

        It is the logarithm of the square of their frequency relative to that of the word, or of the sag of the word
        relative to theirs. NaN where a lock does not stay in place, infinite where it does not sag.
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            if "sag" in wanted:
                return np.where(self.sag > 0.0, np.log(wanted["sag"]) - np.log(np.maximum(self.sag, 0.0)), np.inf)
            if "swing" in wanted:
                return 2.0 * np.log(self._shown(steps, self.modes.swing(stiffer)) / wanted["swing"])
            mode = self.modes.bounce(stiffer)
            if "settle" in wanted:
                exponent = steps.wanted(wanted["bounce"], wanted["settle"])
                return np.log((mode.elastic + mode.weight) / np.abs(exponent) ** 2)
            return 2.0 * np.log(self._shown(steps, mode) / wanted["bounce"])

    def damping(self, steps: Stepping, wanted: Wanted, stiffer: Array | float = 1.0) -> Array:
        """The factor on the damping of locks that are so many times stiffer, as in ``material``."""
        if "settle" not in wanted:
            return np.ones(len(self.sag))
        mode = self.modes.bounce(stiffer)
        if "bounce" not in wanted:
            return self._damped(steps, mode, wanted["settle"])
        return self._damping(mode, steps.wanted(wanted["bounce"], wanted["settle"]))

    def _damping(self, mode: Mode, wanted: NDArray[np.complex128]) -> Array:
        """The factor on the damping of a mode that has a wanted exponent [1/s]."""
        damping = (-2.0 * wanted.real - self.mass_damping - mode.drag).clip(0.0)
        return damping / _positive(mode.damping)

    def _shown(self, steps: Stepping, mode: Mode) -> Array:
        """The frequency that steps show, until it falls again as locks stiffen, from √½ of critical damping on."""
        too_stiff = mode.damping**2 > 2.0 * (mode.elastic + mode.weight)
        return np.where(too_stiff, np.inf, steps.shown(self._exponent(mode))[0])

    def _damped(self, steps: Stepping, mode: Mode, settle: Array | float) -> Array:
        """The factor on the damping, up to critical, with which the steps show a time to settle [s] of a mode."""
        stiffness = mode.elastic + mode.weight
        least, most = self.mass_damping + mode.drag, 2.0 * np.sqrt(stiffness)
        low, high = least, most
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            later = steps.shown(damped_exponent(stiffness, middle))[1] > settle
            low, high = np.where(later, middle, low), np.where(later, high, middle)
        return np.where(high < most, (low - least) / _positive(mode.damping), np.nan)

    def _exponent(self, mode: Mode) -> NDArray[np.complex128]:
        return damped_exponent(mode.elastic + mode.weight, mode.damping + mode.drag + self.mass_damping)


def _of_all(which: NDArray[np.bool_], values: Array) -> Array:
    """Factors of some locks among those of all."""
    factors = np.ones(len(which))
    factors[which] = values
    return factors


def _positive(values: Array) -> Array:
    """The same values, NaN where they are not positive."""
    return np.where(values > 0.0, values, np.nan)
