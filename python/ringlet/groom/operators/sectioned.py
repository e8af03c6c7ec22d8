"""The base class of operators that shape the strands of each section together: braids, twists, knots."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.errors import UserError
from ringlet.groom import felt
from ringlet.groom.operators.operator import Context, grid, packed
from ringlet.groom.operators.shape import Shape
from ringlet.groom.sections import SECTION, STRAND

STRAND_RADIUS = "strand_radius"  # curve attribute of locks: radius of a strand or a loc [m], 0 for others


@dataclass(frozen=True)
class Strands:
    """The shaped strands of one section.

    rows:    rows of its locks
    points:  their points [m], shape (strands, points, 3)
    radius:  of a strand [m]
    profile: factor on the radius at ``felt.KNOTS`` places from root to tip, or None: 1
    """

    rows: NDArray[np.integer]
    points: NDArray[np.floating]
    radius: float
    profile: NDArray[np.floating] | None = None


class Sectioned(Shape):
    """Shapes the strands of each section together. They get as many points as a groom guide has."""

    def strands(self, curves: Curves, sections: list[NDArray[np.integer]], context: Context) -> Iterator[Strands]:
        """The shaped strands of sections, given by the rows of their locks; curves have equal point counts."""
        raise NotImplementedError

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the curves with the strands shaped, all with ``lock_points`` points or more."""
        if STRAND not in curves.curve or not (curves.curve[STRAND] >= 0).any():
            raise UserError(f"{context.purpose}: no section has strands; give [locks.sections] strands = 3, say")
        fine = self._fine(curves, context)
        weight = self.weights(fine, context)
        sections = _sections(fine, weight)
        if not sections:
            return curves
        shapes = grid(fine).copy()
        radius = curves.curve.get(STRAND_RADIUS, np.zeros(len(curves), np.float32)).copy()
        attributes = {**curves.curve, STRAND_RADIUS: radius}
        for one in self.strands(fine, sections, context):
            shapes[one.rows] = one.points
            radius[one.rows] = one.radius
            if one.profile is not None:
                attributes = felt.with_profile(attributes, one.rows, one.profile)
        shaped = self.blended(fine, shapes, weight)
        return Curves(shaped.points, shaped.offsets, shaped.ids, attributes, shaped.point)

    def _fine(self, curves: Curves, context: Context) -> Curves:
        """The curves with ``lock_points`` points each, or as many as the longest has."""
        points = max(context.lock_points, int(curves.counts.max()))
        if int(curves.counts.min()) == points:
            return curves
        resampled = _core.resample_curves(*packed(curves), points)
        return Curves(resampled, offsets_from_counts([points] * len(curves)), curves.ids, curves.curve)


def _sections(curves: Curves, weight: NDArray) -> list[NDArray[np.integer]]:
    """Rows of the locks of each section of which a strand has weight."""
    strand = curves.curve[STRAND] >= 0
    sections = np.unique(curves.curve[SECTION][strand & (weight > 0.0).any(axis=1)])
    return [np.flatnonzero(strand & (curves.curve[SECTION] == section)) for section in sections]


def leaders(curves: Curves, sections: list[NDArray[np.integer]]) -> Curves:
    """A strand of each section, named by the section: chance goes by the section, not by one of its strands."""
    first = curves.take(np.array([rows[0] for rows in sections]))
    first.ids = first.curve[SECTION].astype(np.int64)
    return first
