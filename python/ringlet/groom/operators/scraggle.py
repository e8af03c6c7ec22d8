"""Hair that does not know quite where to go."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from ringlet.curves import Curves
from ringlet.groom.operators.operator import Context, Operator, arc_lengths, grid, with_grid
from ringlet.groom.settings import Quantity, Ramped


class Scraggle(Operator):
    """A slow random wander that grows towards the tip: ``p' = p + amount · ramp(u) · noise(s / size)``, with s the
    length from the root; the noise is a B-spline of normally distributed knots, of its own for each lock."""

    op: Literal["scraggle"] = "scraggle"
    amount: Annotated[Ramped, Quantity("m", 0.0, 1.0)] = Field(
        default=Ramped(value=0.005, ramp=[(0, 0), (1, 1)]), description="how far a lock wanders (deviation at the tip)"
    )
    size: Annotated[float, Quantity("m", 1e-3, 10.0)] = Field(
        default=0.03, description="length over which it changes its mind"
    )

    def apply(self, curves: Curves, context: Context) -> Curves:
        """The same shapes, less orderly; roots stay."""
        points = grid(curves)
        along = arc_lengths(points)
        count = points.shape[1]
        at = along / self.size
        knot_count = int(at.max()) + 4
        knots = context.random("wander").normals(curves.ids, 3 * knot_count).reshape(len(points), knot_count, 3)
        i = at.astype(int)
        t = (at - i)[:, :, None]
        rows = np.arange(len(points))[:, None]
        a, b, c, d = (knots[rows, i + k] for k in range(4))
        noise = (
            ((-t + 3.0) * t - 3.0) * t + 1.0,
            (3.0 * t - 6.0) * t * t + 4.0,
            ((-3.0 * t + 3.0) * t + 3.0) * t + 1.0,
            t**3,
        )
        wander = (
            noise[0] * a + noise[1] * b + noise[2] * c + noise[3] * d
        ) / 6.0  # a cubic B-spline: smooth in its curvature
        reach = context.values("amount", self.amount, curves)[:, None] * self.amount.along(np.linspace(0.0, 1.0, count))
        first = wander[:, :1]
        return with_grid(curves, points + 1.5 * reach[:, :, None] * (wander - first))
