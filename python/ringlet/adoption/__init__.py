"""Finished hairs as a groom: clumps become locks, and curls become settings."""

from ringlet.adoption.clumps import Clumps, each_alone, find_clumps
from ringlet.adoption.coil import Coils, fit_coils

__all__ = ["Clumps", "Coils", "each_alone", "find_clumps", "fit_coils"]
