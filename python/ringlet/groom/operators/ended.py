"""Ends of braids: what holds the strands of a section before their tails, and the mesh of it that they carry."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.groom import STRAND_PROFILE, STRAND_RADIUS, TIED
from ringlet.data.mesh import Mesh
from ringlet.data.quantities import Quantity, Varied
from ringlet.groom.color import Color
from ringlet.groom.operators.operator import Context, arc_lengths, grid, unit
from ringlet.groom.operators.sectioned import Sectioned
from ringlet.groom.worn import Worn, chosen_color, revolved, ring, volume

HOLE = 0.5  # width of a bead's hole, relative to its own
PINCH = 0.8  # factor on the width of a braid under a band
BEAD_ROUNDNESS = 0.7  # of the profile of a bead: 1 an ellipse, less a rounded box
BAND, BEAD = ("#26262b",), ("#d9a441",)  # colours without any of the recipe's


class Ended(Sectioned):
    """Ends the strands of each section: ``loose``, ``tied`` with a band, strung with a ``bead`` or more, or ``burnt``
    to a sealed tip."""

    end: Literal["loose", "tied", "bead", "burnt"] = Field(
        default="tied",
        description="what holds the strands before the tail: nothing, a band, or beads in its place; burnt: they "
        "are sealed to a tip, without a tail",
    )
    tail: Annotated[Varied, Quantity("m", 0.0, 1.0)] = Field(
        default=Varied(value=0.02), description="length at the tip that is left unwoven"
    )
    tie: Annotated[Varied, Quantity("m", 0.0, 0.1)] = Field(
        default=Varied(value=0.004),
        description="length before the tail over which a band ties the strands, or to the tip over which they are "
        "sealed: they stay together there in a shot",
    )
    band: Annotated[Varied, Quantity("m", 0.0, 0.02)] = Field(
        default=Varied(value=0.0),
        description="thickness of the band, a mesh that the strands carry; 0: it is not shown",
    )
    bead: Annotated[Varied, Quantity("m", 1e-3, 0.1)] = Field(
        default=Varied(value=0.01), description="width of a bead; strands are narrowed to its hole, half as wide"
    )
    bead_length: Annotated[Varied, Quantity("m", 1e-3, 0.1)] = Field(
        default=Varied(value=0.008), description="length of a bead along the strands"
    )
    beads: Annotated[Varied, Quantity("", 1.0, 20.0)] = Field(
        default=Varied(value=1.0), description="number of beads per section"
    )
    density: Annotated[Varied, Quantity("kg/m³", 0.0, 2e4)] = Field(
        default=Varied(value=1000.0),
        description="density of bands and beads: wood 700, plastic and rubber 1000, glass 2500, brass 8500",
    )
    colors: list[Color] = Field(
        default=[], description="colours of bands and beads, in sRGB: `#rrggbb`; each gets one of them at random"
    )

    def ends(
        self, width: NDArray, leaders: Curves, context: Context
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Lengths of the tails and of what holds the strands before them [m], and the factor on their width there.

        width: of what the strands form [m], shape (count,), as the results

        A strand of each section is given, named by the section.
        """
        value = {k: context.values(self, k, leaders) for k in ("tail", "tie", "band", "bead", "bead_length", "beads")}
        free = np.ones(len(leaders))
        if self.end == "bead":
            hole = HOLE * value["bead"] / width
            return value["tail"], value["bead_length"] * np.round(value["beads"]), np.minimum(hole, 1.0)
        if self.end == "burnt":
            return 0.0 * free, value["tie"], free
        if self.end == "loose":
            return value["tail"], 0.0 * free, free
        return value["tail"], value["tie"], np.where(value["band"] > 0.0, PINCH, 1.0)

    def worn(self, before: Curves, after: Curves, context: Context) -> list[Worn]:
        """The bands and beads that hold the strands."""
        if self.end not in ("tied", "bead") or TIED not in after.point:
            return []
        leaders, rows = self.leaders(before, self.weights(before, context) > 0.0)
        value = {k: context.values(self, k, leaders) for k in ("band", "bead", "bead_length", "beads", "density")}
        tied = after.point[TIED].reshape(len(after), -1) > 0.5
        made: list[Worn] = []
        for k, of in enumerate(rows):
            if not tied[of[0]].any() or (self.end == "tied" and value["band"][k] == 0.0):
                continue
            held, name = Held.of(after, of, tied[of[0]]), f"{context.purpose} {leaders.ids[k]}"
            if self.end == "tied":
                profile = ring(held.radius, value["band"][k], max(value["band"][k], held.length))
                band = revolved(name, held.middle, held.axis, profile, self._color(name, context))
                made.append(held.worn(band, held.radius + value["band"][k], value["density"][k]))
                continue
            bead, count = value["bead"][k], round(value["beads"][k])
            profile = ring(0.5 * HOLE * bead, 0.5 * (1.0 - HOLE) * bead, value["bead_length"][k], BEAD_ROUNDNESS)
            for number in range(count):
                place = held.middle + (number - 0.5 * (count - 1)) * value["bead_length"][k] * held.axis
                one = f"{name} {number}"
                solid = revolved(one, place, held.axis, profile, self._color(one, context))
                made.append(held.worn(solid, 0.5 * bead, value["density"][k]))
        return made

    def _color(self, name: str, context: Context) -> tuple[float, float, float]:
        """The linear colour of a band or a bead of that name."""
        return chosen_color(self.colors or (BEAD if self.end == "bead" else BAND), name, context)


@dataclass(frozen=True)
class Held:
    """Strands of a section where something holds them.

    ids:    of the strands, each as often as it has points there, shape (k,)
    parts:  of their length, shape (k,)
    places: positions there [m], shape (k, 3)
    middle: of these [m]; axis: unit vector along the strands
    radius: around them, and the length over which they are held [m]
    away:   of the places from the axis [m], shape (k,)
    """

    ids: NDArray[np.int64]
    parts: NDArray[np.float64]
    places: NDArray[np.float64]
    middle: NDArray[np.float64]
    axis: NDArray[np.float64]
    radius: float
    length: float
    away: NDArray[np.float64]

    @classmethod
    def of(cls, curves: Curves, rows: NDArray[np.integer], held: NDArray[np.bool_]) -> Held:
        """The strands in rows of curves with equal point counts, at their points that are held, shape (points,)."""
        points = grid(curves)[rows]
        run = arc_lengths(points)
        line = points[:, held].mean(axis=0)
        axis, middle = unit(line[-1] - line[0]), 0.5 * (line[0] + line[-1])
        off = points[:, held] - middle
        away = np.linalg.norm(off - (off @ axis)[..., None] * axis, axis=2)
        return cls(
            ids=np.repeat(curves.ids[rows], int(held.sum())),
            parts=(run[:, held] / run[:, -1:]).ravel(),
            places=np.asarray(points[:, held], np.float64).reshape(-1, 3),
            middle=middle,
            axis=axis,
            radius=float((away + _radii(curves, rows, held)).max()),
            length=float(np.linalg.norm(line[-1] - line[0])),
            away=away.ravel(),
        )

    def worn(self, mesh: Mesh, radius: float, density: float) -> Worn:
        """A closed mesh that the strands carry, of an outer radius [m] and a density [kg/m³]."""
        return Worn(
            mesh, self.ids, self.parts, self.places, np.maximum(radius - self.away, 0.0), density * volume(mesh)
        )


def _radii(curves: Curves, rows: NDArray[np.integer], held: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Radii of strands at their points that are held [m], shape (strands, k)."""
    radius = np.asarray(curves.curve[STRAND_RADIUS][rows], np.float64)[:, None]
    if STRAND_PROFILE not in curves.curve:
        return np.broadcast_to(radius, (len(rows), int(held.sum())))
    profile = np.asarray(curves.curve[STRAND_PROFILE][rows], np.float64)
    u = np.linspace(0.0, 1.0, len(held))[held]
    return radius * np.array([np.interp(u, np.linspace(0.0, 1.0, profile.shape[1]), one) for one in profile])
