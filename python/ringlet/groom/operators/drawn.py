"""Guides drawn by an artist, read from a file."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity
from ringlet.groom.operators.guides import Guides
from ringlet.groom.operators.operator import Context
from ringlet.groom.source import Source


class Drawn(Source, Guides):
    """Reads guides from a file and binds them to the scalp."""

    file: str = Field(
        min_length=1,
        description="USD, .abc, .obj, .hair or .tfx file with the curves, next to the recipe or with a full path",
    )
    prim: str | None = Field(default=None, description="prim of the curves; needed when the file has several")
    tolerance: Annotated[float, Quantity("m", 0.0, 1.0)] = Field(
        default=0.01, description="largest distance of a root from the scalp"
    )

    residual: Annotated[float, Quantity("", 0.0, 1.0)] = Field(
        default=1.0, description="of adopted guides, the fraction kept of what their fitted curl does not explain"
    )

    def make(self, curves: Curves, context: Context) -> Curves:
        """Returns the drawn curves without coincident points, each bound to the nearest point of the scalp region."""
        return context.scalp.bind(curves.check("guides").distinct(), self.tolerance, "guides")
