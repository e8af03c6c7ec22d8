"""Contacts of a simulation as points in a layer over its cache, and its initial penetrations.

/groom/touches  : Points, coloured by force on a logarithmic scale from blue to red, three decades. Red is the largest
                  99 % quantile of any frame.
/groom/start    : Points of initial penetrations and overlaps of locks, coloured by depth
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from ringlet.data.cache import Cache, SimulationRecord, Touches
from ringlet.data.errors import UserError
from ringlet.data.precision import compact
from ringlet.data.stage import StageSpace
from ringlet.io.space import to_metres
from ringlet.io.usd.groom import GROOM
from ringlet.io.usd.place import Place, placed
from ringlet.io.usd.stage import reading
from ringlet.io.usd.stream import StreamWriter
from ringlet.io.usd.values import Types, float3, to_usd

TOUCHES, START = f"{GROOM}/touches", f"{GROOM}/start"
SIZE = 1e-3  # diameter of a point [m]
DECADES = 3.0  # range of the colour scale
STRONG = 0.99  # quantile of the forces that is red; with the maximum, few outliers would make all others blue
RAMP = np.array([[0.05, 0.15, 0.9], [0.1, 0.8, 0.5], [1.0, 0.85, 0.1], [0.9, 0.05, 0.02]])  # from weak to strong


def heat(strength: NDArray[np.floating]) -> NDArray[np.float32]:
    """Colours from blue (0) to red (1) of strengths, shape (k, 3)."""
    at = np.linspace(0.0, 1.0, len(RAMP))
    return np.stack([np.interp(strength, at, channel) for channel in RAMP.T], axis=-1).astype(np.float32)


def strengths(force: NDArray[np.floating], strong: float) -> NDArray[np.float64]:
    """Forces on a logarithmic scale from 0 to 1, clamped to 1 above the force ``strong``."""
    relative = np.maximum(np.asarray(force, np.float64), 0.0) / max(strong, 1e-300)
    return np.clip(1.0 + np.log10(np.maximum(relative, 1e-30)) / DECADES, 0.0, 1.0)


def write_touches(cache: Cache | SimulationRecord, cache_path: Path | str, path: Path | str, space: StageSpace) -> None:
    """Writes contacts as a layer over the cache."""
    strong = max((float(np.quantile(t.force, STRONG)) for t in cache.touches if len(t.force)), default=0.0)
    with TouchesWriter(path, cache_path, space) as writer:
        writer.mark(*start_marks(cache.start))
        for frame, touches in zip(cache.frames, cache.touches, strict=True):
            writer.add(frame, touches, heat(strengths(touches.force, strong)))


class TouchesWriter(StreamWriter):
    """Writes contacts frame by frame as a layer over the cache."""

    def __enter__(self) -> Self:
        stage = self.begin()
        self._touches, self._start = (UsdGeom.Points.Define(stage, name) for name in (TOUCHES, START))
        self._at, self._at_start = (Place(of.GetPrim(), self.space, self.path) for of in (self._touches, self._start))
        return self

    def mark(self, places: NDArray, depth: NDArray) -> None:
        """Adds initial penetrations: places [m], shape (k, 3), and relative depths from 0 to 1, shape (k,)."""
        _put(self._start, places, heat(depth), self._at_start, self.space, Usd.TimeCode.Default())

    def add(self, frame: float, touches: Touches, colors: NDArray) -> None:
        """Adds a frame; colours have shape (k, 3)."""
        time = Usd.TimeCode(float(frame))
        _put(self._touches, touches.places, colors, self._at, self.space, time)
        for name in ("force", "gap"):
            kind, value = to_usd(getattr(touches, name))
            UsdGeom.PrimvarsAPI(self._touches).CreatePrimvar(f"ringlet:{name}", kind, "vertex").Set(value, time)
        self.record(frame, 36 * len(colors))


def read_touches(path: Path | str, frame: float | None = None) -> tuple[Touches, NDArray[np.float32]]:
    """Reads the contacts of a frame, by default the first, and their colours by force, shape (k, 3).

    Raises UserError for a file or a frame without contacts.
    """
    with reading(path) as source:
        prim = source.stage.GetPrimAtPath(TOUCHES)
        points = UsdGeom.Points(prim) if prim else None
        times = points.GetPointsAttr().GetTimeSamples() if points else []
        if points is None or not times:
            raise UserError(f"{path}: holds no contacts; make them with: ringlet sim SHOT.toml --contacts FILE")
        chosen = times[0] if frame is None else frame
        if chosen not in times:
            raise UserError(f"{path}: has no contacts at frame {chosen:g}; it holds {times[0]:g} to {times[-1]:g}")
        time, api = Usd.TimeCode(chosen), UsdGeom.PrimvarsAPI(prim)
        local = np.array(points.GetPointsAttr().Get(time), np.float32).reshape(-1, 3)
        places = to_metres(placed(local, prim, time), source.space)
        force, gap = (np.array(api.GetPrimvar(f"ringlet:{name}").Get(time), np.float32) for name in ("force", "gap"))
        colors = np.array(points.GetDisplayColorAttr().Get(time), np.float32).reshape(-1, 3)
        return Touches(places, force, gap), colors


def start_marks(start: dict[str, Any]) -> tuple[NDArray[np.floating], NDArray[np.float64]]:
    """Places of initial penetrations [m], shape (k, 3), and depths relative to the deepest of their kind (k,)."""
    marks = np.array(start.get("marks", []), np.float64).reshape(-1, 4)
    return compact(marks[:, :3]), marks[:, 3]


def _put(
    prim: UsdGeom.Points, places: NDArray, colors: NDArray, at: Place, space: StageSpace, time: Usd.TimeCode
) -> None:
    value = at.local(places, time)
    width = np.full(len(places), SIZE / space.meters_per_unit, np.float32)
    _, widths = to_usd(width)
    prim.CreatePointsAttr().Set(value, time)
    prim.CreateWidthsAttr().Set(widths, time)
    prim.SetWidthsInterpolation(UsdGeom.Tokens.vertex)
    prim.CreateExtentAttr().Set(UsdGeom.Points.ComputeExtent(value, widths), time)
    api = UsdGeom.PrimvarsAPI(prim)
    api.CreatePrimvar("displayColor", Types.Color3fArray, "vertex").Set(float3(colors), time)
