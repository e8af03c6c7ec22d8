"""Straightening of locks."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Ramped
from ringlet.groom.operators.operator import Context, along_edges, between_edges, unit
from ringlet.groom.operators.shape import Shape


class Straighten(Shape):
    """Rotates each edge of a lock towards the direction from its root to its tip:
    ``edge' = |edge| · unit((1 - amount · ramp) · unit(edge) + amount · ramp · unit(tip - root))``."""

    op: Literal["straighten"] = "straighten"
    amount: Annotated[Ramped, Quantity("", 0.0, 1.0, product=False)] = Field(
        default=Ramped(value=1.0), description="0 keeps the shape, 1 makes it straight"
    )

    turns: ClassVar[bool] = True

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the straightened shapes; edge lengths stay."""
        edges = np.diff(points, axis=1)
        amount = context.values(self, "amount", curves)[:, None] * self.amount.along(between_edges(edges))
        amount = np.clip(amount, 0.0, 1.0)[:, :, None]
        straight = unit(points[:, -1] - points[:, 0])[:, None, :]
        length = np.linalg.norm(edges, axis=2, keepdims=True)
        return along_edges(points[:, 0], length * unit((1.0 - amount) * unit(edges) + amount * straight))
