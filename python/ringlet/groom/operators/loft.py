"""Volume: hair raised off the scalp and against gravity."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from ringlet.curves import Curves
from ringlet.groom.operators.operator import UP, Context, Operator, grid, unit, with_grid
from ringlet.groom.settings import Quantity, Ramped


class Loft(Operator):
    """Turns every piece of a lock towards a lifting direction and keeps its length:
    ``edge' = |edge| · unit(edge + amount · |edge| · (up · world up + (1 - up) · normal))``."""

    op: Literal["loft"] = "loft"
    amount: Annotated[Ramped, Quantity("", 0.0, 10.0)] = Field(
        default=Ramped(value=0.5), description="0 leaves the shape, 1 halves the angle"
    )
    up: Annotated[float, Quantity("", 0.0, 1.0)] = Field(
        default=0.5, description="0 lifts off the scalp, 1 against gravity"
    )

    def apply(self, curves: Curves, context: Context) -> Curves:
        """The same shapes, raised; lengths stay."""
        points = grid(curves)
        normal = context.scalp.frames(curves)[:, :, 2]
        edges = np.diff(points, axis=1)
        length = np.linalg.norm(edges, axis=2, keepdims=True)
        u = (np.arange(edges.shape[1]) + 0.5) / edges.shape[1]
        amount = context.values("amount", self.amount, curves)[:, None] * self.amount.along(u)
        target = unit(self.up * UP + (1.0 - self.up) * normal)[:, None, :]
        raised = length * unit(edges + amount[:, :, None] * length * target)
        return with_grid(curves, np.concatenate([points[:, :1], points[:, :1] + np.cumsum(raised, axis=1)], axis=1))
