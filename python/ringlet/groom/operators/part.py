"""Combing of locks away from a parting."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Ramped
from ringlet.groom.operators.operator import Context, along_edges, between_edges, pulled
from ringlet.groom.operators.shape import Shape
from ringlet.groom.parting import Parting


class Part(Shape):
    """Rotates every edge of a lock away from a parting and keeps its length:
    ``edge' = |edge| · unit(edge + amount · ramp(u) · falloff · |edge| · away)``. The falloff halves every ``reach``."""

    op: Literal["part"] = "part"
    parting: Parting = Field(default=Parting(), description="where it is")
    amount: Annotated[Ramped, Quantity("", 0.0, 10.0)] = Field(
        default=Ramped(value=1.0, ramp=[(0, 1), (1, 0.3)]), description="how much beside it: 0 leaves the shape"
    )

    turns: ClassVar[bool] = True

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the shapes combed to their sides; edge lengths stay."""
        edges = np.diff(points, axis=1)
        normal = context.scalp.frames(curves)[:, :, 2]
        away, falloff = self.parting.away(points[:, 0], normal, context.scalp.middle, context.helper)
        amount = falloff * context.values(self, "amount", curves)
        ramp = self.amount.along(between_edges(edges))
        return along_edges(points[:, 0], pulled(edges, amount[:, None] * ramp, away))
