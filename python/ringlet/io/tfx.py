"""AMD TressFX ``.tfx`` files, version 4: strands of equal numbers of points, for hair in games.

Layout: https://github.com/GPUOpen-Effects/TressFX, ``TressFXFileFormat.h``. A file stores neither its unit nor its
up-axis.
"""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.reads import record
from ringlet.data.regular import read_bytes
from ringlet.data.stage import StageSpace
from ringlet.io.space import check_points, from_metres, to_metres

# Version, strands, points a strand, then the places of positions, root UVs, point UVs, thicknesses and colours.
HEADER = struct.Struct("<f7I128s")
SIZES = (4, 8, 16, 32, 64)  # points of a strand that TressFX takes
FIXED = 2  # points of a strand at its root that do not move


def read_tfx(path: Path, space: StageSpace) -> Curves:
    """Reads all strands, root first, with the curve attributes ``width``, a diameter [m], and ``st`` if present.

    Raises UserError for a file that is not readable, truncated or inconsistent.
    """
    data = read_bytes(path)
    record(path)
    if len(data) < HEADER.size:
        raise UserError(f"{path}: has {len(data)} bytes, too few for a .tfx file; export it again")
    version, strands, each, positions, uv, _, thickness, *_ = HEADER.unpack_from(data)
    if not 4.0 <= version < 5.0:
        raise UserError(f"{path}: is no .tfx file of version 4 (its version is {version:g}); export it again")
    if strands == 0 or each < 2:
        raise UserError(f"{path}: holds {strands} strands of {each} points; must have at least 1 of 2")

    def take(place: int, count: int, row: int) -> NDArray[np.float32]:
        if place < HEADER.size or place + 4 * count * row > len(data):
            raise UserError(
                f"{path}: has {len(data)} bytes, too few for {count} × {row} numbers at byte {place}; export it again"
            )
        return np.frombuffer(data, "<f4", count * row, place).reshape(count, row)

    points = take(positions, strands * each, 4)[:, :3].astype(np.float64)
    check_points(points, str(path))
    attributes: dict[str, NDArray] = {}
    if thickness:
        widths = take(thickness, strands, 1)[:, 0] * np.float32(space.meters_per_unit)
        attributes["width"] = widths
    if uv:
        attributes["st"] = take(uv, strands, 2).copy()
    offsets = offsets_from_counts(np.full(strands, each))
    curves = Curves(to_metres(points, space), offsets, np.arange(strands, dtype=np.int64), attributes)
    return curves.check(str(path))


def write_tfx(curves: Curves, path: Path, space: StageSpace) -> None:
    """Writes strands of equal numbers of points, the first two of each fixed.

    Raises ValueError for strands of different numbers of points.
    """
    count = int(curves.counts[0])
    if (curves.counts != count).any():
        raise ValueError("tfx: strands have different numbers of points; must be resampled")
    points = np.empty((len(curves), count, 4), np.float32)
    points[..., :3] = from_metres(curves.points, space).reshape(len(curves), count, 3)
    points[..., 3] = np.arange(count) >= FIXED  # inverse mass
    arrays: list[NDArray | None] = [points, curves.curve.get("st"), None, curves.curve.get("width"), None]
    if arrays[3] is not None:
        arrays[3] = arrays[3] / space.meters_per_unit
    chunks, places, end = list[bytes](), list[int](), HEADER.size
    for values in arrays:
        places.append(0 if values is None else end)
        chunks.append(b"" if values is None else np.ascontiguousarray(values, "<f4").tobytes())
        end += len(chunks[-1])
    with replacing(path) as aside:
        aside.write_bytes(HEADER.pack(4.0, len(curves), count, *places, bytes(128)) + b"".join(chunks))
