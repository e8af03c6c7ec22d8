"""The base class of operators that shape the strands of each section together: braids, twists, knots."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import SECTION
from ringlet.groom import felt
from ringlet.groom.operators.operator import Context, grid, with_lock_points
from ringlet.groom.operators.shape import Shape
from ringlet.groom.sections import STRAND


@dataclass(frozen=True)
class Strands:
    """The shaped strands of one section.

    rows:     rows of its locks
    points:   their points [m], shape (strands, points, 3)
    of_curve: attributes of each strand
    of_point: attributes of their points, the same for all strands, shape (points,) each
    profile:  factor on their radius at ``felt.KNOTS`` places from root to tip, or None: 1
    """

    rows: NDArray[np.integer]
    points: NDArray[np.floating]
    of_curve: Mapping[str, float]
    of_point: Mapping[str, NDArray] = field(default_factory=dict)
    profile: NDArray[np.floating] | None = None


class Sectioned(Shape):
    """Shapes the strands of each section together. They get as many points as a groom guide has."""

    def strands(
        self, curves: Curves, leaders: Curves, rows: Sequence[NDArray[np.integer]], context: Context
    ) -> Iterator[Strands]:
        """The shaped strands of sections, for a strand of each and the rows of all; curves have equal point counts."""
        raise NotImplementedError

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the curves with the strands shaped, all with ``lock_points`` points or more."""
        fine = self.resampled(curves, context)
        weight = self.weights(fine, context)
        leaders, rows = self.leaders(fine, weight > 0.0)
        if not rows:
            return curves
        shapes = grid(fine).copy()
        of_curve, of_point = dict(fine.curve), dict(fine.point)
        for one in self.strands(fine, leaders, rows, context):
            shapes[one.rows] = one.points
            for name, value in one.of_curve.items():
                _set(of_curve, name, one.rows, value, (len(fine),))
            for name, values in one.of_point.items():
                _set(of_point, name, one.rows, values, shapes.shape[:2])
            if one.profile is not None:
                of_curve = felt.with_profile(of_curve, one.rows, one.profile)
        shaped = self.blended(fine, shapes, weight)
        flat = {name: values.reshape(len(shaped.points), *values.shape[2:]) for name, values in of_point.items()}
        return Curves(shaped.points, shaped.offsets, shaped.ids, of_curve, flat)

    def resampled(self, curves: Curves, context: Context) -> Curves:
        """The curves with ``lock_points`` points or more each; raises UserError where no section has strands."""
        self.check_strands(curves, context)
        needed = 0 if context.lock_points else self.points_needed(curves, context)
        return with_lock_points(curves, context, needed)

    def points_needed(self, curves: Curves, context: Context) -> int:
        """Points of a lock that its strands need."""
        return 0

    def check_strands(self, curves: Curves, context: Context) -> None:
        """Raises UserError where no section has strands."""
        if STRAND not in curves.curve or not (curves.curve[STRAND] >= 0).any():
            raise UserError(
                f"{context.purpose}: no section has strands; set locks.sections.strands, such as 3, and see its mask"
            )

    def leaders(self, curves: Curves, acts: NDArray[np.bool_]) -> tuple[Curves, Sequence[NDArray[np.integer]]]:
        """A strand of each section that an operator acts on, named by the section, and the rows of all its strands.

        acts: whether it acts on points of the curves, shape (count, points)
        """
        strand = curves.curve[STRAND] >= 0
        sections = np.unique(curves.curve[SECTION][strand & acts.any(axis=1)])
        rows = [np.flatnonzero(strand & (curves.curve[SECTION] == section)) for section in sections]
        leaders = curves.take(np.array([of_section[0] for of_section in rows], np.int64))
        leaders.ids = sections.astype(np.int64)  # chance goes by the section, not by one of its strands
        return leaders, rows


def _set(
    attributes: dict[str, NDArray],
    name: str,
    rows: NDArray[np.integer],
    values: NDArray | float,
    shape: tuple[int, ...],
) -> None:
    """Sets an attribute of some locks, which is 0 elsewhere if it was not there."""
    old = attributes.get(name)
    attributes[name] = np.zeros(shape, np.float32) if old is None else old.reshape(shape).copy()
    attributes[name][rows] = values
