"""The base class of braids and twists: strands that wind about the middle of their section's locks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from scipy.optimize import linear_sum_assignment

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.errors import Fix, UserError
from ringlet.data.groom import CORE, STRAND_RADIUS, TIED
from ringlet.data.quantities import Quantity, Ramped, Varied
from ringlet.groom import felt, weave
from ringlet.groom.bends import eased
from ringlet.groom.operators.ended import Ended
from ringlet.groom.operators.operator import Context, arc_lengths, evenly, grid, unit
from ringlet.groom.operators.sectioned import Strands
from ringlet.groom.scalp import Scalp

JOIN = "join"  # curve attribute of locks: length along a woven strand after which its hairs come to it [m]
JOINED = 0.5  # place where they do, as a part of the start
EASE = 0.5  # turns over which a braid begins and ends
LEAST_POINTS, GOOD_POINTS = 6, 10  # of a strand, per wave of its path to the front and back
SKIN_MARGIN = 1e-3  # [m] between braids and bodies
SEALED = 0.15  # factor on the width of a braid at a sealed tip


class Woven(Ended):
    """Weaves the strands of each section about a centre line, the mean of their shapes: ``p = c + a x + b z``, with x
    across the braid and z away from the head, in a rotation-minimising frame of c. The centre line is led out of bodies
    and eased where it bends too sharply for the width. The strands come together over ``start`` and run on side by side
    over ``tail``."""

    width: Annotated[Ramped, Quantity("m", 5e-4, 0.2)] = Field(
        default=Ramped(value=0.012),
        description="width of the braid, strands included; its ramp narrows the strands too",
    )
    pitch: Annotated[Ramped | None, Quantity("m", 1e-3, 1.0)] = Field(
        default=None,
        description="length after which a strand is back in its place; a few widths when absent. Larger is a "
        "looser weave",
    )
    tightness: Annotated[Varied, Quantity("", 0.05, 1.0)] = Field(
        default=Varied(value=1.0),
        description="1: strands touch; smaller: they are thinner than their place in the weave",
    )
    start: Annotated[Varied, Quantity("m", 0.0, 1.0)] = Field(
        default=Varied(value=0.01), description="length at the root over which the strands come together"
    )
    simulate: Literal["strands", "core"] = Field(
        default="strands",
        description="in a shot: each strand by itself, held by contact, or the braid as one rod that carries them",
    )

    @property
    def weaving(self) -> weave.Pattern:
        """The pattern of the strands."""
        raise NotImplementedError

    def mirrored(self, leaders: Curves, context: Context) -> NDArray[np.bool_]:
        """Which sections are woven as in a mirror, shape (count,), for a strand of each, named by the section."""
        return np.zeros(len(leaders), np.bool_)

    def depths(self, width: NDArray, leaders: Curves, context: Context) -> NDArray[np.float64]:
        """Depth of braids of that width [m], shape (count,), for a strand of each."""
        raise NotImplementedError

    def pitch_of(self, width: NDArray) -> NDArray[np.float64]:
        """Pitch where none is given [m]."""
        raise NotImplementedError

    def strands(
        self, curves: Curves, leaders: Curves, rows: Sequence[NDArray[np.integer]], context: Context
    ) -> Iterator[Strands]:
        """The strands of each section, woven about their mean."""
        shapes = grid(curves)
        core = {CORE: float(self.simulate == "core")} if self.simulate == "core" or CORE in curves.curve else {}
        for braid in self.braids(curves, leaders, rows, context):
            tied = braid.tied(shapes.shape[1])
            narrows = braid.narrows(np.linspace(0.0, 1.0, felt.KNOTS), self)
            yield Strands(
                braid.rows,
                braid.woven(shapes[braid.rows], context.scalp, self),
                {STRAND_RADIUS: braid.radius, JOIN: JOINED * braid.start * braid.length, **core},
                {TIED: tied} if tied.any() or TIED in curves.point else {},
                narrows if (narrows != 1.0).any() else None,
            )

    def points_needed(self, curves: Curves, context: Context) -> int:
        """Points that the waves of the longest braid need."""
        leaders, rows = self.leaders(curves, self.weights(curves, context) > 0.0)
        return self.points_for(np.array([_length(curves, of) for of in rows]), leaders, rows, context)

    def points_for(
        self, length: NDArray, leaders: Curves, rows: Sequence[NDArray[np.integer]], context: Context
    ) -> int:
        """Points that the waves of braids of these lengths (count,) [m] need."""
        waves = np.array([weave.waves(self.weaving, len(of)) for of in rows])
        return int(np.ceil(GOOD_POINTS * (waves * length / self._pitches(leaders, context)).max(initial=0.0)))

    def _pitches(self, leaders: Curves, context: Context) -> NDArray[np.float64]:
        """Pitch of each braid [m], shape (count,)."""
        given = None if self.pitch is None else context.values(self, "pitch", leaders)
        return self.pitch_of(context.values(self, "width", leaders)) if given is None else given

    def braids(
        self, curves: Curves, leaders: Curves, rows: Sequence[NDArray[np.integer]], context: Context
    ) -> list[Braided]:
        """The braids of sections, for a strand of each and the rows of all."""
        length = np.array([_length(curves, of_section) for of_section in rows])
        values = {k: context.values(self, k, leaders) for k in ("width", "tightness", "start")}
        tail, tie, hold = self.ends(values["width"], leaders, context)
        pitch = self._pitches(leaders, context)
        depths, mirrored = self.depths(values["width"], leaders, context), self.mirrored(leaders, context)
        radius: dict[tuple, float] = {}
        braids = []
        for k, strands in enumerate(rows):
            if reason := weave.refusal(self.weaving, len(strands)):
                raise UserError(f"{context.purpose} {reason}")
            width, depth = values["width"][k], depths[k]
            self._check_points(
                length[k] / pitch[k], weave.waves(self.weaving, len(strands)), grid(curves).shape[1], context
            )
            key = (self.weaving, len(strands), width, depth, pitch[k])
            if key not in radius:
                radius[key] = weave.touching_radius(*key)
            braids.append(
                Braided(
                    rows=strands,
                    pattern=self.weaving,
                    across=0.5 * width - radius[key],
                    front=(0.5 * depth - radius[key]) * (-1.0 if mirrored[k] else 1.0),
                    radius=values["tightness"][k] * radius[key],
                    length=length[k],
                    turns=length[k] / pitch[k],
                    start=min(values["start"][k] / length[k], 0.5),
                    tail=min(tail[k] / length[k], 0.5),
                    tie=tie[k] / length[k],
                    hold=hold[k],
                    seal=width / length[k] if self.end == "burnt" else 0.0,
                )
            )
        return braids

    def _check_points(self, turns: float, waves: int, points: int, context: Context) -> None:
        """Raises UserError for fewer than LEAST_POINTS points a wave."""
        least, good = (int(np.ceil(each * waves * turns)) for each in (LEAST_POINTS, GOOD_POINTS))
        if points < least:
            raise UserError(
                f"locks.points is {points}: too few for the {turns:.1f} turns of {context.purpose}; leave it "
                f"out, or set it to {good} (at least {least}), or raise its pitch",
                [Fix(("locks", "points"), good)],
            )


@dataclass(frozen=True)
class Braided:
    """The strands of one section, and how they are woven.

    rows:          rows of its locks
    across, front: amplitudes of the strands' path [m]
    radius:        of a strand [m]
    length:        of the centre line [m]
    turns:         turns of the path along the whole length, at a ramp of 1
    start, tail:   parts of the length in which strands come together and run on
    tie:           part of the length before the tail in which they are tied
    hold:          factor on the width there
    seal:          part of the length over which strands close to a sealed tip
    """

    rows: NDArray[np.integer]
    pattern: weave.Pattern
    across: float
    front: float
    radius: float
    length: float
    turns: float
    start: float
    tail: float
    tie: float
    hold: float
    seal: float

    def narrows(self, u: NDArray, settings: Woven) -> NDArray[np.float64]:
        """Factor on the width of the braid and of its strands at places u from root (0) to tip (1)."""
        size = settings.width.along(u)
        if self.hold < 1.0:
            step = 0.5 / (felt.KNOTS - 1)  # so that a knot of the profile is where it is narrowest
            end = 1.0 - self.tail
            off = np.maximum(np.maximum(end - self.tie - step - u, u - end - step), 0.0)
            t = np.clip(off / (2.0 * step + self.tie), 0.0, 1.0)
            size = size * (self.hold + (1.0 - self.hold) * t * t * (3.0 - 2.0 * t))
        if self.seal > 0.0:
            t = np.clip((1.0 - u) / self.seal, 0.0, 1.0)
            size = size * np.maximum(np.sqrt(t * (2.0 - t)), SEALED)
        return size

    def tied(self, points: int) -> NDArray[np.bool_]:
        """The points of a strand in the band; at least two where there is a band, shape (points,)."""
        u = np.linspace(0.0, 1.0, points)
        end, step = 1.0 - self.tail, 1.0 / (points - 1)
        return (u <= end + 1e-9) & (u >= end - max(self.tie, 1.5 * step)) & (self.tie > 0.0)

    @property
    def reach(self) -> float:
        """Half its width, strands included [m]."""
        return self.across + self.radius

    def clear(self, line: NDArray, scalp: Scalp) -> NDArray[np.float64]:
        """A centre line (points, 3) [m] outside of bodies by half the width of the braid, less near the root.

        The braid moves as a whole: strands that were moved out one by one would be pressed into each other.
        """
        offsets = np.array([0, len(line)], np.int32)
        return _core.push_out(np.ascontiguousarray(line), offsets, scalp.bodies, self.reach + SKIN_MARGIN)

    def eased(self, line: NDArray, settings: Woven) -> NDArray[np.float64]:
        """A centre line (points, 3) of even spacing [m] without bends that are too sharp for the braid."""
        return eased(line, self.reach * self.narrows(np.linspace(0.0, 1.0, len(line)), settings))

    def woven(self, shapes: NDArray, scalp: Scalp, settings: Woven) -> NDArray[np.float64]:
        """The strands for their shapes (strands, points, 3) [m]."""
        points = shapes.shape[1]
        line = self.eased(evenly(self.clear(evenly(shapes.mean(axis=0), points), scalp), points), settings)
        return self.about(line, *weave.frames(line, scalp.middle), shapes[:, 0] - line[0], settings)

    def about(
        self, line: NDArray, across: NDArray, front: NDArray, offset: NDArray, settings: Woven
    ) -> NDArray[np.float64]:
        """The strands about a centre line (points, 3) with evenly spaced points [m].

        across, front: unit vectors along the line, shape (points, 3) each
        offset:        of the roots from the start of the line [m], shape (strands, 3)
        """
        strands = len(offset)
        u = np.linspace(0.0, 1.0, len(line))
        phase = self._phase(u, settings)
        size = self.narrows(u, settings)

        order = self._order(np.stack([offset @ across[0], offset @ front[0]], axis=1))
        x, z = weave.path(self.pattern, strands, phase[None] + 2.0 * np.pi * order[:, None] / strands)
        path = (size * self.across * x)[..., None] * across + (size * self.front * z)[..., None] * front
        t = np.clip(u / max(self.start, 1e-9), 0.0, 1.0)
        together = (t * t * (3.0 - 2.0 * t))[:, None]
        return line + together * path + (1.0 - together) * offset[:, None]

    def _phase(self, u: NDArray, settings: Woven) -> NDArray[np.float64]:
        """Phase along the braid [rad], shape (points,): constant at both ends, where it eases in and out."""
        rate = np.full(len(u), self.turns)
        if settings.pitch is not None:
            rate /= np.maximum(settings.pitch.along(u), 0.05)
        ease = EASE / max(self.turns, 1e-9)
        into, out = (u - self.start) / ease, (1.0 - self.tail - u) / ease
        t = np.clip(np.minimum(into, out), 0.0, 1.0)
        rate = rate * t * t * (3.0 - 2.0 * t)
        return 2.0 * np.pi * np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(u))])

    def _order(self, roots: NDArray) -> NDArray[np.int64]:
        """Number of each strand in the pattern, so that strands come together without crossing: roots (strands, 2)."""
        strands = len(roots)
        x, z = weave.path(self.pattern, strands, 2.0 * np.pi * np.arange(strands) / strands)
        places = np.stack([self.across * x, self.front * z], axis=1)
        cost = np.linalg.norm(unit(roots)[:, None] - unit(places)[None], axis=2) ** 2
        return linear_sum_assignment(cost)[1]


def _length(curves: Curves, rows: NDArray) -> float:
    """Length of the centre line of some locks [m]."""
    return float(arc_lengths(grid(curves)[rows].mean(axis=0)[None])[0, -1])
