"""Guides that were sculpted by hand: what was done to each outlives every change of what comes before it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Section, refuse
from ringlet.groom.edits import resampled
from ringlet.groom.helpers import Place
from ringlet.groom.operators.operator import Context, Operator, arc_lengths, at_lengths, packed
from ringlet.groom.scalp import Scalp

MOVED = 2e-5  # [m] a point that is nearer than this to where it was has not been sculpted


class Sculpt(Section):
    """What was done to one guide by hand, relative to what the recipe makes of it: it is made longer or shorter, and
    then its points are moved, each in the frame that is carried along the guide from its root."""

    guide: int = Field(description="id of the guide")
    length: Annotated[float, Quantity("", 0.01, 100.0)] = Field(default=1.0, description="times its length")
    offsets: list[Place] = Field(
        default=[],
        description="how far points at even places from root to tip are moved: along the two axes across the guide, "
        "and along it",
    )

    @model_validator(mode="after")
    def _says_something(self) -> Sculpt:
        if self.length == 1.0 and not self.offsets:
            raise refuse("changes nothing; give it 'length' or 'offsets', or take it away")
        return self


class Sculpted(Operator):
    """Guides as they were sculpted; those that are not there are left to be told of."""

    sculpts: list[Sculpt]

    def apply(self, curves: Curves, context: Context) -> Curves:
        """The same guides, the sculpted ones changed; roots stay."""
        return sculpted(curves, self.sculpts, context.scalp)


def sculpted(guides: Curves, sculpts: Sequence[Sculpt], scalp: Scalp) -> Curves:
    """Bound guides with what was done to them by hand."""
    rows = {int(name): row for row, name in enumerate(guides.ids)}
    there = [(rows[sculpt.guide], sculpt) for sculpt in sculpts if sculpt.guide in rows]
    if not there:
        return guides
    points = np.array(guides.points, np.float64)
    for row, sculpt in there:
        points[guides.offsets[row] : guides.offsets[row + 1]] = lengthened(guides[row], sculpt.length)
    frames = frames_along(guides.with_points(points), scalp)
    for row, sculpt in there:
        if sculpt.offsets:
            here = slice(guides.offsets[row], guides.offsets[row + 1])
            moved = [(0.0, 0.0, 0.0), *sculpt.offsets[1:]]
            by = resampled(np.array(moved), int(guides.counts[row]), even=False)
            points[here] += np.einsum("nij,nj->ni", frames[here], by)
    return guides.with_points(points)


def sculpts_to(before: Curves, after: Curves, scalp: Scalp) -> list[dict[str, Any]]:
    """What must be done to the guides ``before`` so that they are those ``after``, as a recipe says it."""
    changed = np.linalg.norm(after.points - before.points, axis=1) > MOVED
    chosen = np.flatnonzero(np.logical_or.reduceat(changed, before.offsets[:-1])).tolist() if len(before) else []
    factors = np.round(after.lengths() / np.maximum(before.lengths(), 1e-9), 4)
    points = np.array(before.points, np.float64)
    for row in chosen:
        points[before.offsets[row] : before.offsets[row + 1]] = lengthened(before[row], factors[row])
    frames = frames_along(before.with_points(points), scalp)
    offsets = np.einsum("nij,ni->nj", frames, after.points - points)
    sculpts: list[dict[str, Any]] = []
    for row in chosen:
        sculpt: dict[str, Any] = {"guide": int(before.ids[row])}
        if factors[row] != 1.0:
            sculpt["length"] = float(factors[row])
        own = offsets[before.offsets[row] : before.offsets[row + 1]]
        if np.abs(own).max() > MOVED:
            sculpt["offsets"] = [[f"{1e3 * x:.2f} mm" for x in point] for point in own]
        if len(sculpt) > 1:
            sculpts.append(sculpt)
    return sculpts


def lengthened(points: NDArray, factor: float) -> NDArray[np.floating]:
    """A guide (n, 3) made so many times as long, with as many points: cut, or going on straight from its tip."""
    if factor == 1.0:
        return points
    return at_lengths(points[None], factor * arc_lengths(points[None]))[0]


def frames_along(guides: Curves, scalp: Scalp) -> NDArray[np.float64]:
    """The rotation-minimising frames of guides, shape (n, 3, 3); they begin at the tangent of the root's frame."""
    return _core.curve_frames(*packed(guides), np.ascontiguousarray(scalp.frames(guides)[:, :, 0]))
