"""Twists of two or more strands."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Varied
from ringlet.groom import weave
from ringlet.groom.operators.operator import Context
from ringlet.groom.operators.woven import Woven


class Twist(Woven):
    """Twists the strands of each section about one another, as the yarns of a rope: two strands are half a turn
    apart."""

    op: Literal["twist"] = "twist"
    right_handed: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=1.0), description="fraction of the sections that are twisted right-handed"
    )

    @property
    def weaving(self) -> weave.Pattern:
        """A rope."""
        return "rope"

    def mirrored(self, leaders: Curves, context: Context) -> NDArray[np.bool_]:
        """The sections that are twisted left-handed."""
        return context.random("hand").uniform(leaders.ids) >= context.values(self, "right_handed", leaders)

    def depths(self, width: NDArray, leaders: Curves, context: Context) -> NDArray[np.float64]:
        """Round."""
        return width

    def pitch_of(self, width: NDArray) -> NDArray[np.float64]:
        """Two widths."""
        return 2.0 * width
