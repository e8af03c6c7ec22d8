"""Sections of the scalp: the parts between part lines, from each of which a braid, a twist or a loose strand grows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator
from scipy.spatial import KDTree

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import SECTION
from ringlet.data.quantities import Quantity, Section, refuse
from ringlet.data.random import Random
from ringlet.groom.drawn_part_lines import DrawnPartLines
from ringlet.groom.helpers import Names
from ringlet.groom.mask import Mask
from ringlet.groom.scalp import Scalp

MOST_CELLS = 4096  # along each axis of the chart, so that a section's id fits 24 bits
SAMPLES_A_SIDE = 6  # of the scalp, per side of a section
WHOLE = 0.35  # a cell with less than this part of the usual area, or a row of the usual width, belongs to its neighbour
FLATTEST = 20.0  # radius of the sphere through a flat scalp, in sizes of the scalp
NEARER = 3  # tries of strands to grow: at their place, and nearer to the middle by a half each
STRANDS_APART = 0.1  # distance of a section's strands from its middle at the scalp, in sizes of the section

# Further curve attributes of locks in sections: which of its strands; place in the section, 0 to 1 each; distance
# from the section's border [m]. ``AREA`` is that whose hair a strand carries, part lines included [m²]; 0 for others.
STRAND, U, V, EDGE, AREA = "strand", "u", "v", "edge", "area"


class Sections(Section):
    """Divides the scalp into sections. The pattern lies in a chart of the scalp that keeps areas: the projection of
    Lambert from the sphere that fits it best, with the mean normal in the middle of the chart."""

    pattern: Literal["grid", "brick", "rows", "triangles", "radial", "drawn"] = Field(
        default="brick",
        description="pattern of the sections: squares, squares in bond (brick), rows from front to back, "
        "triangles, rings, or what lies between drawn `part_lines`",
    )
    part_lines: Names | None = Field(
        default=None,
        description="of the pattern `drawn`: names of helper curves along the part lines, from `[curves]`; they "
        "are projected onto the scalp and extended by a quarter of the size",
    )
    size: Annotated[float, Quantity("m", 2e-3, 1.0)] = Field(
        default=0.025, description="width of a section; of drawn ones, about that of the smallest"
    )
    gap: Annotated[float, Quantity("m", 0.0, 0.1)] = Field(
        default=0.002, description="width of the visible part line between sections, where nothing grows"
    )
    jitter: Annotated[float, Quantity("", 0.0, 1.0)] = Field(
        default=0.0, description="how much part lines wander, relative to the size"
    )
    turn: Annotated[float, Quantity("deg", -180.0, 180.0)] = Field(default=0.0, description="rotation of the pattern")
    strands: int | None = Field(
        default=None,
        ge=1,
        le=12,
        description="locks that grow from each section, for a braid or a twist; loose hair when absent. Outside of the "
        "sections, locks grow only where `count` or `spacing` says how many",
    )
    mask: Annotated[Mask, Quantity("", 0.0, 1.0)] = Field(
        default=Mask(),
        description="where there are sections: those with a weight over a half at their middle. They end where its "
        "`map` is half",
    )

    @model_validator(mode="after")
    def _has_part_lines(self) -> Sections:
        if (self.pattern == "drawn") != (self.part_lines is not None):
            raise refuse("needs both pattern = 'drawn' and 'part_lines', or none of them; name curves of [curves]")
        return self

    def divide(
        self, scalp: Scalp, seed: int, helper: Callable[[Names, str], Curves], density: str | None = None
    ) -> Division:
        """Divides the region of the scalp, as far as a painted density is over 0 and the map of the mask over a half.

        helper: returns the helper curves of a name for a setting
        """
        chart = Chart.of(scalp)
        _, triangle, barycentric = scalp.sample(
            scalp.count_for_spacing(self.size / SAMPLES_A_SIDE, "locks.sections.size"), seed
        )
        places = scalp.positions(triangle, barycentric)

        def grows(places: NDArray) -> NDArray[np.bool_]:
            grow = scalp.grows(places, density, "locks.density")
            if self.mask.map is not None:
                over = scalp.painted_at(places, self.mask.map, "locks.sections.mask.map") > 0.5
                grow &= over != self.mask.invert
            return grow

        painted = grows(places)
        if not painted.any():
            what = f"locks.density '{density}'" if self.mask.map is None else f"locks.sections.mask '{self.mask.map}'"
            raise UserError(f"{what} is 0 all over {scalp.where}; paint where hair is to grow")
        places, triangle, barycentric = places[painted], triangle[painted], barycentric[painted]
        drawn = None
        if self.part_lines is not None:
            curves = helper(self.part_lines, "sections.part_lines")
            lines = [chart.flat(np.asarray(curves[k], np.float64)) for k in range(len(curves))]
            drawn = DrawnPartLines(lines, chart.flat(places), self.size)
        cells = self._cells(chart, places, seed, drawn)
        merged = Merged(cells.key, places, 0.0 if drawn else WHOLE, along=cells.v if self.pattern == "rows" else None)
        ids, section = np.unique(merged.sections(cells.key, places), return_inverse=True)
        middle = np.array([places[section == k].mean(axis=0) for k in range(len(ids))])
        _, nearest = KDTree(places).query(middle)
        bound = {"root_triangle": triangle[nearest], "root_barycentric": barycentric[nearest]}
        roots = Curves(places[nearest], np.arange(len(ids) + 1, dtype=np.int32), ids.astype(np.int64), bound)
        chosen = self.mask.weights(roots, scalp.mesh, Random(seed, "locks/sections"), "locks.sections.mask")[:, 0] > 0.5
        area = float(scalp.area) / len(painted)
        areas = np.bincount(section, minlength=len(ids)).astype(np.float64) * area
        return Division(self, chart, seed, merged, roots, areas, chosen, grows, drawn)

    def _cells(self, chart: Chart, places: NDArray, seed: int, drawn: DrawnPartLines | None) -> Cells:
        """The pattern's cells at places (n, 3) [m]."""
        if drawn is not None:
            name, at, edge = drawn.at(chart.flat(places))
            return Cells(name, at[:, 0], at[:, 1], edge / self.size)
        flat = chart.flat(places) / self.size
        if self.jitter > 0.0:
            wander = [Random(seed, f"sections/{k}").field(places, 1.5 * self.size) for k in range(2)]
            flat = flat + 0.5 * self.jitter * np.stack(wander, axis=1)
        turn = np.radians(self.turn)
        x, y = (flat @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])).T
        return Cells.of(self.pattern, x, y, 2.0 * chart.radius / self.size)


@dataclass(frozen=True)
class Chart:
    """A map of the scalp to a plane: Lambert's azimuthal projection, which keeps areas [m]."""

    middle: NDArray[np.float64]  # of the sphere [m]
    radius: float  # [m]
    axes: NDArray[np.float64]  # rows: across, forward, and the direction of the chart's middle

    @classmethod
    def of(cls, scalp: Scalp) -> Chart:
        """The chart of a scalp's region."""
        corners = scalp.points[scalp.triangles[scalp.region]]
        up = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]).sum(axis=0)
        up /= np.linalg.norm(up)
        forward = np.eye(3)[2 if abs(up[2]) < 0.9 else 1]
        forward = forward - (forward @ up) * up
        forward /= np.linalg.norm(forward)
        middle, radius = _fitted_sphere(scalp.points[np.unique(scalp.triangles[scalp.region])], up)
        return cls(middle, radius, np.stack([np.cross(forward, up), forward, up]))

    def flat(self, places: NDArray) -> NDArray[np.float64]:
        """Coordinates across and forward of places (n, 3) [m], shape (n, 2)."""
        direction = places - self.middle
        direction /= np.maximum(np.linalg.norm(direction, axis=1, keepdims=True), 1e-12)
        x, y, z = self.axes @ direction.T
        return self.radius * np.sqrt(2.0 / np.maximum(1.0 + z, 1e-6))[:, None] * np.stack([x, y], axis=1)


@dataclass(frozen=True)
class Cells:
    """The cells of a pattern at some places, in units of the size.

    key: names of the cells, shape (n,)
    u, v: places within them, 0 to 1, shape (n,)
    edge: distances from their borders, shape (n,)
    """

    key: NDArray[np.int64]
    u: NDArray[np.float64]
    v: NDArray[np.float64]
    edge: NDArray[np.float64]

    @classmethod
    def of(cls, pattern: str, x: NDArray, y: NDArray, reach: float) -> Cells:
        """The cells of a pattern at coordinates x and y, shape (n,), from −reach to reach."""
        match pattern:
            case "triangles":
                return cls._triangles(x, y)
            case "radial":
                return cls._rings(x, y)
        j = np.zeros(len(y)) if pattern == "rows" else np.floor(y)
        x = x + 0.5 * (j % 2) if pattern == "brick" else x
        i = np.floor(x)
        u, v = x - i, 0.5 + 0.5 * y / reach if pattern == "rows" else y - j
        edge = np.minimum(u, 1.0 - u)
        return cls(_key(i, j), u, v, edge if pattern == "rows" else np.minimum(edge, np.minimum(v, 1.0 - v)))

    @classmethod
    def _triangles(cls, x: NDArray, y: NDArray) -> Cells:
        height = np.sqrt(0.75)
        y = y / height
        x = x - 0.5 * y
        i, j = np.floor(x), np.floor(y)
        u, v = x - i, y - j
        upper = u + v > 1.0
        u, v = np.where(upper, 1.0 - u, u), np.where(upper, 1.0 - v, v)
        return cls(_key(2 * i + upper, j), u, v, height * np.minimum(np.minimum(u, v), 1.0 - u - v))

    @classmethod
    def _rings(cls, x: NDArray, y: NDArray) -> Cells:
        radius = np.hypot(x, y)
        ring = np.floor(radius)
        around = np.where(ring == 0, 1.0, np.round(2.0 * np.pi * (ring + 0.5)))
        turn = (np.arctan2(y, x) / (2.0 * np.pi)) % 1.0 * around
        i = np.minimum(np.floor(turn), around - 1.0)
        u, v = turn - i, radius - ring
        to_sector_border = np.where(ring == 0, np.inf, np.minimum(u, 1.0 - u) * 2.0 * np.pi * radius / around)
        to_ring_border = np.where(ring == 0, 1.0 - v, np.minimum(v, 1.0 - v))
        return cls(_key(i, ring), u, v, np.minimum(to_sector_border, to_ring_border))


@dataclass(frozen=True)
class Division:
    """A scalp divided into sections.

    roots:  the middles of the sections, as curves of one point named by the sections' ids
    areas:  of the sections with their half of the part lines [m²], shape (sections,)
    chosen: whether the mask has the section, shape (sections,)
    grows:  whether hair grows at places (n, 3) [m] by the painted density, shape (n,)
    """

    sections: Sections
    chart: Chart
    seed: int
    merged: Merged
    roots: Curves
    areas: NDArray[np.float64]
    chosen: NDArray[np.bool_]
    grows: Callable[[NDArray], NDArray[np.bool_]]
    drawn: DrawnPartLines | None = None

    def at(self, places: NDArray) -> dict[str, NDArray]:
        """Attributes of places (n, 3) [m] in their sections, shape (n,) each; section −1 where the mask has none, and
        where no hair grows."""
        cells = self.sections._cells(self.chart, places, self.seed, self.drawn)
        section = self.merged.sections(cells.key, places)
        has = self.chosen[np.searchsorted(self.roots.ids, section)] & self.grows(places)
        return {
            SECTION: np.where(has, section, -1).astype(np.int32),
            U: cells.u.astype(np.float32),
            V: cells.v.astype(np.float32),
            EDGE: (cells.edge * self.sections.size).astype(np.float32),
        }

    def loose(self, at: dict[str, NDArray]) -> NDArray[np.bool_]:
        """Whether hair of ``count`` grows at such places: on no part line, and in no section that has strands."""
        outside = at[SECTION] < 0
        return outside | ((at[EDGE] >= 0.5 * self.sections.gap) & (self.sections.strands is None))

    def strand_roots(self, scalp: Scalp) -> tuple[NDArray[np.int32], NDArray[np.float64], dict[str, NDArray]]:
        """Where the strands of the chosen sections grow: triangles (n,), barycentrics (n, 3), attributes (n,) each.

        Strands come nearer to the middle of their section where hair does not grow at all of their roots; a section in
        which they would still not grow has none.
        """
        roots, strands = self.roots.take(self.chosen), self.sections.strands or 0
        frames = scalp.frames(roots)
        angle = 2.0 * np.pi * np.arange(strands) / max(strands, 1)
        apart = STRANDS_APART * self.sections.size if strands > 1 else 0.0
        around = apart * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        offsets = np.einsum("sxk,nk->snx", frames[:, :, :2], around)
        grow = np.zeros(len(roots), np.bool_)
        for _ in range(NEARER):
            wanted = (roots.points[:, None] + offsets).reshape(-1, 3)
            grow = np.asarray(self.grows(wanted).reshape(len(roots), strands).all(axis=1))
            offsets[~grow] *= 0.5
        roots, places = roots.take(grow), (roots.points[:, None] + offsets)[grow]
        region = np.ascontiguousarray(scalp.region, np.int32)
        flat = np.ascontiguousarray(places.reshape(-1, 3))
        triangle, barycentric, _ = _core.bind_roots(scalp.points, scalp.triangles, flat, region)
        section = np.repeat(roots.ids, strands)
        area = np.repeat(self.areas[np.searchsorted(self.roots.ids, roots.ids)] / max(strands, 1), strands)
        strand = np.tile(np.arange(strands), len(roots))
        at = self.at(scalp.positions(triangle, barycentric))
        return (
            triangle,
            barycentric,
            {
                **at,
                SECTION: section.astype(np.int32),
                STRAND: strand.astype(np.int32),
                AREA: area.astype(np.float32),
            },
        )


class Merged:
    """The section of each cell: its own, or the nearest where the scalp's border leaves little of the cell."""

    def __init__(self, key: NDArray, places: NDArray, least: float, along: NDArray | None = None) -> None:
        """From the cells, shape (n,), of samples of the scalp at places (n, 3) [m].

        least: part of the usual area below which a cell belongs to its neighbour
        along: places along rows, shape (n,): a row is as long as the scalp allows, so that mean widths are compared
        """
        keys, cell, count = np.unique(key, return_inverse=True, return_counts=True)
        middle = np.stack([np.bincount(cell, places[:, k]) / count for k in range(3)], axis=1)
        extent = count if along is None else count / np.maximum(_ranges(along, cell), 1e-9)
        whole = extent >= least * np.median(extent)
        self._sections, self._nearest = keys[whole], KDTree(middle[whole])

    def sections(self, key: NDArray, places: NDArray) -> NDArray[np.int64]:
        """Sections of places (n, 3) [m] in cells (n,)."""
        row = np.minimum(np.searchsorted(self._sections, key), len(self._sections) - 1)
        return np.where(self._sections[row] == key, key, self._sections[self._nearest.query(places)[1]])


def _ranges(values: NDArray, cell: NDArray) -> NDArray[np.float64]:
    """Largest less smallest value in each cell, shape (cells,); values and cells, 0, 1, …, have shape (n,)."""
    order = np.argsort(cell, kind="stable")
    first = np.flatnonzero(np.diff(cell[order], prepend=-1))
    return np.maximum.reduceat(values[order], first) - np.minimum.reduceat(values[order], first)


def _key(i: NDArray, j: NDArray) -> NDArray[np.int64]:
    """One number for a pair of whole numbers, each taken modulo MOST_CELLS."""
    half = MOST_CELLS // 2
    return ((i.astype(np.int64) + half) % MOST_CELLS) * MOST_CELLS + (j.astype(np.int64) + half) % MOST_CELLS


def _fitted_sphere(points: NDArray, up: NDArray) -> tuple[NDArray[np.float64], float]:
    """Middle and radius of the sphere closest to points (n, 3) [m], by least squares; a flat set gets a large one."""
    origin = points.mean(axis=0)
    local = points - origin
    size = float(np.ptp(points, axis=0).max())
    system = np.c_[2.0 * local, np.ones(len(local))]
    solution = np.linalg.lstsq(system, np.sum(local * local, axis=1), rcond=1e-6)[0]
    radius = float(np.sqrt(max(solution[3] + solution[:3] @ solution[:3], 0.0)))
    if not 0.0 < radius < FLATTEST * size or solution[:3] @ up > 0.0:  # flat, or bent the other way
        return origin - FLATTEST * size * up, FLATTEST * size
    return origin + solution[:3], radius
