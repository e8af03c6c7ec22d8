"""A simulation as USD: a layer over the groom that moves the points of ``/groom/locks``, and those of cloths."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Usd, UsdGeom

from ringlet.data.cache import Cache, CachedCloth
from ringlet.data.errors import UserError
from ringlet.data.stage import StageSpace
from ringlet.io.space import to_metres
from ringlet.io.usd.cloths import ClothPrims, read_cloth, set_cloth, told_of
from ringlet.io.usd.groom import LOCKS, VERSION, check_version, groom_prim
from ringlet.io.usd.mesh import clip_at, mesh_at, visible_meshes
from ringlet.io.usd.stage import Source, parse_json, reading, reading_more
from ringlet.io.usd.stream import StreamWriter


def write_cache(
    cache: Cache, groom_path: Path | str, path: Path | str, space: StageSpace, variant: str | None = None
) -> None:
    """Writes a simulation as a layer over the groom file.

    space:   unit, up-axis and rate of the groom file
    variant: of the groom, where it has some
    """
    with CacheWriter(path, groom_path, space, cache.cloths, variant) as writer:
        writer.start = cache.start
        for index, (frame, points) in enumerate(zip(cache.frames, cache.points, strict=True)):
            statistics = cache.statistics[index] if index < len(cache.statistics) else None
            writer.add(frame, points, statistics, [cloth.points[index] for cloth in cache.cloths])


def read_cache(path: Path | str) -> Cache:
    """Reads a simulation, or the one under hairs, with all of its frames."""
    with open_cache(path) as cache:
        points = np.empty((len(cache.frames), cache.size, 3), np.float32)
        for index, frame in enumerate(cache.frames):
            points[index] = cache.points(frame)
        return Cache(cache.frames, points, cache.statistics, cache.start, cache.cloths())


@contextmanager
def open_cache(path: Path | str) -> Iterator[CacheFile]:
    """Opens a simulation, or the one under hairs, to read one frame at a time."""
    with reading(path) as source:
        yield CacheFile(source)


class CacheFile:
    """A simulation in a file, of which no more is in memory than the frame that is asked for.

    frames:     frame numbers (time codes), shape (k,)
    size:       how many points the locks have together
    statistics: what the solver reported, one dict per frame
    start:      what was in the way when the shot began
    """

    def __init__(self, source: Source) -> None:
        groom_prim(source)
        self._source = source
        self._points = UsdGeom.PointBased(source.stage.GetPrimAtPath(LOCKS)).GetPointsAttr()
        self.frames = np.array(self._points.GetTimeSamples(), np.float64)
        if not len(self.frames):
            raise UserError(
                f"{source.path}: holds no simulated frames; make a cache with: ringlet sim SHOT.toml -o cache.usdc"
            )
        self.size = len(self._points.Get(Usd.TimeCode.Default()))
        kept = [layer.customLayerData.get("ringlet") or {} for layer in source.stage.GetLayerStack()]
        for data in kept:
            check_version(source, data.get("version", VERSION))

        def told(name: str, empty: str) -> Any:
            return parse_json(source, next((data[name] for data in kept if name in data), empty), f"ringlet:{name}")

        self.statistics: list[dict[str, Any]] = told("statistics", "[]")
        self.start: dict[str, Any] = told("start", "{}")
        self._cloths: list[dict[str, Any]] = told("cloths", "[]")
        self._meshes: list[tuple[Usd.Prim, NDArray[np.int32]]] | None = None

    def points(self, frame: float) -> NDArray[np.float32]:
        """Where the locks are at a frame [m], shape (n, 3), in the order of the groom's locks."""
        with reading_more(self._source.path):
            moved = np.array(self._points.Get(Usd.TimeCode(float(frame))), np.float32).reshape(-1, 3)
        if len(moved) != self.size:
            raise UserError(
                f"{self._source.path}: has {len(moved)} points at frame {frame:g}, its groom {self.size}; "
                "simulate again"
            )
        return to_metres(moved, self._source.space)

    def surfaces(self, frame: float) -> list[tuple[NDArray[np.float64], NDArray[np.int32]]]:
        """All that is visible beside hair at a frame, the head and cloths: points [m], shape (n, 3), and triangles."""
        with reading_more(self._source.path):
            if self._meshes is None:
                prims = visible_meshes(self._source)
                self._meshes = [(prim, mesh_at(self._source, prim).triangles) for prim in prims]
            return [
                (clip_at(self._source, prim, (frame, frame)).points[0], triangles) for prim, triangles in self._meshes
            ]

    def within(self, frames: tuple[int, int] | None) -> NDArray[np.float64]:
        """Its frames from the first to the last of ``frames``, all for None."""
        if frames is None:
            return self.frames
        chosen = self.frames[(self.frames >= frames[0]) & (self.frames <= frames[1])]
        if not len(chosen):
            held = f"{self.frames[0]:g} to {self.frames[-1]:g}"
            raise UserError(f"{self._source.path}: has no frame from {frames[0]:g} to {frames[1]:g}; it holds {held}")
        return chosen

    @property
    def cloth_prims(self) -> dict[str, str]:
        """What the cloths that moved with the locks are called, by their paths in the stage."""
        return {cloth["at"]: cloth["name"] for cloth in self._cloths}

    def cloths_at(self, frame: float) -> dict[str, NDArray[np.float32]]:
        """Where the vertices of cloths are at a frame [m], shape (n, 3), by what the cloths are called."""
        with reading_more(self._source.path):
            return {told["name"]: read_cloth(self._source, told, [frame]).points[0] for told in self._cloths}

    def cloths(self) -> list[CachedCloth]:
        """The cloths that moved with the locks, at all frames."""
        return [read_cloth(self._source, cloth, self.frames.tolist()) for cloth in self._cloths]


def is_cache(path: Path | str) -> bool:
    """Whether a file is a layer that moves locks, by what it says of itself: its points are not read."""
    try:
        with reading_more(path):
            layer = Sdf.Layer.OpenAsAnonymous(str(path), True)  # only its metadata
            told = layer.customLayerData.get("ringlet") if layer else None
            return isinstance(told, dict) and "statistics" in told
    except UserError:
        return False


def cache_groom_path(path: Path | str) -> Path:
    """The groom file that a cache lies over."""
    with reading(path) as source:
        groom_prim(source)
        layers = source.stage.GetPrimAtPath(LOCKS).GetPrimStack()
        return Path(next(spec.layer.realPath for spec in layers if spec.specifier == Sdf.SpecifierDef))


class CacheWriter(StreamWriter):
    """Writes a simulation while it runs: ``with CacheWriter(…) as writer: writer.add(frame, points, statistics)``.

    Nothing is at ``path`` until the block ends, and nothing new if it fails.

    space:  unit, up-axis and rate of the groom file
    cloths: what moves besides; only what they are called and where they come from counts
    variant: of the groom, where it has some
    start:  what was in the way when the simulation began
    """

    def __init__(
        self,
        path: Path | str,
        groom_path: Path | str,
        space: StageSpace,
        cloths: Sequence[CachedCloth] = (),
        variant: str | None = None,
    ) -> None:
        super().__init__(path, groom_path, space, variant)
        self.start: dict[str, Any] = {}
        self._cloths = cloths
        self._statistics: list[dict[str, Any]] = []

    def __enter__(self) -> Self:
        stage = self.begin()
        self._curves = UsdGeom.BasisCurves(stage.OverridePrim(LOCKS))
        self._shape = (len(self._curves.GetPointsAttr().Get()), 3)
        with reading(self.under) as groom:
            prims = ClothPrims(stage, groom)
            self._meshes = [prims.over(cloth) for cloth in self._cloths]
        return self

    def add(
        self,
        frame: float,
        points: NDArray,
        statistics: dict[str, Any] | None = None,
        cloths: Sequence[NDArray] = (),
    ) -> None:
        """Adds a frame.

        points:     where the locks are [m], shape (n, 3), in the order of the groom's locks
        statistics: what the solver reports
        cloths:     where the vertices of each cloth are [m]
        """
        if points.shape != self._shape:
            raise ValueError(f"cache: points have shape {points.shape}; must be {self._shape}")
        self.put(self._curves, frame, points)
        for mesh, places in zip(self._meshes, cloths, strict=True):
            set_cloth(mesh, frame, places, self.space)
        self._statistics.append(statistics or {})

    def finish(self) -> None:
        """Adds the statistics to the layer."""
        folder = self.path.absolute().parent
        cloths = [told_of(*of, folder) for of in zip(self._cloths, self._meshes, strict=True)]
        told = {
            name: json.dumps(what, separators=(",", ":"), default=lambda value: value.tolist())
            for name, what in (("statistics", self._statistics), ("start", self.start), ("cloths", cloths))
        }
        self.layer.customLayerData = {"ringlet": {"version": VERSION, **told}}
