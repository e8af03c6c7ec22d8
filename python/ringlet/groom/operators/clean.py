"""Removal of locks from the head."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity
from ringlet.groom.operators.operator import Context, Operator, packed


class Clean(Operator):
    """Moves points below the skin, or closer to it than ``margin``, out along the surface normal. The margin grows from
    0 at the root. A lock that heads straight into the skin is laid along it. Locks keep their lengths."""

    margin: Annotated[float, Quantity("m", 0.0, 0.1)] = Field(
        default=0.002, description="distance that locks keep from the skin"
    )

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the curves outside the mesh."""
        return curves.with_points(_core.push_out(*packed(curves), context.scalp.solid, self.margin))
