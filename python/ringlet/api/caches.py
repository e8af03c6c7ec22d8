"""Caches of simulated guides, and the animation of the scalp that they follow."""

from __future__ import annotations

from contextlib import AbstractContextManager
from pathlib import Path

import numpy as np

from ringlet import io
from ringlet.data.cache import Cache, SimulationRecord
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.data.mesh import Clip
from ringlet.data.reads import recorded
from ringlet.io import CacheFile


def scalp_clip(groom: Groom, frames: tuple[int, int] | None = None) -> Clip:
    """The animation of the scalp of a groom at the rate of the groom; one from an OBJ file stands still.

    frames: first and last frame; by default those of the head's stage
    """
    if groom.scalp_file is None:
        raise UserError("groom: names no file for its scalp; write the head as USD and name it in the recipe")
    if is_still(groom):
        return Clip(np.zeros(1), groom.scalp.points[None], groom.space.fps)
    return io.read_clip(groom.scalp_file, groom.scalp_prim, frames, groom.space.fps, cage=groom.cage)


def is_still(groom: Groom) -> bool:
    """Whether the scalp is of a file without animation."""
    return groom.scalp_file is not None and groom.scalp_file.suffix.lower() == ".obj"


@recorded()
def write_cache(cache: Cache, groom: Path | str, path: Path | str, *, variant: str | None = None) -> None:
    """Writes simulated guides as a USD layer over the file ``groom``, or over one of its variants."""
    io.write_cache(cache, Path(groom), Path(path), io.read_space(Path(groom)), variant)


@recorded()
def write_touches(cache: Cache | SimulationRecord, cache_path: Path | str, path: Path | str) -> None:
    """Writes the contacts of a simulation as coloured points: a USD layer over the file of its cache."""
    io.write_touches(cache, Path(cache_path), Path(path), io.read_space(Path(cache_path)))


def open_cache(path: Path | str) -> AbstractContextManager[CacheFile]:
    """Opens simulated guides to read one frame at a time, however many there are.

    The file has ``frames``, ``size`` (points of all locks), ``statistics`` and ``start``, and
    ``points(frame)``: positions [m], shape (size, 3).

    Example::

        with ringlet.open_cache("cache.usdc") as cache:
            for frame in cache.frames:
                print(frame, cache.points(frame).max(axis=0))
    """
    return io.open_cache(Path(path))


def read_cache(path: Path | str) -> Cache:
    """Reads simulated guides that ``write_cache`` wrote, all frames of them."""
    return io.read_cache(Path(path))
