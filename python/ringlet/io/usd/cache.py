"""A simulation as USD: a layer over the groom that moves the points of ``/groom/locks``, and those of cloths."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Usd, UsdGeom

from ringlet.errors import UserError
from ringlet.io.space import to_metres
from ringlet.io.usd.cloths import ClothPrims, read_cloth, set_cloth, told_of
from ringlet.io.usd.groom import LOCKS, VERSION, check_version, groom_prim
from ringlet.io.usd.stage import parse_json, reading
from ringlet.io.usd.stream import StreamWriter
from ringlet.shot.cache import Cache, CachedCloth
from ringlet.stage import StageSpace


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
    """Reads a simulation, or the one under hairs."""
    with reading(path) as source:
        groom_prim(source)
        attribute = UsdGeom.PointBased(source.stage.GetPrimAtPath(LOCKS)).GetPointsAttr()
        frames = attribute.GetTimeSamples()
        if not frames:
            raise UserError(
                f"{path}: holds no simulated frames; make a cache with: ringlet sim SHOT.toml -o cache.usdc"
            )
        rest = len(attribute.Get(Usd.TimeCode.Default()))
        points = np.empty((len(frames), rest, 3), np.float32)
        for index, frame in enumerate(frames):
            moved = np.array(attribute.Get(frame))
            if len(moved) != rest:
                raise UserError(f"{path}: has {len(moved)} points at frame {frame:g}, its groom {rest}; simulate again")
            points[index] = to_metres(moved, source.space)
        kept = [layer.customLayerData.get("ringlet") or {} for layer in source.stage.GetLayerStack()]
        for data in kept:
            check_version(source, data.get("version", VERSION))
        told = {
            name: parse_json(source, next((data[name] for data in kept if name in data), empty), f"ringlet:{name}")
            for name, empty in (("statistics", "[]"), ("start", "{}"), ("cloths", "[]"))
        }
        told["cloths"] = [read_cloth(source, cloth, frames) for cloth in told["cloths"]]
        return Cache(np.array(frames), points, **told)


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
