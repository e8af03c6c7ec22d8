"""Unit and up axis of files that do not store them."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from ringlet.data.lengths import UNITS
from ringlet.data.quantities import LengthUnit, Section
from ringlet.data.stage import StageSpace


class Source(Section):
    """Unit and up axis of another file than USD, which stores its own."""

    unit: LengthUnit = Field(default="m", description="unit of a file of another format than USD")
    up: Literal["Y", "Z"] = Field(default="Y", description="axis that is up in such a file")

    @property
    def space(self) -> StageSpace:
        """The coordinate space of such a file."""
        return StageSpace(UNITS[self.unit], self.up)
