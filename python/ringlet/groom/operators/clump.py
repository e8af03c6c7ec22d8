"""Locks that lie together."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import Field
from scipy.spatial import KDTree

from ringlet.curves import Curves
from ringlet.groom.operators.operator import Context, Operator, grid, with_grid
from ringlet.groom.settings import Quantity, Ramped


class Clump(Operator):
    """Draws neighbouring locks towards one of them: ``p' = p + amount · ramp(u) · (centre(u) - p)``. The centres are
    the locks nearest to places spread over the scalp at distance ``size``."""

    op: Literal["clump"] = "clump"
    size: Annotated[float, Quantity("m", 1e-3, 1.0)] = Field(default=0.02, description="distance of the clumps")
    amount: Annotated[Ramped, Quantity("", 0.0, 1.0)] = Field(
        default=Ramped(value=0.4, vary=0.5, ramp=[(0, 0), (1, 1)]), description="0 apart, 1 all at the centre"
    )

    def apply(self, curves: Curves, context: Context) -> Curves:
        """The same shapes, drawn together; roots stay."""
        points, scalp = grid(curves), context.scalp
        _, triangle, barycentric = scalp.sample(scalp.count_for_spacing(self.size), context.seed + 1)
        _, leaders = KDTree(points[:, 0]).query(scalp.positions(triangle, barycentric))
        leaders = np.unique(leaders)
        _, nearest = KDTree(points[leaders, 0]).query(points[:, 0])
        amount = context.values("amount", self.amount, curves)[:, None] * self.amount.along(
            np.linspace(0, 1, points.shape[1])
        )
        amount = np.minimum(amount, 1.0)
        return with_grid(curves, points + amount[:, :, None] * (points[leaders[nearest]] - points))
