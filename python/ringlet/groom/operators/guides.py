"""The base of guide operators: mirroring, and resampling by length."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from pydantic import Field

from ringlet import _core
from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.quantities import Quantity
from ringlet.groom.operators.mirror import Mirror
from ringlet.groom.operators.operator import Context, Operator, packed


class Guides(Operator):
    """Makes guides, mirrors them and resamples them."""

    mirror: Mirror | None = Field(default=None, description="mirrors the guides of one side to the other")
    segment: Annotated[float | None, Quantity("m", 1e-4, 1.0)] = Field(
        default=None, description="distance between the points of a guide, so that longer guides have more points"
    )

    def make(self, curves: Curves, context: Context) -> Curves:
        """Returns guides that are bound to the scalp."""
        raise NotImplementedError

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the guides with their mirror images, resampled to edges of length ``segment``."""
        guides = self.make(curves, context)
        if self.mirror is not None:
            guides = self.mirror.both_sides(guides, context)
        return guides if self.segment is None else by_length(guides, self.segment)


def by_length(curves: Curves, segment: float) -> Curves:
    """Resamples curves on their cubic splines to equal edges of about the length ``segment`` [m]."""
    counts = np.maximum(2, np.round(curves.lengths() / segment).astype(int) + 1)
    offsets = offsets_from_counts(counts)
    points = np.empty((offsets[-1], 3))
    for count in np.unique(counts):
        chosen = np.flatnonzero(counts == count)
        rows = offsets[chosen][:, None] + np.arange(count)
        points[rows.ravel()] = _core.resample_curves(*packed(curves.take(chosen)), int(count))
    return Curves(points, offsets, curves.ids, curves.curve)
