"""Bantu knots: the strands of each section, twisted to a rope and wound about their own base."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.errors import Fix, UserError
from ringlet.data.groom import STRAND_RADIUS
from ringlet.data.quantities import Quantity, Varied
from ringlet.groom import felt, weave
from ringlet.groom.coil import Coil, on_scalp
from ringlet.groom.operators.operator import Context, arc_lengths, at_lengths, grid, unit
from ringlet.groom.operators.sectioned import Sectioned, Strands
from ringlet.groom.operators.woven import JOIN, JOINED

LEAST_POINTS, GOOD_POINTS = 8, 14  # per winding, and per turn of twisted strands
END = 3.0  # length over which the rope's end closes, in radii of the rope


class Knot(Sectioned):
    """Winds the strands of each section into a knot on the scalp. They rise in the middle, turn over at the top and are
    wound down around themselves; the end is tucked under. The rope is as thick as lets successive windings touch, and a
    lock becomes as long as its knot needs. Two strands or more are twisted about one another, as in ``twist``."""

    op: Literal["knot"] = "knot"
    width: Annotated[Varied, Quantity("m", 2e-3, 0.3)] = Field(
        default=Varied(value=0.03), description="width of the knot on the scalp"
    )
    height: Annotated[Varied, Quantity("m", 2e-3, 0.3)] = Field(
        default=Varied(value=0.024), description="height of the knot"
    )
    windings: Annotated[Varied, Quantity("", 1.0, 12.0)] = Field(
        default=Varied(value=3.0), description="number of windings of the rope around its base"
    )
    dome: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.6), description="0: windings lie on a cone, 1: on a dome"
    )
    tuck: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=1.0), description="0 leaves the end outside, 1 tucks it under as far as there is space"
    )
    tightness: Annotated[Varied, Quantity("", 0.05, 1.0)] = Field(
        default=Varied(value=1.0), description="1: windings touch; smaller: the rope is thinner on the same path"
    )
    pitch: Annotated[Varied | None, Quantity("m", 1e-3, 1.0)] = Field(
        default=None, description="length of a turn of twisted strands; two thicknesses of the rope when absent"
    )
    start: Annotated[Varied, Quantity("m", 0.0, 1.0)] = Field(
        default=Varied(value=0.005), description="length over which the strands come together"
    )
    right_handed: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=1.0), description="fraction of the sections that are wound right-handed"
    )

    def points_needed(self, curves: Curves, context: Context) -> int:
        """Points that the windings and the twists of the strands need."""
        leaders, rows = self.leaders(curves, self.weights(curves, context) > 0.0)
        turns = [wound.turns for wound in self._wound(grid(curves), leaders, rows, context)]
        return int(np.ceil(GOOD_POINTS * max(turns, default=0.0)))

    def strands(
        self, curves: Curves, leaders: Curves, rows: Sequence[NDArray[np.integer]], context: Context
    ) -> Iterator[Strands]:
        """The strands of each section as the rope of a knot."""
        shapes = grid(curves)
        for wound in self._wound(shapes, leaders, rows, context):
            self._check_points(wound.turns, shapes.shape[1], context)
            along = np.linspace(0.0, wound.length, shapes.shape[1])[None]
            points = wound.rope.around(at_lengths(wound.line[None], along)[0], shapes[wound.rows, 0])
            ends = np.clip((1.0 - np.linspace(0.0, 1.0, felt.KNOTS)) * wound.length / wound.end, 0.0, 1.0)
            yield Strands(
                wound.rows,
                points,
                {STRAND_RADIUS: wound.radius, JOIN: JOINED * wound.start},
                profile=np.sqrt(ends * (2.0 - ends)),
            )

    def _wound(
        self, shapes: NDArray, leaders: Curves, rows: Sequence[NDArray[np.integer]], context: Context
    ) -> Iterator[Wound]:
        """The ropes of sections, for a strand of each and the rows of all its strands (count, points, 3) [m]."""
        names = ("width", "height", "windings", "dome", "tuck", "tightness", "start", "right_handed")
        values = {name: context.values(self, name, leaders) for name in names}
        pitch = None if self.pitch is None else context.values(self, "pitch", leaders)
        mirrored = context.random("hand").uniform(leaders.ids) >= values["right_handed"]
        for k, of in enumerate(rows):
            width, height, windings, dome, tuck, tightness, start, _ = (values[name][k] for name in names)
            coil = Coil.fitted(width, height, windings, dome, tuck)
            line = coil.path() * [1.0, -1.0 if mirrored[k] else 1.0, 1.0]
            base = shapes[of, 0].mean(axis=0)
            line = on_scalp(line, base, context.scalp.nearest(base[None])[1][0], context.scalp)
            length = float(arc_lengths(line[None])[0, -1])
            twists = 0.0 if len(of) == 1 else (length - coil.rise) / (4.0 * coil.rope if pitch is None else pitch[k])
            rope = Rope(coil.rope, len(of), twists, start / length, coil.rise / length)
            radius = float(tightness * rope.strand)
            yield Wound(of, rope, line, length, windings + twists, radius, start, END * coil.rope)

    def _check_points(self, turns: float, points: int, context: Context) -> None:
        """Raises UserError for fewer than LEAST_POINTS points a turn."""
        if points < LEAST_POINTS * turns:
            least, good = (int(np.ceil(each * turns)) for each in (LEAST_POINTS, GOOD_POINTS))
            raise UserError(
                f"locks.points is {points}: too few for the {turns:.1f} turns of {context.purpose} and its strands; "
                f"leave it out, or set it to {good} (at least {least}), or lower its windings",
                [Fix(("locks", "points"), good)],
            )


@dataclass(frozen=True)
class Wound:
    """The rope of one knot.

    rows:   of its strands
    line:   centre line of the rope [m], shape (k, 3), and its length [m]
    turns:  windings, and turns of its strands about one another
    radius: of a strand [m]
    start:  length over which the strands come together, and that over which the end closes [m]
    """

    rows: NDArray[np.integer]
    rope: Rope
    line: NDArray[np.float64]
    length: float
    turns: float
    radius: float
    start: float
    end: float


class Rope:
    """Strands twisted about one another around a centre line.

    strand: radius of a strand [m]
    """

    def __init__(self, radius: float, strands: int, twists: float, start: float, side_by_side: float) -> None:
        """radius: of the rope [m]; twists: turns along it; start: part of the length in which strands come together;
        side_by_side: part in which they are not twisted, since in a tight bend they would overlap."""
        self._radius, self._strands, self._twists = radius, strands, twists
        self._start, self._side_by_side = start, side_by_side
        self.strand = radius
        if strands > 1:
            pitch = 4.0 * radius  # of a tight rope: longer turns leave as much room
            self.strand = weave.touching_radius("rope", strands, 2.0 * radius, 2.0 * radius, pitch)

    def around(self, line: NDArray, roots: NDArray) -> NDArray[np.float64]:
        """The strands about a centre line (points, 3) from their roots (strands, 3), shape (strands, points, 3)."""
        count = len(line)
        u = np.linspace(0.0, 1.0, count)
        offset = roots - line[0]
        tangent = line[1] - line[0]
        across = unit(offset[0]) if self._strands > 1 else np.eye(3)[np.abs(tangent).argmin()]
        frames = _core.curve_frames(line, np.array([0, count], np.int32), np.ascontiguousarray(across[None]))
        turned = self._twists * np.clip((u - self._side_by_side) / (1.0 - self._side_by_side), 0.0, 1.0)
        phase = 2.0 * np.pi * (turned[None] + np.arange(self._strands)[:, None] / self._strands)
        place = np.stack([np.cos(phase), np.sin(phase)], axis=2)
        wound = (self._radius - self.strand) * np.einsum("spk,pxk->spx", place, frames[:, :, :2])
        t = np.clip(u / max(self._start, 1e-9), 0.0, 1.0)
        together = (t * t * (3.0 - 2.0 * t))[None, :, None]
        points: NDArray[np.float64] = line + together * wound + (1.0 - together) * offset[:, None]
        return points
