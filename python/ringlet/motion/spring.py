"""A coil as a helical spring: the column on its axis that resists stretch, bend and twist as the wire does."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class HelicalSpring:
    """Coils of any number of turns, shapes (count,) or numbers; docs/theory/hanging_coil.md.

    radius: R, of the coil [m]; 0 for a straight wire
    rise:   sin α, length of the axis by that of the wire
    bend:   EI of the wire [N m²]
    twist:  GJ of the wire [N m²]
    pull:   EA of the wire [N]
    """

    radius: Array | float
    rise: Array | float
    bend: Array | float
    twist: Array | float
    pull: Array | float = np.inf

    @property
    def _cosine2(self) -> Array | float:
        return 1.0 - self.rise**2

    @property
    def flexibility(self) -> Array | float:
        """Lengthening by force and length of the wire [1/N] (Love 1927, art. 271)."""
        return self.radius**2 * (self._cosine2 / self.twist + self.rise**2 / self.bend)

    @property
    def axial_stretch(self) -> Array | float:
        """Force by strain of the axis [N]: the coil opens, and the wire gets longer."""
        return 1.0 / (self.flexibility / self.rise + self.rise / self.pull)

    @property
    def axial_bend(self) -> Array | float:
        """Moment by curvature of the axis [N m²] (Timoshenko 1956)."""
        return 2.0 * self.rise / (self._cosine2 / self.twist + (1.0 + self.rise**2) / self.bend)

    @property
    def axial_twist(self) -> Array | float:
        """Moment about the axis by twist of it [N m²] (Love 1927, art. 271)."""
        return self.rise / (self._cosine2 / self.bend + self.rise**2 / self.twist)
