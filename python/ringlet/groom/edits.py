"""Manual edits of single locks; they stay valid when earlier stages change."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from ringlet import _core
from ringlet.data import limits
from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Section, refuse
from ringlet.groom.helpers import Place
from ringlet.groom.operators.operator import Context, Operator, arc_lengths, grid, on_splines, packed, with_grid

Value = float | int | str


class Move(Section):
    """A point of a lock that was pulled, with its falloff along the lock."""

    at: Annotated[float, Quantity("", 0.0, 1.0)] = Field(description="place on the lock, from root (0) to tip (1)")
    by: Place = Field(description="displacement: along the two axes across the shape of the lock, and along it")
    falloff: Annotated[float, Quantity("", 0.001, 10.0)] = Field(
        default=0.2, description="part of the lock, to either side, over which the pull falls off"
    )


class Edit(Section):
    """A manual edit of one lock.

    Moves and offsets are stored in the frame of the lock's shape before it is curled, relative to the recipe's result.
    They follow every change of the recipe. A curve is stored in the frame of its root and follows the scalp alone.
    """

    lock: int = Field(ge=-limits.ID, le=limits.ID, description="id of the lock")
    stage: Literal["shape", "groom"] = Field(
        default="groom", description="shape: before the lock is curled, groom: the curled lock itself"
    )
    set: dict[str, Value] = Field(
        default={}, description='settings of this lock alone, such as `"curl.width" = "8 mm"`'
    )
    length: Annotated[float | None, Quantity("", 0.01, 100.0)] = Field(
        default=None,
        description="factor on the length of the shape: the lock is cut, or goes on straight. For the stage `shape`",
    )
    curve: list[Place] | None = Field(
        default=None,
        description="points from the root that replace the lock, in tangent, bitangent and normal of the root",
    )
    offsets: list[Place] = Field(default=[], description="displacements of points at even places from root to tip")
    move: list[Move] = Field(default=[], description="points that were pulled")

    @model_validator(mode="after")
    def _not_empty(self) -> Edit:
        if self.curve is not None and len(self.curve) < 2:
            raise refuse(f"has a curve of {len(self.curve)} point(s); give at least 2")
        if not (self.set or self.length or self.curve or self.offsets or self.move):
            raise refuse("changes nothing; give it 'set', 'length', 'curve', 'offsets' or 'move', or take it away")
        if self.length is not None and self.stage != "shape":
            raise refuse("has a length, which counts before the lock is curled; give it stage = 'shape'")
        return self


class Edits(Operator):
    """Applies manual edits in order; skips an edit whose lock does not exist."""

    edits: list[Edit]

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the locks with their edits; roots stay."""
        points = grid(curves).copy()
        rows = {int(name): row for row, name in enumerate(curves.ids)}
        frames = context.scalp.frames(curves)
        u = np.linspace(0.0, 1.0, points.shape[1])
        for edit in self.edits:
            if (row := rows.get(edit.lock)) is None:
                continue
            root = points[row, 0].copy()
            if edit.curve is not None:
                points[row] = root + resampled(np.array(edit.curve), len(u)) @ frames[row].T
            if edit.length is not None:
                one = points[row : row + 1]
                points[row] = on_splines(one, edit.length * arc_lengths(one))[0]
            by = np.zeros((len(u), 3))
            if edit.offsets:
                by += resampled(np.array([(0.0, 0.0, 0.0), *edit.offsets[1:]]), len(u), even=False)
            for move in edit.move:
                t = np.clip(1.0 - np.abs(u - move.at) / move.falloff, 0.0, 1.0)
                by += (t * t * (3.0 - 2.0 * t))[:, None] * np.array(move.by)
            points[row] += np.einsum("nij,nj->ni", shape_frames(context.shapes or curves, row, frames[row], u), by)
            points[row, 0] = root
        return with_grid(curves, points)


def resampled(points: NDArray, count: int, *, even: bool = True) -> NDArray[np.float64]:
    """Resamples a curve that starts at 0: even in arc length, or else even in point index; shape (count, 3)."""
    if even:
        return _core.resample_curves(*packed(Curves.from_list([points - points[0]])), count)
    at = np.linspace(0.0, len(points) - 1.0, count)
    return np.stack([np.interp(at, np.arange(len(points)), column) for column in points.T], axis=1)


def shape_frames(shapes: Curves, row: int, root: NDArray, u: NDArray) -> NDArray[np.float64]:
    """Rotation-minimising frames of one lock's shape at parameters u, shape (len(u), 3, 3).

    root: frame of the scalp at the root, shape (3, 3); its tangent is the first axis at the root
    """
    one = Curves.from_list([np.asarray(shapes[row], np.float64)])
    frames = _core.curve_frames(*packed(one), np.ascontiguousarray(root[None, :, 0]))
    at = u * (len(frames) - 1)
    i = np.minimum(at.astype(int), len(frames) - 2)
    t = (at - i)[:, None, None]
    left, _, right = np.linalg.svd((1.0 - t) * frames[i] + t * frames[i + 1])
    return left @ right  # the nearest rotation


def offsets_to(before: Curves, shapes: Curves, row: int, root: NDArray, points: NDArray) -> list[list[float]]:
    """Offsets of ``points`` (k, 3) from the recipe's lock, in the frame of the lock's shape [m]."""
    u = np.linspace(0.0, 1.0, len(points))
    procedural = resampled(np.asarray(before[row], np.float64), len(points), even=False)
    frames = shape_frames(shapes, row, root, u)
    return np.round(np.einsum("nij,ni->nj", frames, points - procedural), 9).tolist()
