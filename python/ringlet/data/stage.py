"""The space of a file: inside, everything is metres and Y-up; files keep their own unit and axis."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class StageSpace:
    """Unit, up-axis and rate of the stage that a groom comes from; what Ringlet writes uses the same.

    meters_per_unit: length of one file unit [m]
    up_axis:         ``Y`` or ``Z``
    fps:             time codes per second
    """

    meters_per_unit: float = 1.0
    up_axis: Literal["Y", "Z"] = "Y"
    fps: float = 24.0
