"""Finished hairs as a groom: clumps become locks, and curls become settings."""

from ringlet.adoption.clumps import Clumps, find_clumps
from ringlet.adoption.coil import Coils, fit_coils

__all__ = ["Clumps", "Coils", "find_clumps", "fit_coils"]
