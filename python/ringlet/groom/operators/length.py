"""Longer or shorter locks."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from ringlet.curves import Curves
from ringlet.groom.operators.operator import Context, Operator, grid, with_grid
from ringlet.groom.settings import Quantity, Varied


class Length(Operator):
    """Multiplies the length: ``p' = root + factor · (p - root)``; with ``cut``, hair is cut off instead of shrunk."""

    op: Literal["length"] = "length"
    factor: Annotated[Varied, Quantity("", 0.01, 100.0)] = Field(
        default=Varied(value=1.0), description="factor on the length"
    )
    cut: bool = Field(default=False, description="cut what is too long; the rest keeps its place")

    def apply(self, curves: Curves, context: Context) -> Curves:
        """The same shapes, longer or shorter."""
        points = grid(curves)
        factor = context.values("factor", self.factor, curves)
        if not self.cut:
            return with_grid(curves, points[:, :1] + factor[:, None, None] * (points - points[:, :1]))
        last = points.shape[1] - 1
        at = np.minimum(factor, 1.0)[:, None] * np.arange(last + 1)
        i = np.minimum(at.astype(int), last - 1)
        t = (at - i)[:, :, None]
        rows = np.arange(len(points))[:, None]
        return with_grid(curves, (1.0 - t) * points[rows, i] + t * points[rows, i + 1])
