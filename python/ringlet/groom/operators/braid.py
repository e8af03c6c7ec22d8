"""Braids of several strands."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity
from ringlet.groom import weave
from ringlet.groom.operators.operator import Context
from ringlet.groom.operators.woven import Woven


class Braid(Woven):
    """Braids the strands of each section. Three strands follow ``x = a sin φ, z = b sin 2φ``, a third of a turn apart;
    ``under`` weaves the other way, as a Dutch braid does, ``rope`` twists the strands about one another, and a
    ``fishtail`` takes the outermost strand of each side in front of all to the other."""

    op: Literal["braid"] = "braid"
    pattern: Literal["over", "under", "fishtail", "rope"] = Field(default="over", description="how strands cross")
    flatness: Annotated[float, Quantity("", 0.0, 0.9)] = Field(
        default=0.33, description="0: as deep as wide; larger: flatter"
    )

    @property
    def weaving(self) -> weave.Pattern:
        """The pattern."""
        return self.pattern

    def depths(self, width: NDArray, leaders: Curves, context: Context) -> NDArray[np.float64]:
        """A rope is round, another braid as flat as it is set to be."""
        return width * (1.0 if self.pattern == "rope" else 1.0 - self.flatness)

    def pitch_of(self, width: NDArray) -> NDArray[np.float64]:
        """Two and a half widths."""
        return 2.5 * width
