"""Rows: lines on the scalp that cornrows follow, and how far hair comes to them from both sides."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import SECTION
from ringlet.groom.operators.operator import evenly
from ringlet.groom.scalp import Scalp
from ringlet.groom.sections import Division, V

SAMPLES_A_SIDE = 8  # of the scalp, per width of a section
BIN = 0.5  # length of a row whose samples are averaged, in widths of a section
SPACING = 1.5e-3  # [m] of the points of a row
PASSES = 30  # of smoothing
LEAST = 0.5  # length of a row, in widths of a section


@dataclass(frozen=True)
class Row:
    """A line on the scalp from front to back.

    points, normals: evenly spaced places [m] and the normals of the scalp there, shape (k, 3) each
    """

    points: NDArray[np.float64]
    normals: NDArray[np.float64]

    @classmethod
    def of(cls, line: NDArray, scalp: Scalp) -> Row:
        """The projection of a line (k, 3) [m] on the scalp."""
        count = max(8, int(np.linalg.norm(np.diff(line, axis=0), axis=1).sum() / SPACING))
        fine = evenly(line, count)
        triangle, barycentric, _ = _core.bind_roots(scalp.points, scalp.triangles, fine, scalp.region)
        places, frames = _core.root_frames(scalp.points, scalp.triangles, triangle, barycentric)
        return cls(places, _smooth(frames[:, :, 2]))

    @property
    def length(self) -> float:
        """Length [m]."""
        return float(np.linalg.norm(np.diff(self.points, axis=0), axis=1).sum())

    def where(self, grows: NDArray[np.bool_]) -> Row:
        """The row from the first to the last of its points at which hair grows, shape (k,); empty if at none."""
        found = np.flatnonzero(grows)
        kept = slice(found[0], found[-1] + 1) if len(found) else slice(0)
        return Row(self.points[kept], self.normals[kept])

    def shortened(self, end: float) -> Row:
        """The row without an end of that length [m]; a half of it stays."""
        count = len(self.points)
        kept = max(count // 2, round(count * (1.0 - end / max(self.length, 1e-9))))
        return Row(self.points[:kept], self.normals[:kept])


def middle_rows(division: Division, scalp: Scalp) -> dict[int, Row]:
    """The row along the middle of each section, from its front to its back."""
    size = division.sections.size
    _, triangle, barycentric = scalp.sample(
        scalp.count_for_spacing(size / SAMPLES_A_SIDE, "locks.sections.size"), division.seed
    )
    places = scalp.positions(triangle, barycentric)
    at = division.at(places)
    rows = {}
    for section in np.unique(at[SECTION][at[SECTION] >= 0]):
        own = at[SECTION] == section
        line = _middle_line(places[own], at[V][own], BIN * size)
        if line is None:
            continue
        row = Row.of(line, scalp)
        if (row := row.where(division.grows(row.points))).length >= LEAST * size:
            rows[int(section)] = row
    return rows


def drawn_rows(curves: Curves, division: Division, scalp: Scalp, what: str) -> dict[int, Row]:
    """Rows along drawn curves, by the section that most of each lies in; raises UserError for two in one section."""
    rows: dict[int, Row] = {}
    for k in range(len(curves)):
        row = Row.of(np.asarray(curves[k], np.float64), scalp)
        row = row.where(division.grows(row.points))
        section = division.at(row.points)[SECTION]
        if not (section >= 0).any():
            continue
        names, count = np.unique(section[section >= 0], return_counts=True)
        name = int(names[count.argmax()])
        if name in rows:
            raise UserError(
                f"{what}: curve {curves.ids[k]} runs in section {name}, as another one does; "
                "draw a part line between them, or remove one"
            )
        rows[name] = row
    return rows


def _middle_line(places: NDArray, v: NDArray, step: float) -> NDArray[np.float64] | None:
    """The smoothed means of places (n, 3) [m] along v, which falls to the back; None for too few places."""
    order = np.argsort(-v, kind="stable")
    places = places[order]
    # Lengths along the section from samples ordered by v: the distances of means of many.
    rough = max(2, len(places) // 12)
    means = np.array([block.mean(axis=0) for block in np.array_split(places, rough)])
    length = float(np.linalg.norm(np.diff(_smooth(means), axis=0), axis=1).sum())
    count = max(3, round(length / step))
    if len(places) < 2 * count:
        return None
    level = np.linspace(v.max(), v.min(), count + 1)
    bins = np.clip(np.searchsorted(-level, -v[order], side="right") - 1, 0, count - 1)
    kept = np.unique(bins)
    kept = max(np.split(kept, np.flatnonzero(np.diff(kept) > 1) + 1), key=len)
    if len(kept) < 2:
        return None
    line = np.array([places[bins == k].mean(axis=0) for k in kept])
    first, last = 0.45 * (line[0] - line[1]), 0.45 * (line[-1] - line[-2])
    line = np.concatenate([[line[0] + first], line, [line[-1] + last]])
    fine = evenly(line, 8 * len(line))
    return _smooth(fine)


def _smooth(values: NDArray) -> NDArray[np.float64]:
    """Values along a line, shape (k, 3), smoothed; both ends stay."""
    values = np.array(values, np.float64)
    for _ in range(PASSES):
        values[1:-1] = 0.25 * (values[:-2] + values[2:]) + 0.5 * values[1:-1]
    return values
