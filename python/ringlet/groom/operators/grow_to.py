"""Growth up to a plane, a mesh or a drawn line: the outline of a cut, given as a shape."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Varied
from ringlet.groom.operators.operator import Context, arc_lengths, unit
from ringlet.groom.operators.target import ToTarget

SEARCHED = 96  # places beyond the tip
LAST = 0.25  # part of a lock that says where it grows on


class GrowTo(ToTarget):
    """Grows or cuts locks so that they end at a plane, a mesh or a drawn line. Beyond its tip a lock goes on straight,
    in the mean direction of its last quarter. Locks that do not reach the target within ``most`` stay."""

    op: Literal["grow_to"] = "grow_to"
    most: Annotated[Varied, Quantity("m", 1e-3, 10.0)] = Field(
        default=Varied(value=0.5), description="largest length that locks grow to"
    )

    def path(self, points: NDArray, curves: Curves, context: Context) -> tuple[NDArray, NDArray]:
        """The locks, each with a straight piece after its tip."""
        own = arc_lengths(points)
        more = np.maximum(self._values("most", curves, context) - own[:, -1], 0.0)
        last = points.shape[1] - 1 - max(1, round(LAST * (points.shape[1] - 1)))
        further = more[:, None] * np.linspace(0.0, 1.0, SEARCHED + 1)[1:]
        straight = points[:, -1:] + further[:, :, None] * unit(points[:, -1] - points[:, last])[:, None]
        return np.concatenate([points, straight], axis=1), np.concatenate([own, own[:, -1:] + further], axis=1)
