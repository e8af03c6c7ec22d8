"""Part lines: hair turns away to both sides of a plane or of drawn curves."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, Field, FiniteFloat

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Section, refuse
from ringlet.groom.helpers import Names

LENGTHS = (1e-6, 1e6)  # of a vector that gives a direction

# Curve attribute of locks: vector across the part line from the root to it [m], shape (count, 3).
TO_PART = "to_part"

Component = Annotated[FiniteFloat, Field(ge=-1000, le=1000)]
Vector = tuple[Component, Component, Component]


def _points_somewhere(vector: tuple[float, float, float]) -> tuple[float, float, float]:
    if not LENGTHS[0] <= math.hypot(*vector) <= LENGTHS[1]:
        raise refuse(
            f"is {list(vector)}, which points nowhere; must have a length from {LENGTHS[0]:g} to {LENGTHS[1]:g}"
        )
    return vector


Direction = Annotated[Vector, AfterValidator(_points_somewhere)]


class PartLine(Section):
    """A part line: hair on each side of a plane, or of drawn curves, turns away from it."""

    curve: Names | None = Field(
        default=None, description="names of helper curves along the part line, from `[curves]`; a plane when absent"
    )
    across: Direction = Field(default=(1.0, 0.0, 0.0), description="direction from one side of the plane to the other")
    offset: Annotated[float, Quantity("m", -1.0, 1.0)] = Field(
        default=0.0,
        description="distance of the plane from the middle of the scalp along 'across', by default to the left of a "
        "head that faces +z",
    )
    falloff: Annotated[float, Quantity("m", 1e-3, 1.0)] = Field(
        default=0.04, description="distance from the part line at which the effect is half of that on it"
    )

    def away(
        self, places: NDArray, normals: NDArray, middle: NDArray, helper: Callable[[Names, str], Curves]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Unit directions away from it, shape (n, 3), and its falloff with distance from 1 to 0, shape (n,).

        places, normals: positions [m] and normals of the roots, shape (n, 3)
        middle:          centre of the scalp [m]
        helper:          returns the helper curves of a name for a setting
        """
        across, off, distance = self.sides(places, normals, middle, helper)
        return np.sign(off)[:, None] * across, 0.5 ** (distance / self.falloff)

    def sides(
        self, places: NDArray, normals: NDArray, middle: NDArray, helper: Callable[[Names, str], Curves]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Unit directions across it, shape (n, 3), how far places are off it along them [m], which is negative on one
        side, and their distances from it [m], shape (n,)."""
        if self.curve is None:
            across = np.array(self.across) / max(float(np.linalg.norm(self.across)), 1e-12)
            off = (places - middle) @ across - self.offset
            return np.broadcast_to(across, places.shape), off, np.abs(off)
        foot, along = _nearest(places, helper(self.curve, "curve"))
        across = np.cross(along, normals)
        across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-12)
        return across, np.sum((places - foot) * across, axis=1), np.linalg.norm(places - foot, axis=1)


def on_side(offsets: NDArray, to_part: NDArray) -> NDArray[np.bool_]:
    """Whether places are on their lock's side of the part line, for offsets from its root and its ``TO_PART`` (..., 3)
    [m]."""
    return np.asarray(np.sum(offsets * to_part, axis=-1) < np.sum(to_part * to_part, axis=-1))


def _nearest(places: NDArray, lines: Curves) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Closest point on polylines to each place [m], and the unit tangent there; shape (n, 3) each."""
    within = np.ones(len(lines.points), bool)
    within[lines.offsets[1:] - 1] = False
    start = np.flatnonzero(within)
    begin = np.asarray(lines.points[start], np.float64)
    edge = lines.points[start + 1] - begin
    length2 = np.maximum(np.sum(edge * edge, axis=1), 1e-18)
    t = np.clip(np.einsum("nex,ex->ne", places[:, None] - begin, edge) / length2, 0.0, 1.0)
    feet = begin + t[:, :, None] * edge
    nearest = np.sum((places[:, None] - feet) ** 2, axis=2).argmin(axis=1)
    foot = feet[np.arange(len(places)), nearest]
    return foot, edge[nearest] / np.sqrt(length2[nearest])[:, None]
