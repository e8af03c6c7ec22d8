"""Resampling of shapes."""

from __future__ import annotations

from typing import Literal

import numpy as np
from pydantic import Field

from ringlet import _core
from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.groom.operators.operator import Context, Operator, packed


class Resample(Operator):
    """Resamples shapes evenly along the Catmull-Rom spline through their points."""

    op: Literal["resample"] = "resample"
    points: int = Field(default=32, ge=3, le=10_000, description="points of a shape")

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the shapes with ``points`` points each."""
        points = _core.resample_curves(*packed(curves), self.points)
        offsets = offsets_from_counts(np.full(len(curves), self.points))
        return Curves(points, offsets, curves.ids, curves.curve)
