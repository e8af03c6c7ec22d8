"""Volume: lifts hair off the scalp and against gravity."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Ramped
from ringlet.groom.operators.operator import UP, Context, along_edges, between_edges, pulled, unit
from ringlet.groom.operators.shape import Shape


class Volume(Shape):
    """Rotates every edge of a lock towards a lifting direction and keeps its length:
    ``edge' = |edge| · unit(edge + amount · |edge| · (up · world up + (1 - up) · normal))``."""

    op: Literal["volume"] = "volume"
    amount: Annotated[Ramped, Quantity("", 0.0, 10.0)] = Field(
        default=Ramped(value=0.5), description="0 keeps the shape, 1 halves the angle; larger stands up more"
    )
    up: Annotated[float, Quantity("", 0.0, 1.0)] = Field(
        default=0.5, description="direction of the lift: 0 off the scalp, 1 against gravity"
    )

    turns: ClassVar[bool] = True

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the raised shapes; edge lengths stay."""
        edges = np.diff(points, axis=1)
        amount = context.values(self, "amount", curves)[:, None] * self.amount.along(between_edges(edges))
        target = unit(self.up * UP + (1.0 - self.up) * context.scalp.frames(curves)[:, :, 2])
        return along_edges(points[:, 0], pulled(edges, amount, target))
