"""Hairs: made of locks, and carried by their motion."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ringlet.api.grooms import read_groom
from ringlet.api.progress import Progress
from ringlet.api.shots import read_cache, scalp_clip
from ringlet.errors import UserError

if TYPE_CHECKING:
    from ringlet.groom import Hairs, Memory
    from ringlet.groom.groom import Groom
    from ringlet.shot.cache import Cache


def build_hairs(groom: Groom, *, fraction: float = 1.0, wider: bool = False, memory: Memory | None = None) -> Hairs:
    """Makes the hairs of every lock. ``fraction`` of them: the same ones every time, in (0, 1]; with ``wider`` these
    make up by their width for those left out.

    memory: that of ``build_groom``: hairs are only carried along when nothing but the shape of locks has changed, and
            the next call writes over their points
    """
    from ringlet import groom as grooms

    return grooms.make_hairs(groom, fraction=fraction, wider=wider, memory=memory.hairs if memory else None)


def write_hairs(
    groom: Path | str,
    path: Path | str,
    *,
    cache: Path | str | None = None,
    frames: tuple[int, int] | None = None,
    fraction: float = 1.0,
    wider: bool = False,
    variant: str | None = None,
    progress: Progress | None = None,
) -> dict[str, int]:
    """Writes the hairs of the USD file ``groom``, at rest, or carried by the guides of ``cache`` through ``frames``.

    variant: of the groom, in place of the one that is selected in it, or that the cache was made of

    Returns how many ``locks``, ``hairs``, ``points`` and ``frames`` there are.
    """
    from ringlet import io

    if variant is None and cache is not None:
        variant = read_groom(cache).variant
    locks = read_groom(groom, variant=variant)
    hairs = build_hairs(locks, fraction=fraction, wider=wider)
    written = 0
    with io.HairWriter(Path(path), locks, hairs.curves, Path(cache or groom)) as writer:
        if cache is None:
            writer.add(None, hairs.curves.points)
        else:
            moved = _within(read_cache(cache), frames, cache)
            clip = scalp_clip(locks)
            for frame, points in zip(moved.frames, moved.points, strict=True):
                writer.add(frame, hairs.at(points, clip.at(frame)))
                written += 1
                if progress:
                    progress("hairs", written, len(moved.frames))
    return {
        "locks": len(locks.locks),
        "hairs": len(hairs.curves),
        "points": len(hairs.curves.points),
        "frames": written,
    }


def _within(cache: Cache, frames: tuple[int, int] | None, path: Path | str) -> Cache:
    """The frames of a cache from the first to the last of ``frames``."""
    if frames is None:
        return cache
    chosen = (cache.frames >= frames[0]) & (cache.frames <= frames[1])
    if not chosen.any():
        held = f"{cache.frames[0]:g} to {cache.frames[-1]:g}"
        raise UserError(f"{path}: has no frame from {frames[0]:g} to {frames[1]:g}; it holds {held}")
    cloths = [replace(cloth, points=cloth.points[chosen]) for cloth in cache.cloths]
    return replace(cache, frames=cache.frames[chosen], points=cache.points[chosen], cloths=cloths)
