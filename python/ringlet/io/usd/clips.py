"""Clips: positions of the surface of a prim over time."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from ringlet.data import limits
from ringlet.data.errors import UserError
from ringlet.data.frames import gaps
from ringlet.data.mesh import Clip
from ringlet.io.space import check_points
from ringlet.io.usd.pose import motion_samples, posed_points, rest_time
from ringlet.io.usd.stage import Source
from ringlet.io.usd.values import read_integers

MAX_POSITIONS = 2**28  # points of a mesh times frames: 6 GiB


def shot_clip_at(source: Source, prim: Usd.Prim, frames: tuple[int, int] | None, fps: float | None) -> Clip:
    """Positions of a mesh prim at the frames of a shot, and at the one beside the first that gives the velocity there.

    That is the frame before, or the one after for a prim that begins to move at the first frame or later. Frames
    beyond the samples are left out, since a clip holds its ends.

    frames: first and last frame of the shot; by default the whole frames of the stage
    fps:    frames per second of the shot; by default those of the stage
    """
    rate = source.space.fps if fps is None else fps
    if frames is not None and (samples := motion_samples(source, prim)):
        start, end = (time * rate / source.space.fps for time in (min(samples), max(samples)))
        first = frames[0] - 1 if start <= frames[0] - 1 else frames[0]
        last = max(frames[1], first + 1)
        frames = (first, max(first + 1, math.ceil(end)) if end < last else last)
    return clip_at(source, prim, frames, rate)


def clip_at(
    source: Source, prim: Usd.Prim, frames: tuple[float, float] | None = None, fps: float | None = None
) -> Clip:
    """Positions of a mesh prim at all whole frames of a closed range; one sample for a static prim.

    USD evaluates a stage at any time, so that the range may exceed that of the stage and of its samples.

    frames: first and last frame; by default the range of the stage, or else that of the prim's samples
    fps:    frames per second; a stage of another rate is read at the same seconds, as where USD references it

    Raises UserError for too much data, and for points or faces whose number or order changes.
    """
    return clip_over(source, prim, _frames(source, prim, frames), source.space.fps if fps is None else fps)


def clip_over(source: Source, prim: Usd.Prim, times: NDArray[np.float64], rate: float) -> Clip:
    """Positions of a mesh prim at frames of ``rate`` a second; one sample for no frames. Errors as in ``clip_at``."""
    where = source.where(prim)
    if len(times) == 0:
        points = posed_points(source, prim, Usd.TimeCode.EarliestTime(), where)  # one sample for all times
        return Clip(np.zeros(1), points[None], rate)
    samples, faces = [], _Faces(source, prim)
    for frame in times:
        at, time = f"{where} at frame {frame:g}", Usd.TimeCode(frame * source.space.fps / rate)
        points = posed_points(source, prim, time, at)
        check_points(points, at)  # a transform may be NaN, too
        if len(points) * len(times) > MAX_POSITIONS:
            raise UserError(
                f"{where}: has {len(points):,} points at {len(times):,} frames, more than {MAX_POSITIONS:,} places; "
                "shorten the shot, or leave it out"
            )
        if samples and len(points) != len(samples[0]):
            raise UserError(
                f"{where}: has {len(points)} points at frame {frame:g}, {len(samples[0])} before; must not change"
            )
        faces.check(time, at)
        samples.append(points)
    return Clip(times, np.stack(samples), rate)


class _Faces:
    """Faces of a mesh in its rest pose, which its animation must keep."""

    def __init__(self, source: Source, prim: Usd.Prim) -> None:
        mesh, time, where = UsdGeom.Mesh(prim), rest_time(source, prim), source.where(prim)
        attributes = mesh.GetFaceVertexCountsAttr(), mesh.GetFaceVertexIndicesAttr()
        self._rest = [(a, read_integers(a, time, where)) for a in attributes if a.ValueMightBeTimeVarying()]

    def check(self, time: Usd.TimeCode, where: str) -> None:
        """Raises UserError for faces that differ at a time."""
        for attribute, rest in self._rest:
            if not np.array_equal(read_integers(attribute, time, where), rest):
                raise UserError(
                    f"{where}: its {attribute.GetName()} differ from those in its rest pose; must not change over time"
                )


def sampled_frames(samples: Sequence[float], where: str) -> NDArray[np.float64]:
    """Frames of samples, and the whole frames between those that are more than one apart, shape (k,).

    Raises UserError for too many.
    """
    _check_span(min(samples), max(samples), where)
    held = np.unique(samples)
    return np.union1d(held, gaps(held))


def whole_frames(first: float, last: float, where: str) -> NDArray[np.float64]:
    """Whole frames of a closed range, shape (k,); raises UserError for none or too many."""
    _check_span(first, last, where)
    frames = np.arange(math.ceil(first), math.floor(last) + 1, dtype=np.float64)
    if len(frames) == 0:
        raise UserError(f"{where}: there is no whole frame from {first:g} to {last:g}; give a longer range")
    return frames


def _check_span(first: float, last: float, where: str) -> None:
    if not abs(last - first) < limits.FRAMES:  # also true for NaN
        raise UserError(f"{where}: moves from {first:g} to {last:g}; must be fewer than {limits.FRAMES:,} frames")


def _frames(source: Source, prim: Usd.Prim, frames: tuple[float, float] | None) -> NDArray[np.float64]:
    """Whole frames to read; empty for a static mesh."""
    samples = motion_samples(source, prim)
    if not samples:
        return np.empty(0)
    samples = [time for time in samples if math.isfinite(time)]
    start, end = source.stage.GetStartTimeCode(), source.stage.GetEndTimeCode()
    if frames is None and source.stage.HasAuthoredTimeCodeRange() and 0 <= end - start < limits.FRAMES:
        frames = start, end
    first, last = frames or (min(samples), max(samples))
    return whole_frames(first, last, source.where(prim))
