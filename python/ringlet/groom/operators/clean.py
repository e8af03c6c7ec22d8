"""Locks outside the head."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity
from ringlet.groom.operators.operator import Context, Operator, packed


class Clean(Operator):
    """Moves what dips under the skin, or comes nearer than ``margin``, out along the surface's normal; at the root the
    margin begins at 0."""

    margin: Annotated[float, Quantity("m", 0.0, 0.1)] = Field(
        default=0.002, description="distance that locks keep from the skin"
    )

    def apply(self, curves: Curves, context: Context) -> Curves:
        """The same curves, outside of the mesh."""
        return curves.with_points(_core.push_out(*packed(curves), context.scalp.solid, self.margin))
