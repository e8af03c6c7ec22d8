"""Hairs: made of locks, and carried by their motion."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ringlet import groom as grooms
from ringlet import io
from ringlet.api.caches import scalp_clip
from ringlet.api.grooms import read_groom
from ringlet.api.progress import Progress, stage
from ringlet.data import limits
from ringlet.data.binding import check_roots, root_places
from ringlet.data.detail import LEVELS, screen_share
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.data.mesh import Clip
from ringlet.data.reads import recorded
from ringlet.deform.lengths import HairLengths
from ringlet.groom import AnyHairs, Memory
from ringlet.io import CacheFile


def build_hairs(
    groom: Groom,
    *,
    fraction: float = 1.0,
    wider: bool = False,
    points: int | None = None,
    point_share: float = 1.0,
    memory: Memory | None = None,
) -> AnyHairs:
    """Makes the hairs of every lock. ``fraction`` of them: the same ones every time, in (0, 1]; with ``wider`` these
    make up by their width for those left out.

    points: of each hair, in place of those that the groom sets
    point_share: part of these to make; hairs with a coil of their own keep all
    memory: that of ``build_groom``: hairs are only carried along when nothing but the shape of locks has changed, and
            the next call writes over their points
    """
    return grooms.make_hairs(
        groom,
        fraction=fraction,
        wider=wider,
        points=points,
        point_share=point_share,
        memory=memory.hairs if memory else None,
    )


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
    made = groom if isinstance(groom, Groom) else read_groom(groom, variant=variant)
    return grooms.hair_measures(made, hairs.curves if hairs is not None else None)


class _Motion(NamedTuple):
    """What carries hairs: ``frame`` (None at rest), locks, scalp and surfaces, as ``Hairs.deformed`` takes them.

    adjacent: whether the frame is the last before, or the first after, the range that is asked for
    """

    frame: float | None
    locks: NDArray[np.floating]
    scalp: NDArray[np.floating]
    surfaces: list[tuple[NDArray, NDArray]]
    adjacent: bool = False


@recorded()
def write_hairs(
    groom: Path | str,
    path: Path | str,
    *,
    cache: Path | str | None = None,
    frames: tuple[int, int] | None = None,
    fraction: float = 1.0,
    wider: bool = False,
    points: int | None = None,
    camera: str | None = None,
    camera_file: Path | str | None = None,
    pixels: int = 1920,
    lod: bool = False,
    on_demand: bool = False,
    velocities: bool = False,
    variant: str | None = None,
    measures: dict[str, float] | None = None,
    progress: Progress | None = None,
) -> dict[str, int]:
    """Writes the hairs of the USD file ``groom``, at rest, or carried by the guides of ``cache`` through ``frames``.

    They stay on that side of the scalp, and of what else the file shows, where their lock is. Hairs on demand in the
    file are expanded.

    groom:      a groom, or a cache by itself, which lies over its groom
    frames:     the first and the last of the cache; all by default
    points:     of each hair; by default those that the groom sets
    camera:     path of a camera, which chooses the fraction: hairs are thinned out and widened up to half a pixel,
                where they come nearest in all frames
    camera_file: a USD file that has the camera; by default the file of the hairs
    pixels:     width of the picture of that camera
    lod:        writes the levels of detail ``LEVELS`` as variants ``LOD0``, ``LOD1``, … of ``/groom/hairs``
    on_demand:  writes what a renderer makes hairs of, in place of their points
    velocities: writes those of hairs in motion too, in units per second, which doubles the size of the file; at both
                ends by the adjacent frames of the cache
    variant:    of the groom, in place of the one that is selected in it, or that the cache was made of
    measures:   receives the entries of ``measure_hairs``; ``fraction``, where a camera chose it; and of hairs in motion
                with points ``length_change``, the largest fraction by which one gets longer or shorter than in the
                groom, and its ``length_change_frame``

    Returns how many ``locks``, ``hairs``, ``points`` and ``frames`` there are; hairs and points of the finest level.
    """
    _refuse_together(lod=lod, on_demand=on_demand, camera=camera is not None, fraction=fraction < 1.0)
    _refuse_together(on_demand=on_demand, velocities=velocities)
    limits.check_count("points", 2 if points is None else points - 1, limits.POINTS - 1)
    limits.check_count("pixels", pixels, limits.PIXELS)
    expanded = io.has_hairs_on_demand(groom)
    if cache is None and (io.is_cache(groom) or (expanded and len(io.read_hair_frames(groom)))):
        cache = groom
    if cache is None and frames is not None:
        asked = f"{frames[0]}:{frames[1]}"
        raise UserError(f"{groom}: does not move, so it has no frames {asked}; give its cache too, with --cache")
    if cache is not None:
        with io.open_cache(cache) as moved:  # before any hair is made
            moved.within(frames)
    if variant is None and cache is not None:
        variant = read_groom(cache).variant
    locks = read_groom(groom, variant=variant)
    if camera is not None:
        fraction, wider = _share_of_camera(groom, cache, locks, frames, (camera_file, camera), pixels), True
    if expanded:
        if lod or on_demand or fraction < 1.0 or points:
            raise UserError(f"{groom}: its hairs are made already; ask its groom or its cache for other ones")
        levels = [io.read_on_demand(groom)]
    else:
        with stage(progress, "lay hairs"):
            levels = [build_hairs(locks, fraction=fraction, wider=wider, points=points)]
            for level in LEVELS[1:] if lod else ():
                hairs = build_hairs(locks, fraction=level.share, wider=True, points=points, point_share=level.points)
                levels.append(hairs)
    finest = levels[0]
    if measures is not None:
        if not expanded:
            with stage(progress, "measure cover"):
                measures |= measure_hairs(locks, hairs=finest if fraction == 1.0 else None)
        if camera is not None:
            measures["fraction"] = fraction
    rest = _Motion(None, locks.locks.points, locks.scalp.points, _surfaces_at_rest(groom, locks))
    with stage(progress, "keep out of surfaces"):
        for hairs in levels:
            hairs.curves.points = hairs.deformed(rest.locks, rest.scalp, surfaces=rest.surfaces)
    under, written = Path(groom if cache is None else cache), 0
    if expanded:
        under = io.layer_under_on_demand(groom)
    with _motion(groom, cache, locks, frames, adjacent=velocities) as (total, moments):
        if on_demand:
            with io.OnDemandWriter(Path(path), locks, finest, under) as writer:
                writer.add(None, rest.locks, rest.scalp)
                for at in moments:
                    writer.add(at.frame, at.locks, at.scalp)
                    written = _reported(written, total, progress)
        else:
            coarser = [hairs.curves for hairs in levels[1:]]
            with io.HairWriter(Path(path), locks, finest.curves, under, velocities, coarser) as writer:
                for level, hairs in enumerate(levels):
                    if cache is None:
                        writer.add(None, hairs.curves.points, around=rest.scalp, level=level)
                lengths = HairLengths(finest.curves)
                for at in moments:
                    for level, hairs in enumerate(levels):
                        moved = hairs.deformed(at.locks, at.scalp, surfaces=at.surfaces)
                        if at.adjacent and at.frame is not None:
                            writer.add_adjacent(at.frame, moved, level=level)
                            continue
                        writer.add(at.frame, moved, around=at.scalp, level=level)
                        if level == 0 and at.frame is not None:
                            lengths.add(at.frame, moved)
                    written = written if at.adjacent else _reported(written, total, progress)
                if measures is not None and written:
                    measures |= {"length_change": lengths.change, "length_change_frame": lengths.frame}
    return {
        "locks": len(locks.locks),
        "hairs": len(finest.curves),
        "points": len(finest.curves.points),
        "frames": written,
    }


def _reported(written: int, total: int, progress: Progress | None) -> int:
    """The number of written frames after another one."""
    if progress:
        progress("hairs", written + 1, total)
    return written + 1


def _refuse_together(**asked: bool) -> None:
    """Raises UserError where the first of these options is asked for together with another."""
    (first, wanted), *others = asked.items()
    for name, also in others:
        if wanted and also:
            one, other = (word.replace("_", "-") for word in (first, name))
            raise UserError(f"hair: --{one} does not go together with --{other}; leave one of them out")


def _surfaces_at_rest(groom: Path | str, locks: Groom) -> list[tuple[NDArray, NDArray]]:
    shown = io.read_meshes(groom) or [locks.scalp]  # a head of an OBJ is in no stage
    return [(mesh.points, mesh.triangles) for mesh in shown]


@contextmanager
def _motion(
    groom: Path | str,
    cache: Path | str | None,
    locks: Groom,
    frames: tuple[int, int] | None,
    *,
    adjacent: bool = False,
) -> Iterator[tuple[int, Iterator[_Motion]]]:
    """The number of frames of a cache, and what carries hairs at each; none without a cache.

    adjacent: also gives the frames adjacent to the range, which do not count
    """
    if cache is None:
        yield 0, iter(())
        return
    with io.open_cache(cache) as moved:
        chosen = moved.within(frames if frames is not None else _made_frames(groom))
        all_frames = moved.frames
        before, after = (all_frames[all_frames < chosen[0]][-1:], all_frames[all_frames > chosen[-1]][:1])
        given = np.concatenate([before, chosen, after]) if adjacent else chosen
        clip = scalp_clip(locks, (math.floor(given[0]), math.ceil(given[-1])))
        moments = (_motion_at(cache, moved, locks, clip, float(frame)) for frame in given)
        yield len(chosen), (at._replace(adjacent=at.frame not in chosen) for at in moments)


def _made_frames(groom: Path | str) -> tuple[int, int] | None:
    """First and last frame of hairs on demand in a file; None for another file."""
    if not io.has_hairs_on_demand(groom):
        return None
    made = io.read_hair_frames(groom)
    return int(made[0]), int(made[-1])


def _motion_at(cache: Path | str, moved: CacheFile, locks: Groom, clip: Clip, frame: float) -> _Motion:
    """What carries hairs at a frame; raises UserError for locks that are not on the scalp."""
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
    return _Motion(frame, points, scalp, moved.surfaces(frame) or [(scalp, locks.scalp.triangles)])


def _share_of_camera(
    groom: Path | str,
    cache: Path | str | None,
    locks: Groom,
    frames: tuple[int, int] | None,
    camera: tuple[Path | str | None, str],
    pixels: int,
) -> float:
    """The largest share of the hairs that a camera, a prim of a file, needs in any frame.

    Raises UserError where no lock is in front of it.
    """
    sample = build_hairs(locks, fraction=0.001)
    width = float(np.median(sample.curves.point["width"].reshape(len(sample.curves), -1).max(axis=1)))
    under = groom if cache is None else cache
    stage, prim, share = camera[0] or under, camera[1], 0.0
    with _motion(groom, cache, locks, frames) as (_, moments):
        for at in [_Motion(None, locks.locks.points, locks.scalp.points, [])] if cache is None else moments:
            seen = io.read_camera(stage, prim, at.frame)
            depths = seen.depths(at.locks)
            if depths.max() > 0.0:
                share = max(share, screen_share(width, float(depths.min()), seen, pixels))
    if not share:
        raise UserError(f"{stage}: camera {prim} has no hair in front of it; turn it, or choose another")
    return share
