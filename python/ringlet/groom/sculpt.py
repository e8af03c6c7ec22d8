"""Manual sculpts of single guides; they stay valid when earlier stages change."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from ringlet import _core
from ringlet.data import limits
from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Section, refuse
from ringlet.groom.edits import resampled
from ringlet.groom.helpers import Place
from ringlet.groom.operators.operator import Context, Operator, arc_lengths, at_lengths, packed
from ringlet.groom.scalp import Scalp

MIN_MOVE = 2e-5  # [m] smallest displacement that counts as sculpted


class Sculpt(Section):
    """A manual sculpt of one guide, relative to the recipe's result. The guide's length is scaled first. Its points are
    then moved, each in the rotation-minimising frame along the guide."""

    guide: int = Field(ge=-limits.ID, le=limits.ID, description="id of the guide")
    length: Annotated[float, Quantity("", 0.01, 100.0)] = Field(default=1.0, description="factor on its length")
    offsets: list[Place] = Field(
        default=[],
        description="displacements of points at even places from root to tip: along the two axes across the "
        "guide, and along it",
    )

    @model_validator(mode="after")
    def _not_empty(self) -> Sculpt:
        if self.length == 1.0 and not self.offsets:
            raise refuse("changes nothing; give it 'length' or 'offsets', or take it away")
        return self


class Sculpted(Operator):
    """Applies manual sculpts to guides; skips a sculpt whose guide does not exist."""

    sculpts: list[Sculpt]

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the guides with their sculpts; roots stay."""
        return sculpted(curves, self.sculpts, context.scalp)


def sculpted(guides: Curves, sculpts: Sequence[Sculpt], scalp: Scalp) -> Curves:
    """Applies manual sculpts to guides that are bound to the scalp."""
    rows = {int(name): row for row, name in enumerate(guides.ids)}
    found = [(rows[sculpt.guide], sculpt) for sculpt in sculpts if sculpt.guide in rows]
    if not found:
        return guides
    points = np.array(guides.points, np.float64)
    for row, sculpt in found:
        points[guides.offsets[row] : guides.offsets[row + 1]] = lengthened(guides[row], sculpt.length)
    frames = frames_along(guides.with_points(points), scalp)
    for row, sculpt in found:
        if sculpt.offsets:
            own = slice(guides.offsets[row], guides.offsets[row + 1])
            offsets = [(0.0, 0.0, 0.0), *sculpt.offsets[1:]]
            by = resampled(np.array(offsets), int(guides.counts[row]), even=False)
            points[own] += np.einsum("nij,nj->ni", frames[own], by)
    return guides.with_points(points)


def sculpts_to(before: Curves, after: Curves, scalp: Scalp) -> list[dict[str, Any]]:
    """Sculpts that turn the guides ``before`` into ``after``, as tables of a recipe."""
    changed = np.linalg.norm(after.points - before.points, axis=1) > MIN_MOVE
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
        if np.abs(own).max() > MIN_MOVE:
            sculpt["offsets"] = [[f"{1e3 * x:.2f} mm" for x in point] for point in own]
        if len(sculpt) > 1:
            sculpts.append(sculpt)
    return sculpts


def lengthened(points: NDArray, factor: float) -> NDArray[np.floating]:
    """Scales the length of a guide (n, 3) at its tip, with the same number of points; growth continues straight."""
    if factor == 1.0:
        return points
    return at_lengths(points[None], factor * arc_lengths(points[None]))[0]


def frames_along(guides: Curves, scalp: Scalp) -> NDArray[np.float64]:
    """Rotation-minimising frames of guides, shape (n, 3, 3); the root's tangent is the first axis at the root."""
    return _core.curve_frames(*packed(guides), np.ascontiguousarray(scalp.frames(guides)[:, :, 0]))
