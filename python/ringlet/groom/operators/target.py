"""The base class of operators that end locks at a target: a plane, a mesh or a drawn line."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator
from scipy.spatial import KDTree

from ringlet.data.curves import Curves
from ringlet.data.groom import SECTION
from ringlet.data.quantities import Quantity, Varied, refuse
from ringlet.groom.operators.operator import Context, arc_lengths, evenly, on_splines, unit
from ringlet.groom.operators.shape import Shape
from ringlet.groom.part_line import Direction

PLANE = 0.08  # default distance of the plane from the middle of the scalp [m]
LINE_POINTS = 2000  # of a drawn line
HALVINGS = 40  # of the piece of a lock that crosses the target

Distance = Callable[[NDArray], NDArray[np.float64]]  # beyond the target [m], shape (…), at places (…, 3)


class ToTarget(Shape):
    """Ends locks where they first cross a plane, a mesh or a drawn line. Locks that begin beyond it keep ``least``.

    A drawn line is a height along ``toward``: a lock ends where it passes the point of the line that is nearest to it,
    seen along ``toward``.
    """

    toward: Direction = Field(
        default=(0.0, -1.0, 0.0), description="direction in which locks cross the plane or the line, Y up"
    )
    line: str | None = Field(
        default=None, description="name of a helper curve, from `[curves]`, at which locks end in place of a plane"
    )
    mesh: str | None = Field(
        default=None, description="name of a closed mesh, from `[meshes]`, at which locks end in place of a plane"
    )
    at: Annotated[Varied | None, Quantity("m", -1.0, 1.0)] = Field(
        default=None,
        description="how far the plane is from the middle of the scalp, 80 mm when absent; or how far beyond the mesh "
        "or the line locks end, 0 when absent",
    )
    spread: Annotated[Varied, Quantity("m", 0.0, 0.1)] = Field(
        default=Varied(value=0.003),
        description="how far tips scatter to both sides of the target; larger is more ragged",
    )
    least: Annotated[Varied, Quantity("m", 1e-4, 1.0)] = Field(
        default=Varied(value=0.01), description="shortest length that a lock is cut to"
    )
    each: Literal["lock", "section"] = Field(
        default="lock", description="whether tips scatter each by itself, or all of a section together"
    )

    @model_validator(mode="after")
    def _one_target(self) -> ToTarget:
        if self.line is not None and self.mesh is not None:
            raise refuse("has a line and also a mesh; give one of them")
        if self.mesh is not None and self.toward != type(self).model_fields["toward"].default:
            raise refuse("has 'toward', but locks cross a mesh from any side; take it out, or the mesh")
        return self

    def path(self, points: NDArray, curves: Curves, context: Context) -> tuple[NDArray, NDArray]:
        """Polylines (count, k, 3) along which locks end, and the arc lengths (count, m) that are searched [m]."""
        raise NotImplementedError

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the shapes up to the target, with as many points; roots stay. Those that never cross it stay."""
        path, along = self.path(points, curves, context)
        distance, offset = self._target(context), self._offset(curves, context)
        length = _first_crossing(path, along, lambda places: distance(places) - offset[:, None])
        length = np.maximum(length, self._values("least", curves, context))
        own = arc_lengths(points)
        share = np.where(length < along[:, -1], length / np.maximum(own[:, -1], 1e-12), 1.0)
        return np.where((share != 1.0)[:, None, None], on_splines(path, share[:, None] * own), points)

    def _target(self, context: Context) -> Distance:
        if self.mesh is not None:
            solid = context.mesh(self.mesh, "mesh")
            return lambda p: np.asarray(solid.above(np.ascontiguousarray(p.reshape(-1, 3)))[0]).reshape(p.shape[:-1])
        toward = unit(np.array(self.toward))
        if self.line is None:
            return lambda places: (places - context.scalp.middle) @ toward
        drawn = context.helper(self.line, "line")
        line = np.concatenate([evenly(drawn[k], LINE_POINTS) for k in range(len(drawn))])
        height = line @ toward
        seen = KDTree(line - height[:, None] * toward)

        def beyond(places: NDArray) -> NDArray[np.float64]:
            at = places @ toward
            nearest: NDArray[np.float64] = at - height[seen.query(places - at[..., None] * toward)[1]]
            return nearest

        return beyond

    def _offset(self, curves: Curves, context: Context) -> NDArray[np.float64]:
        """Distance beyond the target at which each lock ends [m], shape (count,)."""
        own = self.line is None and self.mesh is None
        at = np.full(len(curves), PLANE if own else 0.0) if self.at is None else self._values("at", curves, context)
        leaders, row = self._leaders(curves)
        chance = 2.0 * context.random("spread").uniform(leaders.ids) - 1.0
        return at + self._values("spread", curves, context) * chance[row]

    def _values(self, name: str, curves: Curves, context: Context) -> NDArray[np.float64]:
        leaders, row = self._leaders(curves)
        return context.values(self, name, leaders)[row]

    def _leaders(self, curves: Curves) -> tuple[Curves, NDArray[np.int64]]:
        """The locks that decide, and the row of the one that decides for each: the first of its section, or itself."""
        if self.each == "lock" or SECTION not in curves.curve:
            return curves, np.arange(len(curves))
        section = curves.curve[SECTION].astype(np.int64)
        group = np.where(section >= 0, section, -1 - np.arange(len(curves)))
        _, first, row = np.unique(group, return_index=True, return_inverse=True)
        leaders = curves.take(first)
        leaders.ids = np.where(section[first] >= 0, section[first], curves.ids[first])
        return leaders, row.reshape(-1)


def _first_crossing(path: NDArray, along: NDArray, beyond: Distance) -> NDArray[np.float64]:
    """Arc length at which polylines first come beyond a target, shape (count,); inf: never.

    along:  arc lengths that are searched, ascending from 0 [m], shape (count, k)
    beyond: distance beyond the target at places (count, k, 3), shape (count, k)
    """
    crossed = beyond(on_splines(path, along)) > 0.0
    i = np.maximum(crossed.argmax(axis=1), 1)
    rows = np.arange(len(path))
    low, high = along[rows, i - 1], along[rows, i]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        past = beyond(on_splines(path, middle[:, None]))[:, 0] > 0.0
        low, high = np.where(past, low, middle), np.where(past, middle, high)
    length = np.where(crossed[:, 0], 0.0, 0.5 * (low + high))
    return np.where(crossed.any(axis=1), length, np.inf)
