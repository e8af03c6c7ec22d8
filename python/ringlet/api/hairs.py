"""Hairs: made of locks, and carried by their motion."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ringlet.api.grooms import read_groom
from ringlet.api.progress import Progress
from ringlet.api.shots import scalp_clip
from ringlet.data.binding import check_roots, root_places
from ringlet.data.errors import UserError
from ringlet.data.reads import recorded

if TYPE_CHECKING:
    from ringlet.data.groom import Groom
    from ringlet.groom import AnyHairs, Memory

__all__ = ["build_hairs", "measure_hairs", "write_hairs"]


def build_hairs(groom: Groom, *, fraction: float = 1.0, wider: bool = False, memory: Memory | None = None) -> AnyHairs:
    """Makes the hairs of every lock. ``fraction`` of them: the same ones every time, in (0, 1]; with ``wider`` these
    make up by their width for those left out.

    memory: that of ``build_groom``: hairs are only carried along when nothing but the shape of locks has changed, and
            the next call writes over their points
    """
    from ringlet import groom as grooms

    return grooms.make_hairs(groom, fraction=fraction, wider=wider, memory=memory.hairs if memory else None)


def measure_hairs(
    groom: Groom | Path | str, *, variant: str | None = None, hairs: AnyHairs | None = None
) -> dict[str, Any]:
    """Density and cover of all hairs of a groom at rest.

    ``hairs_per_cm2`` is the mean over the region that carries hair, and ``scalp_seen`` the part of that region that
    cameras around the head see through the hair, 0 to 1. A groom on an edge has ``hairs_per_cm`` of its lines instead;
    several grooms have ``grooms``, with ``hairs`` and those of each by name.

    variant: of the groom file, in place of the one that is selected in it
    hairs:   all hairs of the groom, where they are made already
    """
    from ringlet import groom as grooms
    from ringlet.data.groom import Groom

    made = groom if isinstance(groom, Groom) else read_groom(groom, variant=variant)
    return grooms.hair_measures(made, hairs.curves if hairs is not None else None)


@recorded()
def write_hairs(
    groom: Path | str,
    path: Path | str,
    *,
    cache: Path | str | None = None,
    frames: tuple[int, int] | None = None,
    fraction: float = 1.0,
    wider: bool = False,
    velocities: bool = False,
    variant: str | None = None,
    measures: dict[str, float] | None = None,
    progress: Progress | None = None,
) -> dict[str, int]:
    """Writes the hairs of the USD file ``groom``, at rest, or carried by the guides of ``cache`` through ``frames``.

    They stay on that side of the scalp, and of what else the file shows, where their lock is.

    groom:      a groom, or a cache by itself, which lies over its groom
    frames:     the first and the last of the cache; all by default
    velocities: writes those of hairs in motion too, in units per second, which doubles the size of the file
    variant:    of the groom, in place of the one that is selected in it, or that the cache was made of
    measures:   receives the entries of ``measure_hairs``

    Returns how many ``locks``, ``hairs``, ``points`` and ``frames`` there are.
    """
    from ringlet import io

    if cache is None and io.is_cache(groom):
        cache = groom
    if cache is None and frames is not None:
        asked = f"{frames[0]}:{frames[1]}"
        raise UserError(f"{groom}: frames {asked} are asked of a groom that does not move; name its cache as well")
    if variant is None and cache is not None:
        variant = read_groom(cache).variant
    locks = read_groom(groom, variant=variant)
    hairs = build_hairs(locks, fraction=fraction, wider=wider)
    if measures is not None:
        measures |= measure_hairs(locks, hairs=hairs if fraction == 1.0 else None)
    written = 0
    shown = io.read_meshes(groom) or [locks.scalp]  # a head of an OBJ is in no stage
    around = [(mesh.points, mesh.triangles) for mesh in shown]
    hairs.curves.points = hairs.deformed(locks.locks.points, locks.scalp.points, surfaces=around)
    if cache is None:
        with io.HairWriter(Path(path), locks, hairs.curves, Path(groom)) as writer:
            writer.add(None, hairs.curves.points, around=locks.scalp.points)
    else:
        with (
            io.open_cache(cache) as moved,
            io.HairWriter(Path(path), locks, hairs.curves, Path(cache), velocities) as writer,
        ):
            chosen = moved.within(frames)
            clip = scalp_clip(locks, (math.floor(chosen[0]), math.ceil(chosen[-1])))
            for frame in chosen:
                scalp, points = clip.at(frame), moved.points(frame)
                places = root_places(locks.locks, scalp, locks.scalp.triangles)
                check_roots(
                    points[locks.locks.offsets[:-1]],
                    places,
                    locks.locks.ids,
                    f"{cache} at frame {frame:g}",
                    "simulate again",
                    moved.lag(frame),
                )
                surfaces = moved.surfaces(frame) or [(scalp, locks.scalp.triangles)]
                writer.add(frame, hairs.deformed(points, scalp, surfaces=surfaces), around=scalp)
                written += 1
                if progress:
                    progress("hairs", written, len(chosen))
    return {
        "locks": len(locks.locks),
        "hairs": len(hairs.curves),
        "points": len(hairs.curves.points),
        "frames": written,
    }
