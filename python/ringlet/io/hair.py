"""Cem Yuksel's .hair files: hair models as plain arrays.

Format: http://www.cemyuksel.com/research/hairmodels/. A file stores neither its unit nor its up-axis.
"""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ringlet.data import limits
from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.reads import record
from ringlet.data.regular import read_bytes
from ringlet.data.stage import StageSpace
from ringlet.io.space import check_points, from_metres, to_metres

HEADER = struct.Struct(
    "<4sIIIIff3f88s"
)  # magic, hairs, points, arrays, segments, thickness, transparency, colour, text
SEGMENTS, POINTS, THICKNESS, TRANSPARENCY, COLOR = (1 << bit for bit in range(5))
MOST_SEGMENTS = 2**16 - 1  # of a hair
PLAIN = (0.0, 0.0, 0.0, 0.0, 0.0)  # thickness, transparency and colour of files without such arrays
UNSET = {(0.0, 0.0, 0.0), (1.0, 1.0, 1.0)}  # colours of files that have none: ours, and those of the library cyHair


def read_hair(path: Path, space: StageSpace) -> Curves:
    """Reads all hairs, root first, with the point attribute ``width``, a diameter [m].

    Colour and transparency become ``color`` and ``displayOpacity``, of points or, as the header has them, of curves.

    Raises UserError for a file that is not readable, truncated or inconsistent.
    """
    data = read_bytes(path)
    record(path)
    if len(data) < HEADER.size or data[:4] != b"HAIR":
        raise UserError(f"{path}: is not a .hair file (it does not begin with HAIR); choose another")
    _, hairs, points, arrays, segments, thickness, transparency, *color, _ = HEADER.unpack_from(data)
    if not arrays & POINTS:
        raise UserError(f"{path}: holds no points; export it again")
    if len(data) < HEADER.size + 12 * points:  # checked before memory is allocated
        raise UserError(f"{path}: has {len(data)} bytes, too few for {points} points; export it again")

    def take(flag: int, dtype: str, count: int) -> NDArray | None:
        """Reads the next array of the file; None when its flag is not set."""
        nonlocal place
        if not arrays & flag:
            return None
        end = place + count * np.dtype(dtype).itemsize
        if end > len(data):
            raise UserError(f"{path}: has {len(data)} bytes, but says it holds {end} or more; export it again")
        values, place = np.frombuffer(data, dtype, count, place), end
        return values

    place = HEADER.size
    each = take(SEGMENTS, "<u2", hairs)
    if each is None:
        if hairs * (segments + 1) != points:
            raise UserError(
                f"{path}: {hairs} hairs of {segments} segments do not make {points} points; export it again"
            )
        each = np.full(hairs, segments)
    counts = each.astype(np.int64) + 1
    if counts.sum() != points:
        raise UserError(f"{path}: its hairs have {counts.sum()} points, but it holds {points}; export it again")
    places = take(POINTS, "<f4", 3 * points)
    widths = take(THICKNESS, "<f4", points)
    clear = take(TRANSPARENCY, "<f4", points)
    colors = take(COLOR, "<f4", 3 * points)

    assert places is not None
    widths = np.full(points, thickness, np.float32) if widths is None else widths
    if (bad := np.flatnonzero(~((widths >= 0.0) & (widths <= limits.FARTHEST)))).size:
        raise UserError(f"{path}: point {bad[0]} is {widths[bad[0]]:g} thick; must be from 0 to {limits.FARTHEST:g}")
    attributes, of_curves = {"width": widths * space.meters_per_unit}, dict[str, NDArray]()
    if clear is not None:
        attributes["displayOpacity"] = 1.0 - clear
    elif transparency:
        of_curves["displayOpacity"] = np.full(hairs, 1.0 - transparency, np.float32)
    if colors is not None:
        attributes["color"] = colors.reshape(-1, 3)
    elif tuple(color) not in UNSET:
        of_curves["color"] = np.tile(np.array(color, np.float32), (hairs, 1))
    if len(places):
        check_points(places.reshape(-1, 3), str(path))
    curves = Curves(
        to_metres(places.reshape(-1, 3).astype(np.float64), space),
        offsets_from_counts(counts),
        np.arange(hairs, dtype=np.int64),
        of_curves,
        attributes,
    )
    return curves.check(str(path))


def write_hair(curves: Curves, path: Path, space: StageSpace) -> None:
    """Writes hairs with the point attributes ``width``, ``color`` and ``displayOpacity`` that they have.

    Raises UserError for a hair of more points than the format can count.
    """
    if (most := int(curves.counts.max())) > MOST_SEGMENTS + 1:
        raise UserError(f"{path}: a hair has {most} points; must have at most {MOST_SEGMENTS + 1}: resample them")
    widths, color, opacity = (curves.point.get(name) for name in ("width", "color", "displayOpacity"))
    arrays = {
        SEGMENTS: (curves.counts - 1).astype("<u2"),
        POINTS: from_metres(curves.points, space),
        THICKNESS: None if widths is None else widths / space.meters_per_unit,
        TRANSPARENCY: None if opacity is None else 1.0 - opacity,
        COLOR: color,
    }
    kept = {flag: values for flag, values in arrays.items() if values is not None}
    header = HEADER.pack(b"HAIR", len(curves), len(curves.points), sum(kept), 0, *PLAIN, b"Ringlet".ljust(88, b"\0"))
    chunks = [values if flag == SEGMENTS else np.asarray(values, "<f4") for flag, values in kept.items()]
    with replacing(path) as aside:
        aside.write_bytes(header + b"".join(np.ascontiguousarray(chunk).tobytes() for chunk in chunks))
