"""Phase locking of neighbouring curls."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Section, Varied
from ringlet.groom.groups import Apart, leaders
from ringlet.groom.operators.operator import Context


class PhaseGroups(Section):
    """Groups of neighbouring curls in phase: from the root on, phase and width of a lock blend into those of the
    central lock of its group."""

    size: Annotated[float, Quantity("m", 1e-3, 1.0)] = Field(default=0.01, description="distance between groups")
    amount: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=1.0), description="how far phase and width agree within a group: 0 not, 1 wholly"
    )
    length: Annotated[Varied, Quantity("m", 0.0, 10.0)] = Field(
        default=Varied(value=0.03), description="length from the root over which they come to agree"
    )
    cohesion: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.3),
        description="how far the centre lines of a group are drawn together: 0 not, 1 into one",
    )
    apart: Apart = 60.0

    def values(self, curves: Curves, context: Context) -> dict[str, NDArray]:
        """Leader and blend settings of each lock, as arguments of the core; each of shape (count,)."""
        shapes = curves.points.reshape(len(curves), -1, 3)
        leader = leaders(shapes, self.size, self.apart, context.scalp, context.seed + 2, "phase_groups.size")
        return {
            "leader": leader.astype(np.int32),
            "join": np.minimum(context.values(self, "amount", curves, "phase_groups."), 1.0),
            "join_over": context.values(self, "length", curves, "phase_groups."),
            "cohesion": np.minimum(context.values(self, "cohesion", curves, "phase_groups."), 1.0),
        }
