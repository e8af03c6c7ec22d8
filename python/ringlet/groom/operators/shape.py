"""The base class of shape operators: a mask and a blend weight."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity
from ringlet.groom.mask import Mask
from ringlet.groom.operators.operator import Context, Operator, along_edges, grid, unit, with_grid
from ringlet.groom.worn import Worn


class Shape(Operator):
    """Changes the points of locks where its mask is not 0: ``p' = (1 - w) p + w shaped(p)`` with w = blend · mask.

    Operators that rotate locks (``turns``) are blended edge by edge, so that lengths are interpolated too.
    """

    mask: Annotated[Mask, Quantity("", 0.0, 1.0)] = Field(
        default=Mask(), description="where the operator acts: a number, or a table of a mask"
    )
    blend: Annotated[float, Quantity("", 0.0, 1.0)] = Field(
        default=1.0, description="mix of the locks before the operator, 0, and after it, 1"
    )

    turns: ClassVar[bool] = False

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the points at full weight, for points of shape (count, points, 3) [m]; roots stay."""
        raise NotImplementedError

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the curves with the new shape, weighted by mask and blend."""
        weight = self.weights(curves, context)
        return self.blended(curves, self.shape(grid(curves), curves, context), weight) if weight.any() else curves

    def worn(self, before: Curves, after: Curves, context: Context) -> Sequence[Worn]:
        """What the locks wear from here on, for the curves before and after this operator."""
        return ()

    def weights(self, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Weight w of each point, shape (count, points)."""
        where = f"{context.purpose}.mask"
        return self.blend * self.mask.weights(curves, context.scalp.mesh, context.random("mask"), where)

    def blended(self, curves: Curves, shaped: NDArray[np.floating], weight: NDArray[np.floating]) -> Curves:
        """Returns the curves with the new shape (count, points, 3), interpolated by weight."""
        points = grid(curves)
        affected: NDArray[np.bool_] = np.any(weight > 0.0, axis=1)
        if weight.min() < 1.0:
            mixed = (mix_edges if self.turns else mix_places)(points, shaped, weight)
            shaped = np.where(affected[:, None, None], mixed, points)
        return with_grid(curves, shaped)


class Displacement(Shape):
    """Displaces the points of locks: they become longer or, with ``keep = "length"``, their silhouette shorter."""

    keep: Literal["silhouette", "length"] = Field(
        default="silhouette",
        description="what is preserved: how far locks reach (silhouette), or the length of their edges",
    )

    def displaced(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the displaced points, for points of shape (count, points, 3) [m]; roots stay."""
        raise NotImplementedError

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the displaced shapes; roots stay."""
        displaced = self.displaced(points, curves, context)
        if self.keep == "silhouette":
            return displaced
        length = np.linalg.norm(np.diff(points, axis=1), axis=2, keepdims=True)
        return along_edges(points[:, 0], length * unit(np.diff(displaced, axis=1)))


def mix_places(a: NDArray, b: NDArray, weight: NDArray) -> NDArray[np.floating]:
    """Interpolates points a and b, shape (count, points, 3), with weights (count, points)."""
    return a + weight[:, :, None] * (b - a)


def mix_edges(a: NDArray, b: NDArray, weight: NDArray) -> NDArray[np.floating]:
    """Interpolates the directions and lengths of edges of a and b, from the roots of a; shape (count, points, 3)."""
    from_edges, to_edges = np.diff(a, axis=1), np.diff(b, axis=1)
    w = 0.5 * (weight[:, 1:] + weight[:, :-1])[:, :, None]
    from_length, to_length = (np.linalg.norm(edges, axis=2, keepdims=True) for edges in (from_edges, to_edges))
    direction = unit((1.0 - w) * unit(from_edges) + w * unit(to_edges))
    return along_edges(a[:, 0], ((1.0 - w) * from_length + w * to_length) * direction)
