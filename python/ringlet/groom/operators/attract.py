"""Attraction of locks to helper curves."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from scipy.spatial import KDTree

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Ramped
from ringlet.groom.helpers import Names
from ringlet.groom.operators.operator import Context, packed
from ringlet.groom.operators.shape import Shape


class Attract(Shape):
    """Attracts each lock to the helper curve with the nearest root:
    ``p' = p + amount · ramp(u) · falloff · (curve(u) - p)``. The falloff goes from 1 at the root of
    the curve to 0 at the distance ``falloff`` from it."""

    op: Literal["attract"] = "attract"
    curve: Names = Field(description="names of helper curves, from `[curves]`")
    amount: Annotated[Ramped, Quantity("", 0.0, 1.0, product=False)] = Field(
        default=Ramped(value=0.5, ramp=[(0, 0), (1, 1)]), description="0 keeps the shape, 1 moves it onto the curve"
    )
    falloff: Annotated[float | None, Quantity("m", 1e-4, 10.0)] = Field(
        default=None,
        description="distance from the root of the curve beyond which locks stay; all are attracted when absent",
    )

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the locks moved towards the curves; roots stay."""
        count = points.shape[1]
        helper = context.helper(self.curve, "curve")
        lines = _core.resample_curves(*packed(helper), count).reshape(len(helper), count, 3)
        distance, nearest = KDTree(lines[:, 0]).query(points[:, 0])
        t = np.ones(len(points)) if self.falloff is None else np.clip(1.0 - distance / self.falloff, 0.0, 1.0)
        amount = context.values(self, "amount", curves) * t * t * (3.0 - 2.0 * t)
        amount = np.minimum(amount[:, None] * self.amount.along(np.linspace(0.0, 1.0, count)), 1.0)
        amount[:, 0] = 0.0
        return points + amount[:, :, None] * (lines[nearest] - points)
