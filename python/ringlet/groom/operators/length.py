"""Length of locks."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Varied
from ringlet.groom.operators.operator import Context, arc_lengths, on_splines
from ringlet.groom.operators.shape import Shape


class Length(Shape):
    """Multiplies the length, or sets it: ``p' = root + factor · (p - root)``. With ``cut``, locks are cut at the new
    length instead of scaled, and shorter ones stay."""

    op: Literal["length"] = "length"
    factor: Annotated[Varied, Quantity("", 0.01, 100.0)] = Field(
        default=Varied(value=1.0), description="factor on the length"
    )
    to: Annotated[Varied | None, Quantity("m", 1e-4, 10.0)] = Field(
        default=None, description="length that all locks get before the factor; their own when absent"
    )
    cut: bool = Field(default=False, description="cut longer locks, in place of scaling all")

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the scaled or cut shapes; roots stay."""
        along = arc_lengths(points)
        factor = context.values(self, "factor", curves)
        if self.to is not None:
            factor *= context.values(self, "to", curves) / np.maximum(along[:, -1], 1e-9)
        if not self.cut:
            return points[:, :1] + factor[:, None, None] * (points - points[:, :1])
        return on_splines(points, np.minimum(factor, 1.0)[:, None] * along)
