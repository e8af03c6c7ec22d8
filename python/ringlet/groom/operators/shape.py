"""What shape operators have in common: a mask that says where they act, and a blend that says how much."""

from __future__ import annotations

from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity
from ringlet.groom.mask import Mask
from ringlet.groom.operators.operator import Context, Operator, along_edges, grid, unit, with_grid


class Shape(Operator):
    """Changes the points of locks where its mask is not 0: ``p' = (1 - w) p + w shaped(p)`` with w = blend · mask.

    Operators that turn locks (``turns``) are mixed edge by edge instead, so that lengths are mixed as well.
    """

    mask: Annotated[Mask, Quantity("", 0.0, 1.0)] = Field(default=Mask(), description="where it acts")
    blend: Annotated[float, Quantity("", 0.0, 1.0)] = Field(default=1.0, description="how much of it: 0 none, 1 all")

    turns: ClassVar[bool] = False

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Where the points (count, points, 3) [m] go when it acts fully; roots stay."""
        raise NotImplementedError

    def apply(self, curves: Curves, context: Context) -> Curves:
        """The same curves in their new shape, as far as mask and blend say."""
        where = f"{context.purpose}.mask"
        weight = self.blend * self.mask.weights(curves, context.scalp.mesh, context.random("mask"), where)
        touched: NDArray[np.bool_] = np.any(weight > 0.0, axis=1)
        if not touched.any():
            return curves
        points = grid(curves)
        shaped = self.shape(points, curves, context)
        if weight.min() < 1.0:
            mixed = (mix_edges if self.turns else mix_places)(points, shaped, weight)
            shaped = np.where(touched[:, None, None], mixed, points)
        return with_grid(curves, shaped)


def mix_places(a: NDArray, b: NDArray, weight: NDArray) -> NDArray[np.floating]:
    """Between points a and b, shape (count, points, 3), by weights (count, points)."""
    return a + weight[:, :, None] * (b - a)


def mix_edges(a: NDArray, b: NDArray, weight: NDArray) -> NDArray[np.floating]:
    """Curves from the roots of a, whose edges have directions and lengths between those of a and of b."""
    from_edges, to_edges = np.diff(a, axis=1), np.diff(b, axis=1)
    w = 0.5 * (weight[:, 1:] + weight[:, :-1])[:, :, None]
    from_length, to_length = (np.linalg.norm(edges, axis=2, keepdims=True) for edges in (from_edges, to_edges))
    direction = unit((1.0 - w) * unit(from_edges) + w * unit(to_edges))
    return along_edges(a[:, 0], ((1.0 - w) * from_length + w * to_length) * direction)
