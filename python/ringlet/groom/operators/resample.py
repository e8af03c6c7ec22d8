"""Resampling of shapes."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.groom.operators.operator import Context, Operator, resampled


class Resample(Operator):
    """Resamples shapes evenly along the cubic spline through their points."""

    op: Literal["resample"] = "resample"
    points: int = Field(default=32, ge=3, le=10_000, description="points of a shape")

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the shapes with ``points`` points each."""
        return resampled(curves, self.points)
