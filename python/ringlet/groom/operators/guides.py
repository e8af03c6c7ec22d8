"""What grown and drawn guides have in common: they can be mirrored, and resampled by their length."""

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

    mirror: Mirror | None = Field(default=None, description="the guides of one side on the other, too")
    segment: Annotated[float | None, Quantity("m", 1e-4, 1.0)] = Field(
        default=None, description="length of the pieces that guides are cut into: longer ones get more points"
    )

    def make(self, curves: Curves, context: Context) -> Curves:
        """Guides that are bound to the scalp."""
        raise NotImplementedError

    def apply(self, curves: Curves, context: Context) -> Curves:
        """The guides, with those on the other side, in pieces of ``segment``."""
        guides = self.make(curves, context)
        if self.mirror is not None:
            guides = self.mirror.both_sides(guides, context)
        return guides if self.segment is None else by_length(guides, self.segment)


def by_length(curves: Curves, segment: float) -> Curves:
    """The same curves in even pieces of about that length [m], on their Catmull-Rom splines."""
    counts = np.maximum(2, np.round(curves.lengths() / segment).astype(int) + 1)
    offsets = offsets_from_counts(counts)
    points = np.empty((offsets[-1], 3))
    for count in np.unique(counts):
        chosen = np.flatnonzero(counts == count)
        rows = offsets[chosen][:, None] + np.arange(count)
        points[rows.ravel()] = _core.resample_curves(*packed(curves.take(chosen)), int(count))
    return Curves(points, offsets, curves.ids, curves.curve)
