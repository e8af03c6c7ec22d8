"""Motion of a shot's locks in words: what its steps show, what the locks do by themselves, what a simulation showed."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
NONE: Array = np.empty(0)


@dataclass
class Word:
    """A word of a group of locks; arrays have one value a lock, NaN where a lock has none, or are empty.

    unit:      Hz, s, or empty for a fraction
    asked:     by the shot
    shown:     at the steps of the shot
    by_itself: without the steps' own damping
    found:     in a simulation
    """

    group: str
    name: str
    unit: str
    asked: Array = field(default_factory=NONE.copy)
    shown: Array = field(default_factory=NONE.copy)
    by_itself: Array = field(default_factory=NONE.copy)
    found: Array = field(default_factory=NONE.copy)


@dataclass
class MotionWords:
    """The words of all groups of locks in a shot, and sentences about them."""

    words: list[Word]
    notes: list[str]
