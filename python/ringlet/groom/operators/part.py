"""Combing of locks away from a part line."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Ramped
from ringlet.groom.operators.operator import Context, along_edges, between_edges, pulled
from ringlet.groom.operators.shape import Shape
from ringlet.groom.part_line import PartLine


class Part(Shape):
    """Rotates every edge of a lock away from a part line and keeps its length:
    ``edge' = |edge| · unit(edge + amount · ramp(u) · falloff · |edge| · away)``. That falloff halves with every
    ``part_line.falloff`` of distance."""

    op: Literal["part"] = "part"
    part_line: PartLine = Field(default=PartLine(), description="where hair parts")
    amount: Annotated[Ramped, Quantity("", 0.0, 10.0)] = Field(
        default=Ramped(value=1.0, ramp=[(0, 1), (1, 0.3)]),
        description="strength at the part line: 0 keeps the shape, larger turns hair further to its side",
    )

    turns: ClassVar[bool] = True

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the shapes combed to their sides; edge lengths stay."""
        edges = np.diff(points, axis=1)
        normal = context.scalp.frames(curves)[:, :, 2]
        away, falloff = self.part_line.away(points[:, 0], normal, context.scalp.middle, context.helper)
        amount = falloff * context.values(self, "amount", curves)
        ramp = self.amount.along(between_edges(edges))
        return along_edges(points[:, 0], pulled(edges, amount[:, None] * ramp, away))
