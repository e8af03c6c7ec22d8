"""Cornrows: braids that lie on the scalp along rows and take in hair as they go."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import CORE, SECTION, STRAND_RADIUS, TIED
from ringlet.data.quantities import Quantity, Varied
from ringlet.groom import felt, weave
from ringlet.groom.helpers import Names
from ringlet.groom.operators.operator import UP, Context, arc_lengths, evenly, grid, unit, with_lock_points
from ringlet.groom.operators.woven import JOIN, Braided, Woven
from ringlet.groom.rows import Row, drawn_rows, middle_rows
from ringlet.groom.sections import Division
from ringlet.groom.shares import LAID, REACH, row_reaches

TAIL_POINTS = 40
OFF = 0.35  # how much the tail heads away from the scalp where it leaves it, as a part of its direction
ROOTS_APART = 1.8  # of a row's strands, in radii of a strand


class Cornrow(Woven):
    """Braids the strands of each section on the scalp, along the middle of the section from its front to its back, or
    along a drawn ``path``; beyond its end the braid hangs as a tail. Hair of the section lies flat towards the braid
    and joins it on its side, ``feed`` behind where it grows. In a shot the braid is pinned to the scalp. A row is
    braided where ``blend`` times ``mask`` is over a half at its roots.

    The strands are as in ``braid``, with x across the row and z along the normal of the scalp. The braid lies between
    the scalp and ``height``.
    """

    op: Literal["cornrow"] = "cornrow"
    pattern: Literal["over", "under"] = Field(default="under", description="how strands cross: under stands out more")
    path: Names | None = Field(
        default=None,
        description="names of helper curves that braids follow, from `[curves]`, one in a section; the middle of each "
        "section when absent",
    )
    height: Annotated[Varied, Quantity("m", 5e-4, 0.1)] = Field(
        default=Varied(value=0.005), description="height above the scalp, strands included"
    )
    feed: Annotated[Varied, Quantity("m", 0.0, 0.1)] = Field(
        default=Varied(value=0.006), description="length along the row between where hair grows and where it joins"
    )
    off: Annotated[Varied, Quantity("m", 0.0, 1.0)] = Field(
        default=Varied(value=0.0), description="length at the back of the row over which the braid has left the scalp"
    )
    length: Annotated[Varied, Quantity("m", 1e-3, 2.0)] = Field(
        default=Varied(value=0.08), description="length of the tail"
    )
    gravity_bend: Annotated[Varied, Quantity("", 0.0, 10.0)] = Field(
        default=Varied(value=2.0), description="how strongly the tail bends down: 0 straight, larger hangs more steeply"
    )

    @property
    def weaving(self) -> weave.Pattern:
        """The pattern."""
        return self.pattern

    def depths(self, width: NDArray, leaders: Curves, context: Context) -> NDArray[np.float64]:
        """The height."""
        return context.values(self, "height", leaders)

    def pitch_of(self, width: NDArray) -> NDArray[np.float64]:
        """Two widths."""
        return 2.0 * width

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the curves with the strands of sections braided along their rows, rooted at the front of these."""
        self.check_strands(curves, context)
        leaders, rows = self.leaders(curves, self.weights(curves, context)[:, :1] > 0.5)
        if context.sections is None or not rows:
            return curves
        division = context.sections.divide(context.scalp, context.seed, context.helper, context.density)
        lines = self._rows(division, context)
        has = np.array([int(section) in lines for section in leaders.ids])
        if not has.any():
            raise UserError(f"{context.purpose}: no row is long enough; make the sections wider, or draw the path")
        leaders, rows = leaders.take(has), [of for of, there in zip(rows, has, strict=True) if there]
        values = {k: context.values(self, k, leaders) for k in ("feed", "off", "length", "gravity_bend")}
        lain = [lines[int(section)].shortened(off) for section, off in zip(leaders.ids, values["off"], strict=True)]

        whole = np.array([row.length for row in lain]) + values["length"]
        fine = with_lock_points(curves, context, self.points_for(whole, leaders, rows, context))
        shapes, points = grid(fine).copy(), grid(fine).shape[1]
        for k, (row, of) in enumerate(zip(lain, rows, strict=True)):
            tail = _tail(row, row.points, values["length"][k], values["gravity_bend"][k])
            shapes[of] = evenly(np.concatenate([row.points, tail[1:]]), points)
        fine = fine.with_points(np.ascontiguousarray(shapes.reshape(-1, 3)))
        core = (CORE,) if self.simulate == "core" else ()
        attributes = _attributes(fine, (STRAND_RADIUS, JOIN, LAID, *core))
        tied = fine.point.get(TIED, np.zeros(len(fine.points), np.float32)).reshape(shapes.shape[:2]).copy()
        for k, braid in enumerate(self.braids(fine, leaders, rows, context)):
            self._lay(braid, lain[k], values["length"][k], values["gravity_bend"][k], shapes, attributes, context)
            tied[braid.rows] = braid.tied(points)
            if CORE in attributes:
                attributes[CORE][braid.rows] = self.simulate == "core"
            attributes[JOIN][braid.rows] = values["feed"][k] * attributes[LAID][braid.rows] / lain[k].length
            reach = row_reaches(division, context.scalp, lain[k].points, lain[k].normals, int(leaders.ids[k]))
            attributes[REACH][braid.rows] = reach
            if ((narrows := braid.narrows(np.linspace(0.0, 1.0, felt.KNOTS), self)) != 1.0).any():
                attributes = felt.with_profile(attributes, braid.rows, narrows)
        laid = np.concatenate(rows)
        places = context.scalp.positions(attributes["root_triangle"][laid], attributes["root_barycentric"][laid])
        for name, at in division.at(places).items():
            if name != SECTION:
                attributes[name][laid] = at
        return Curves(shapes.reshape(-1, 3), fine.offsets, fine.ids, attributes, {**fine.point, TIED: tied.ravel()})

    def _rows(self, division: Division, context: Context) -> dict[int, Row]:
        if self.path is None:
            return middle_rows(division, context.scalp)
        return drawn_rows(context.helper(self.path, "path"), division, context.scalp, f"{context.purpose}.path")

    def _lay(
        self,
        braid: Braided,
        row: Row,
        length: float,
        gravity_bend: float,
        shapes: NDArray,
        attributes: dict[str, NDArray],
        context: Context,
    ) -> None:
        """Sets the points and attributes of the strands of one row."""
        strands, points = len(braid.rows), shapes.shape[1]
        scalp = context.scalp
        along = np.linspace(0.0, 1.0, len(row.points)) * row.length
        t = np.clip(along / max(braid.start * braid.length, 1e-9), 0.0, 1.0)
        size = self.width.along(along / braid.length)
        lift = (size * abs(braid.front) + braid.radius) * t * t * (3.0 - 2.0 * t)
        skin = row.points + lift[:, None] * row.normals
        tail = braid.clear(_tail(row, skin, length, gravity_bend), scalp)
        normals = np.concatenate([row.normals, _transported(row.normals[-1], tail)[1:]])
        line = np.concatenate([skin, tail[1:]])
        line, front = braid.eased(evenly(line, points), self), _along(line, normals, points)
        tangent = unit(np.gradient(line, axis=0))
        front = unit(front - np.sum(front * tangent, axis=1, keepdims=True) * tangent)
        across = np.cross(front, tangent)

        offset = (np.arange(strands) - 0.5 * (strands - 1)) * ROOTS_APART * braid.radius
        wanted = np.ascontiguousarray(row.points[0] + offset[:, None] * across[0])
        triangle, barycentric, _ = _core.bind_roots(scalp.points, scalp.triangles, wanted, scalp.region)
        roots = scalp.positions(triangle, barycentric)
        shapes[braid.rows] = braid.about(line, across, front, roots - line[0], self)
        attributes["root_triangle"][braid.rows] = triangle
        attributes["root_barycentric"][braid.rows] = barycentric
        attributes[STRAND_RADIUS][braid.rows] = braid.radius
        run = arc_lengths(shapes[braid.rows])  # strands are longer than their centre line
        end = row.length / (row.length + length)
        attributes[LAID][braid.rows] = [np.interp(end, np.linspace(0.0, 1.0, points), of) for of in run]


def _attributes(curves: Curves, names: Sequence[str]) -> dict[str, NDArray]:
    """Copies of the attributes of locks, with the named ones, which are 0 where they are new."""
    none = {name: np.zeros(len(curves), np.float32) for name in names}
    return {name: values.copy() for name, values in {**none, **curves.curve}.items()}


def _tail(row: Row, skin: NDArray, length: float, gravity_bend: float) -> NDArray[np.float64]:
    """Points of a tail after a row whose centre line is at ``skin`` (k, 3), from the last of these [m]."""
    start = unit(unit(skin[-1] - skin[-3]) + OFF * row.normals[-1])
    u = (np.arange(TAIL_POINTS) + 0.5) / TAIL_POINTS
    edges = length / TAIL_POINTS * unit(start - (gravity_bend * u)[:, None] * UP)
    return np.cumsum(np.concatenate([skin[-1:], edges]), axis=0)


def _transported(normal: NDArray, line: NDArray) -> NDArray[np.float64]:
    """A normal of the scalp at the points of a line (points, 3) from there on [m]."""
    offsets, first = np.array([0, len(line)], np.int32), np.ascontiguousarray(normal[None])
    return _core.curve_frames(np.ascontiguousarray(line), offsets, first)[:, :, 0]


def _along(line: NDArray, values: NDArray, points: int) -> NDArray[np.float64]:
    """Values at the points of a line, shape (k, 3), at that many even distances along it."""
    run = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    at = np.linspace(0.0, run[-1], points)
    return np.stack([np.interp(at, run, values[:, k]) for k in range(3)], axis=1)
