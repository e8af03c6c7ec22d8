"""Ties: hair that is led over the head to a band, and becomes a tail, a puff or a bun there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import SECTION
from ringlet.data.quantities import Quantity, Ramped, Varied, refuse
from ringlet.groom.coil import Coil, on_scalp
from ringlet.groom.color import Color
from ringlet.groom.helpers import Names
from ringlet.groom.operators.operator import UP, Context, arc_lengths, at_lengths, grid, unit, with_lock_points
from ringlet.groom.operators.shape import Shape
from ringlet.groom.operators.tied import TO_TIE
from ringlet.groom.part_line import Direction
from ringlet.groom.worn import Worn, ball, chosen_color, revolved, ring

PATH_POINTS = 24  # of the path over the head, and of that after the tie
SMOOTHING = 3  # passes over the path on the skin
CENTRE = 0.85  # distance of a puff's centre from its tie, in radii of the puff
UNDERSIDE = -0.85  # cosine, from the axis, of the part of a puff around its tie where no lock ends
PER_TIE = (
    "off",
    "radius",
    "fall",
    "splay",
    "width",
    "height",
    "windings",
    "band",
    "bead",
)  # settings with a value for each tie
CARRIERS = 40  # roots nearest to a tie, which carry its band
HOLE = 0.2  # width of the hole of a bead on a band, relative to its own
NEARLY = np.array([0.0, 0.0, 1e-3])
BAND = ("#26262b",)  # colour without any of the recipe's


class Tie(Shape):
    """Leads each lock over the skin to a tie, where curls begin. From there it goes on in a ``tail`` of its own length,
    to the surface of a round ``ball`` (a puff), or around the tie in the windings of a ``bun``.

    Over the head the path is the spherical interpolation from root to tie about the centre of the scalp, projected onto
    the skin and raised by up to ``rise`` midway. Each lock has a place of its own in the tie.
    """

    op: Literal["tie"] = "tie"
    curve: Names | None = Field(
        default=None,
        description="names of helper curves that begin at ties, from `[curves]`: the centre lines of tails. Locks go "
        "to the nearest",
    )
    toward: Direction | None = Field(
        default=None,
        description="direction of the tie from the middle of the scalp, Y up; per section it is added to the unit "
        "direction of the section's middle",
    )
    each: Literal["head", "section"] = Field(
        default="head", description="one tie for the head, or one for each section"
    )
    off: Annotated[Varied, Quantity("m", 0.0, 0.5)] = Field(
        default=Varied(value=0.012),
        description="distance of the tie from the skin; with `curve` that of its first point",
    )
    radius: Annotated[Varied, Quantity("m", 0.0, 1.0)] = Field(
        default=Varied(value=0.01), description="radius of the hair in the tie"
    )
    rise: Annotated[Ramped, Quantity("m", -0.5, 0.5)] = Field(
        default=Ramped(value=0.005),
        description="largest height of the hair over the skin half-way to the tie; its ramp runs from root to tie",
    )
    after: Literal["tail", "ball", "bun"] = Field(default="tail", description="what the hair becomes after the tie")
    flare: Annotated[Ramped, Quantity("", 0.0, 20.0, product=False)] = Field(
        default=Ramped(value=2.0, ramp=[(0, 0), (1, 1)]),
        description="radius of the tail, as a multiple of that in the tie; its ramp runs from the tie, 0, to the tip",
    )
    fall: Annotated[Varied, Quantity("m", 1e-3, 10.0)] = Field(
        default=Varied(value=0.06), description="length over which a tail without a curve turns down"
    )
    splay: Annotated[Varied, Quantity("deg", 0.0, 180.0)] = Field(
        default=Varied(value=0.0),
        description="angle from the axis of the tie at which the outermost locks of such a tail leave it: 0 along it, "
        "90 to all sides, as a fountain",
    )
    width: Annotated[Varied, Quantity("m", 5e-3, 1.0)] = Field(
        default=Varied(value=0.12), description="width of the ball or the bun"
    )
    height: Annotated[Varied, Quantity("m", 5e-3, 1.0)] = Field(
        default=Varied(value=0.04), description="height of the bun"
    )
    windings: Annotated[Varied, Quantity("", 1.0, 12.0)] = Field(
        default=Varied(value=2.0), description="number of windings of a bun around the tie"
    )
    band: Annotated[Varied, Quantity("m", 0.0, 0.05)] = Field(
        default=Varied(value=0.0),
        description="thickness of the band, a mesh that the groom's file has and the head carries; 0: none",
    )
    bead: Annotated[Varied, Quantity("m", 0.0, 0.1)] = Field(
        default=Varied(value=0.0), description="width of the two beads that a band has side by side; 0: none"
    )
    colors: list[Color] = Field(
        default=[], description="colours of bands, in sRGB: `#rrggbb`; each gets one of them at random, with its beads"
    )

    turns: ClassVar[bool] = True
    starter: ClassVar[Mapping[str, Any]] = {"toward": [0, 1, -0.35]}

    @model_validator(mode="after")
    def _one_place(self) -> Tie:
        if self.curve is None and self.toward is None and self.each == "head":
            raise refuse("has no place for the tie; give it a curve, toward, or each = 'section'")
        if self.curve is not None and (self.toward is not None or self.each == "section"):
            raise refuse("has a curve and also toward or each = 'section'; give one of them")
        return self

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the curves tied, all with ``lock_points`` points or more, with the attribute ``to_tie`` [m]."""
        fine = with_lock_points(curves, context)
        weight = self.weights(fine, context)
        if not weight.any():
            return curves
        shapes = grid(fine).copy()
        tied = curves.curve.get(TO_TIE, np.zeros(len(curves), np.float32)).copy()
        affected: NDArray[np.bool_] = np.any(weight > 0.0, axis=1)
        for tie in self._ties(fine, affected, context):
            shapes[tie.rows], tied[tie.rows] = self._tied(fine.take(tie.rows), tie, context)
        result = self.blended(fine, shapes, weight)
        return Curves(result.points, result.offsets, result.ids, {**result.curve, TO_TIE: tied}, result.point)

    def worn(self, before: Curves, after: Curves, context: Context) -> list[Worn]:
        """The bands around the hair in the ties, with their beads, which the roots nearest to them carry."""
        affected: NDArray[np.bool_] = np.any(self.weights(before, context) > 0.0, axis=1)
        made = []
        for k, tie in enumerate(self._ties(before, affected, context)):
            if (band := tie.value["band"]) == 0.0:
                continue
            name, radius, bead = f"{context.purpose} {k}", tie.value["radius"], tie.value["bead"]
            color = chosen_color(self.colors or BAND, name, context)
            meshes = [revolved(name, tie.place, tie.axis, ring(radius, band, band), color)]
            if bead > 0.0:
                for side, (place, axis) in enumerate(tie.beads(radius + band + 0.5 * bead, bead)):
                    meshes.append(revolved(f"{name} {side}", place, axis, ball(bead, HOLE * bead), color))
            away = np.linalg.norm(after.roots[tie.rows] - tie.place, axis=1)
            nearest = tie.rows[np.argsort(away, kind="stable")[:CARRIERS]]
            made += [Worn.around(mesh, after, nearest, np.zeros(1)) for mesh in meshes]
        return made

    def _ties(self, curves: Curves, affected: NDArray[np.bool_], context: Context) -> Iterator[Place]:
        """The ties with the rows of their locks, among those that are affected."""
        rows, scalp = np.flatnonzero(affected), context.scalp
        if not len(rows):
            return
        if self.curve is not None:
            helpers = context.helper(self.curve, "curve")
            nearest = np.linalg.norm(curves.roots[rows, None] - helpers.roots[None], axis=2).argmin(axis=1)
            for k in range(len(helpers)):
                line = np.asarray(helpers[k], np.float64)
                if (nearest == k).any():
                    value = self._values(line[0], int(helpers.ids[k]), context)
                    yield Place(rows[nearest == k], line[0], unit(line[1] - line[0]), line, value)
            return
        if self.each == "head":
            yield self._over(rows, unit(np.array(self.toward)), 0, context)
            return
        if SECTION not in curves.curve:
            raise UserError(f"{context.purpose}.each is 'section', but there are none; add [locks.sections]")
        section = curves.curve[SECTION][rows]
        for one in np.unique(section[section >= 0]):
            within = rows[section == one]
            middle = unit(unit(curves.roots[within] - scalp.middle).mean(axis=0))
            toward = 0.0 if self.toward is None else np.array(self.toward)
            yield self._over(within, unit(middle + toward), int(one), context)

    def _over(self, rows: NDArray, direction: NDArray, number: int, context: Context) -> Place:
        """The tie in a direction from the middle of the scalp."""
        scalp = context.scalp
        size = float(np.ptp(scalp.points, axis=0).max())
        probes = scalp.middle + np.linspace(0.0, size, 400)[:, None] * direction
        inside = np.flatnonzero(np.asarray(scalp.solid.above(np.ascontiguousarray(probes))[0]) <= 0.0)
        foot, normal = scalp.nearest(probes[inside[-1:] if len(inside) else [0]])
        value = self._values(foot[0], number, context)
        return Place(rows, foot[0] + value["off"] * normal[0], normal[0], None, value)

    def _values(self, place: NDArray, number: int, context: Context) -> dict[str, float]:
        """The values of a tie, as those of a lock with its number that grows at the place of the scalp under it."""
        curve = Curves(np.array([place], np.float64), np.array([0, 1], np.int32), np.array([number], np.int64))
        under = context.scalp.bind(curve, np.inf, context.purpose)
        return {name: float(context.values(self, name, under)[0]) for name in PER_TIE}

    def _tied(self, curves: Curves, tie: Place, context: Context) -> tuple[NDArray[np.floating], NDArray[np.floating]]:
        """Locks after they are tied, shape (count, points, 3), and their lengths up to the tie [m], shape (count,)."""
        points, disk = grid(curves), self._disk(curves.ids, context)
        offset = disk @ np.stack(tie.axes(context.scalp.middle))
        over_head = self._over_head(curves, tie.place + tie.value["radius"] * offset, context)
        tied = arc_lengths(over_head)[:, -1]
        if self.after == "tail":
            flare = context.values(self, "flare", curves)
            whole = np.concatenate([over_head, self._tail(points, offset, flare, tie)[:, 1:]], axis=1)
            return at_lengths(whole, arc_lengths(points)), tied
        after = self._ball(disk, offset, tie) if self.after == "ball" else self._bun(offset, tie, context)
        whole = np.concatenate([over_head, after[:, 1:]], axis=1)
        length = arc_lengths(whole)[:, -1]
        along = length[:, None] * np.linspace(0.0, 1.0, points.shape[1])
        return at_lengths(whole, along), (length if self.after == "bun" else tied)

    def _disk(self, ids: NDArray, context: Context) -> NDArray[np.float64]:
        """Place of each lock in the unit disk, random by its id and evenly spread, shape (count, 2)."""
        random = context.random("place")
        angle, radius = 2.0 * np.pi * random.uniform(ids, 0), np.sqrt(random.uniform(ids, 1))
        return radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)

    def _over_head(self, curves: Curves, ties: NDArray, context: Context) -> NDArray[np.float64]:
        """Paths over the skin from roots to places in the tie (count, 3); shape (count, PATH_POINTS, 3)."""
        scalp, t, roots = context.scalp, np.linspace(0.0, 1.0, PATH_POINTS), curves.roots
        path = _around(roots, ties, scalp.middle, t)
        foot, normal = (found.reshape(path.shape) for found in scalp.nearest(path.reshape(-1, 3)))
        height = np.asarray(scalp.solid.above(np.ascontiguousarray(ties))[0])
        layer = 0.3 + 0.7 * context.random("layer").uniform(curves.ids)
        rise = (context.values(self, "rise", curves) * layer)[:, None] * self.rise.along(t)
        raised = height[:, None] * t**4 + rise * np.sin(np.pi * t)
        path = foot
        for _ in range(SMOOTHING):
            path[:, 1:-1] = 0.25 * (path[:, :-2] + path[:, 2:]) + 0.5 * path[:, 1:-1]
        path = path + raised[:, :, None] * normal
        near = np.clip((t - 0.7) / 0.3, 0.0, 1.0)  # the last piece ends at the place in the tie
        path += (near * near * (3.0 - 2.0 * near))[None, :, None] * (ties - path[:, -1])[:, None]
        path[:, 0] = roots
        return path

    def _tail(self, points: NDArray, offset: NDArray, flare: NDArray, tie: Place) -> NDArray[np.float64]:
        """Paths of a tail, shape (count, k, 3), for the flare of each lock, shape (count,)."""
        lines = None if tie.line is None else tie.line[None]
        if lines is None:
            run = np.linspace(0.0, max(1.1 * float(arc_lengths(points)[:, -1].max()), 1e-3), 3 * PATH_POINTS)
            out = np.radians(tie.value["splay"]) * np.linalg.norm(offset, axis=1, keepdims=True)
            leaving = np.cos(out) * tie.axis + np.sin(out) * unit(offset)
            direction = unit(leaving[:, None] - (run / tie.value["fall"])[None, :, None] * UP)
            lines = tie.place + np.cumsum(direction * np.diff(run, prepend=0.0)[None, :, None], axis=1)
        wider = (flare - 1.0)[:, None] * self.flare.along(np.linspace(0.0, 1.0, lines.shape[1]))
        width = tie.value["radius"] * np.maximum(1.0 + wider, 0.0)
        tail: NDArray[np.float64] = lines + width[:, :, None] * offset[:, None, :]
        return tail

    def _ball(self, disk: NDArray, offset: NDArray, tie: Place) -> NDArray[np.float64]:
        """Paths from the tie to the surface of a sphere, evenly spread over it; shape (count, PATH_POINTS, 3)."""
        ball = 0.5 * tie.value["width"]
        out = np.linalg.norm(disk, axis=1)
        cosine = 1.0 - out**2 * (1.0 - UNDERSIDE)  # keeps areas
        radial = unit(offset)
        direction = cosine[:, None] * tie.axis + np.sqrt(1.0 - cosine**2)[:, None] * radial
        start = tie.place + tie.value["radius"] * offset
        end = tie.place + CENTRE * ball * tie.axis + ball * direction
        span = np.linalg.norm(end - start, axis=1, keepdims=True)
        leaving = span * unit(tie.axis + 0.8 * out[:, None] * radial)
        t = np.linspace(0.0, 1.0, PATH_POINTS)[None, :, None]
        leaving, arriving = leaving[:, None], (0.8 * span * direction)[:, None]
        path: NDArray[np.float64] = (
            (2 * t**3 - 3 * t**2 + 1) * start[:, None]
            + (t**3 - 2 * t**2 + t) * leaving
            + (3 * t**2 - 2 * t**3) * end[:, None]
            + (t**3 - t**2) * arriving
        )
        return path

    def _bun(self, offset: NDArray, tie: Place, context: Context) -> NDArray[np.float64]:
        """Paths of the locks of a rope that is wound around the tie, shape (count, k, 3)."""
        coil = Coil.fitted(*(tie.value[name] for name in ("width", "height", "windings")))
        line = on_scalp(coil.path(), tie.place, tie.axis, context.scalp)
        height = (line - tie.place) @ tie.axis
        line = np.concatenate([tie.place[None], line[int(np.argmax(height > 0.5 * coil.rope)) :]])
        line = at_lengths(line[None], np.linspace(0.0, arc_lengths(line[None])[0, -1], 200)[None])[0]
        first = np.ascontiguousarray(tie.axes(context.scalp.middle)[0][None])
        frames = _core.curve_frames(line, np.array([0, len(line)], np.int32), first)
        axes = np.stack(tie.axes(context.scalp.middle))
        place = offset @ axes.T
        along = np.linspace(0.0, 1.0, len(line))
        grow = np.clip(along / 0.1, 0.0, 1.0)
        close = np.sqrt(np.clip((1.0 - along) / 0.06, 0.0, 1.0))  # the end is tucked in
        radius = tie.value["radius"]
        size = (radius + grow * (0.95 * coil.rope - radius)) * close
        path: NDArray[np.float64] = line + size[None, :, None] * np.einsum("nk,pxk->npx", place, frames[:, :, :2])
        return path


@dataclass(frozen=True)
class Place:
    """A tie: rows of its locks, its place [m], the unit axis of the hair in it, the line of its tail or None, and the
    values of its settings."""

    rows: NDArray[np.integer]
    place: NDArray[np.float64]
    axis: NDArray[np.float64]
    line: NDArray[np.float64] | None
    value: Mapping[str, float]

    def axes(self, middle: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Two unit axes of the cross-section."""
        along = self.axis if self.line is None else unit(self.line[-1] - self.line[0])
        across = unit(np.cross(along, unit(middle - self.place) + 1e-3))
        return across, unit(np.cross(across, along))

    def beads(self, away: float, width: float) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """Places of two beads side by side on the upper side of the tie, away from its axis [m], and their axes."""
        upper = UP + NEARLY  # a tie at the crown has an upper side, too
        up = unit(upper - (upper @ self.axis) * self.axis)
        across, half = np.cross(self.axis, up), np.arcsin(min(0.5 * width / away, 1.0))
        turns = [(np.cos(turn), np.sin(turn)) for turn in (-half, half)]
        return [(self.place + away * (c * up + s * across), c * across - s * up) for c, s in turns]


def _around(roots: NDArray, ties: NDArray, middle: NDArray, t: NDArray) -> NDArray[np.float64]:
    """Spherical interpolation about a middle from roots to ties (count, 3), shape (count, len(t), 3)."""
    from_middle, to_middle = roots - middle, ties - middle
    a, b = unit(from_middle), unit(to_middle)
    angle = np.arccos(np.clip(np.sum(a * b, axis=1), -1.0, 1.0))[:, None, None]
    near = np.sin(angle) < 1e-6
    sine = np.where(near, 1.0, np.sin(angle))
    u = t[None, :, None]
    first = np.where(near, 1.0 - u, np.sin((1.0 - u) * angle) / sine)
    last = np.where(near, u, np.sin(u * angle) / sine)
    direction = unit(first * a[:, None] + last * b[:, None])
    start, end = (np.linalg.norm(v, axis=1)[:, None] for v in (from_middle, to_middle))
    return middle + ((1.0 - t) * start + t * end)[:, :, None] * direction
