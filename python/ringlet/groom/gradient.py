"""Gradients: maps that are computed from where roots are, by height or by distance from a line or from the border."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator
from scipy.spatial import KDTree

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Ramp, Section, along, refuse
from ringlet.groom.hairline import BORDER_SPACING, border_points
from ringlet.groom.helpers import Names
from ringlet.groom.operators.operator import evenly, unit
from ringlet.groom.part_line import Direction
from ringlet.groom.scalp import Scalp

Field3 = Callable[[NDArray[np.float64]], NDArray[np.float64]]  # values (n,) at places (n, 3) [m]


class Gradient(Section):
    """A map by the place of the root: a ramp over its height, or over its distance from drawn lines or from the border
    of the scalp. Whatever takes a `map` takes it by name, at any resolution of the mesh."""

    toward: Direction | None = Field(
        default=None, description="direction in which the height above the middle of the scalp is measured, Y up"
    )
    curve: Names | None = Field(
        default=None, description="names of helper curves, from `[curves]`, whose distance counts in place of a height"
    )
    border: bool = Field(
        default=False, description="whether the distance from the border of the scalp counts in place of a height"
    )
    start: Annotated[float, Quantity("m", -10.0, 10.0)] = Field(
        default=0.0, description="height or distance at which the ramp begins"
    )
    end: Annotated[float, Quantity("m", -10.0, 10.0)] = Field(description="height or distance at which it ends")
    ramp: Ramp = Field(default=[(0.0, 0.0), (1.0, 1.0)], description="[place, value] from the start (0) to the end (1)")

    @model_validator(mode="after")
    def _one_distance(self) -> Gradient:
        if (self.toward is not None) + (self.curve is not None) + self.border != 1:
            raise refuse("needs one of 'toward', 'curve' and 'border = true'; it says from where distances count")
        if self.start == self.end:
            raise refuse("has the same start and end; set the distances between which it changes")
        return self

    def of(self, scalp: Scalp, helper: Callable[[Names, str], Curves]) -> Field3:
        """Its values at places of a scalp.

        helper: returns the helper curves of a name for a setting
        """
        distance = self._distance(scalp, helper)
        return lambda places: along(self.ramp, (distance(places) - self.start) / (self.end - self.start))

    def _distance(self, scalp: Scalp, helper: Callable[[Names, str], Curves]) -> Field3:
        """Heights or distances of places [m]."""
        if self.toward is not None:
            toward, middle = unit(np.array(self.toward)), scalp.middle
            return lambda places: (places - middle) @ toward
        lines = border_points(scalp) if self.border else _points(helper(self.curve or [], "curve"))
        if not len(lines):
            return lambda places: np.full(len(places), np.inf)
        tree = KDTree(lines)
        return lambda places: np.asarray(tree.query(places)[0], np.float64)


def _points(curves: Curves) -> NDArray[np.float64]:
    """Points along curves, about as close as those of a border [m], shape (n, 3)."""
    lengths = curves.lengths()
    return np.concatenate(
        [evenly(curves[k], max(2, int(np.ceil(lengths[k] / BORDER_SPACING)))) for k in range(len(curves))]
    )
