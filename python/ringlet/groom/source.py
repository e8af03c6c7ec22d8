"""The space of files that do not say it themselves."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from ringlet.data.quantities import UNITS, Section
from ringlet.data.stage import StageSpace


class Source(Section):
    """Unit and axis of an OBJ or .hair file. A USD file says its own."""

    unit: Literal["m", "cm", "mm", "in"] = Field(default="m", description="unit of an OBJ or .hair file")
    up: Literal["Y", "Z"] = Field(default="Y", description="axis that is up in an OBJ or .hair file")

    @property
    def space(self) -> StageSpace:
        """The space that such a file is in."""
        return StageSpace(UNITS[self.unit], self.up)
