"""Motion of hanging locks in the words of those who judge it: words from the material, and the material from words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ringlet.motion.coils import CoilLengths
from ringlet.motion.modes import Mode, Modes, modes_of
from ringlet.motion.stepping import Stepping, damped_exponent, shown_by_itself
from ringlet.sim.strands import Strands

Array = NDArray[np.float64]

STILL, STEPS = 1e-7, 40  # motion in a step of 1 s below which locks hang still [m], and the most steps
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

    @classmethod
    def of(cls, strands: Strands, groomed: NDArray[np.floating], gravity: tuple[float, float, float]) -> HangingLocks:
        """Lets strands hang from where they are until they are still.

        groomed: the groom [m], shape (n, 3)
        gravity: [m/s²]
        """
        strands.settle(gravity=gravity, tolerance=STILL, steps=STEPS)
        points, coils = strands.positions.copy(), CoilLengths(strands.curves.with_points(groomed))
        modes = modes_of(strands, points, gravity)
        return cls(coils.of(points) / coils.of(groomed) - 1.0, modes, strands.material.mass_damping)

    def words(self, steps: Stepping | None = None) -> Words:
        """What the steps of a shot show of the locks; None: what the locks do themselves."""
        bounce, swing = (self._exponent(mode) for mode in (self.modes.bounce(), self.modes.swing()))
        shown = steps.shown if steps else shown_by_itself
        return Words(*shown(bounce), self.sag, shown(swing)[0])

    def material(self, steps: Stepping, bounce: ArrayLike, settle: ArrayLike | None = None) -> tuple[Array, Array]:
        """How many times stiffer against bend and twist each lock is with which the steps show a bounce [Hz], and its
        damping time [s]; shapes (count,), NaN where there is none.

        settle: time until a bounce has gone to a twentieth [s]; None keeps the damping time, which is NaN then

        The locks are to hang in the same shape however stiff they are, as with a rest shape of equilibrium.
        """
        if settle is None:

            def shown(mode: Mode) -> Array:
                """The frequency, until it falls again as locks stiffen, from √½ of critical damping on."""
                too_stiff = mode.damping**2 > 2.0 * (mode.elastic + mode.weight)
                return np.where(too_stiff, np.inf, steps.shown(self._exponent(mode))[0])

            stiffer = self._stiffer(shown, np.asarray(bounce, np.float64))
            return stiffer, np.full_like(stiffer, np.nan)
        wanted = steps.wanted(bounce, settle)
        stiffer = self._stiffer(lambda mode: np.sqrt(mode.elastic + mode.weight), np.abs(wanted))
        mode = self.modes.bounce(stiffer)
        damping = (-2.0 * wanted.real - self.mass_damping - mode.drag) / mode.elastic
        met = damping >= 0.0
        return np.where(met, stiffer, np.nan), np.where(met, damping, np.nan)

    def _stiffer(self, measure: Callable[[Mode], Array], wanted: Array) -> Array:
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
