"""A simulation as USD: a layer over the groom that animates the points of ``/groom/locks``, of cloths and of what the
hair wears."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Usd, UsdGeom

from ringlet.data.accessory import Accessory
from ringlet.data.cache import Cache, CachedCloth
from ringlet.data.errors import UserError
from ringlet.data.frames import frames_within, refuse_gaps
from ringlet.data.mesh import Mesh
from ringlet.data.stage import StageSpace
from ringlet.io.space import to_metres
from ringlet.io.usd.clips import clip_at
from ringlet.io.usd.cloths import ClothPrims, cloth_metadata, read_cloth, set_cloth
from ringlet.io.usd.curves import OWN, own_curves, own_ids
from ringlet.io.usd.damage import check_bytes
from ringlet.io.usd.groom import LOCKS, VERSION, check_version, groom_prim, read_accessories
from ringlet.io.usd.mesh import mesh_at
from ringlet.io.usd.place import Place, placed
from ringlet.io.usd.stage import Source, parse_json, reading, reading_more
from ringlet.io.usd.stream import StreamWriter
from ringlet.io.usd.surfaces import shown_surfaces
from ringlet.io.usd.values import Types, triples

LAG = f"{OWN}lag"


def write_cache(
    cache: Cache, groom_path: Path | str, path: Path | str, space: StageSpace, variant: str | None = None
) -> None:
    """Writes a simulation as a layer over the groom file.

    space:   unit, up-axis and rate of the groom file
    variant: selected variant of the groom, if it has variants
    """
    with CacheWriter(path, groom_path, space, cache.cloths, variant) as writer:
        writer.start = cache.start
        for index, (frame, points) in enumerate(zip(cache.frames, cache.points, strict=True)):
            statistics = cache.statistics[index] if index < len(cache.statistics) else None
            writer.add(frame, points, statistics, [cloth.points[index] for cloth in cache.cloths])


def read_cache(path: Path | str) -> Cache:
    """Reads all frames of a simulation, or of the simulation under a layer of hairs."""
    with open_cache(path) as cache:
        points = np.empty((len(cache.frames), cache.size, 3), np.float64 if cache.is_placed else np.float32)
        for index, frame in enumerate(cache.frames):
            points[index] = cache.points(frame)
        return Cache(cache.frames, points, cache.statistics, cache.start, cache.cloths())


@contextmanager
def open_cache(path: Path | str) -> Iterator[CacheFile]:
    """Opens a simulation, or the simulation under a layer of hairs, to read one frame at a time."""
    with reading(path) as source:
        yield CacheFile(source)


class CacheFile:
    """A simulation in a file, read one frame at a time.

    frames:     frame numbers (time codes), shape (k,)
    size:       number of points of all locks
    ids:        ids of the locks, shape (count,)
    statistics: report of the solver, one dict per frame
    start:      initial penetrations
    made_from:  digest of all that the simulation depends on; empty where it is not known

    Raises UserError for a file without simulated frames.
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
        self.ids = own_ids(self._points.GetPrim())
        metadata = [layer.customLayerData.get("ringlet") or {} for layer in source.stage.GetLayerStack()]
        for data in metadata:
            check_version(source, data.get("version", VERSION))

        def entry(name: str, empty: str) -> Any:
            return parse_json(source, next((data[name] for data in metadata if name in data), empty), f"ringlet:{name}")

        self.statistics: list[dict[str, Any]] = entry("statistics", "[]")
        self.start: dict[str, Any] = entry("start", "{}")
        self.made_from = str(next((data["made_from"] for data in metadata if "made_from" in data), ""))
        self._cloths: list[dict[str, Any]] = entry("cloths", "[]")
        self._meshes: list[tuple[Usd.Prim, Mesh]] | None = None

    def points(self, frame: float) -> NDArray[np.floating]:
        """Positions of the locks at a frame [m], shape (n, 3), in the order of the groom's locks; float64 far away.

        Raises UserError when the number of points differs from the groom's.
        """
        with reading_more(self._source.path):
            time = Usd.TimeCode(float(frame))
            points = triples(self._points.Get(time), f"{self._source.path}: its points", np.float32)
            points = placed(points, self._points.GetPrim(), time)
        if len(points) != self.size:
            raise UserError(
                f"{self._source.path}: has {len(points)} points at frame {frame:g}, its groom {self.size}; "
                "simulate again"
            )
        if not np.isfinite(points).all():
            row = int((~np.isfinite(points)).any(axis=1).argmax())
            raise UserError(
                f"{self._source.path}: point {row} of {self.size} is not finite at frame {frame:g}; simulate again"
            )
        return to_metres(points, self._source.space)

    def lag(self, frame: float) -> float:
        """How far anything lagged behind its animation at a frame [m]."""
        at = int(np.searchsorted(self.frames, frame))
        statistics = self.statistics[at] if at < len(self.statistics) else {}
        return float((statistics.get("contact") or {}).get("lag", 0.0))

    def surfaces(self, frame: float) -> list[tuple[NDArray[np.float64], NDArray[np.int32]]]:
        """Visible meshes at a frame, the head and cloths: points [m], shape (n, 3), and triangles (m, 3).

        Raises UserError for a mesh that has another number of points at that frame than at rest.
        """
        with reading_more(self._source.path):
            if self._meshes is None:
                prims = shown_surfaces(self._source)
                self._meshes = [(prim, mesh_at(self._source, prim)) for prim in prims]
            found = []
            for prim, mesh in self._meshes:
                points = clip_at(self._source, prim, (frame, frame)).points[0]
                if points.shape != mesh.points.shape:
                    raise UserError(
                        f"{self._source.where(prim)}: has {len(points)} points at frame {frame:g}, {len(mesh.points)} "
                        "at rest; the mesh has changed since the simulation: simulate again"
                    )
                found.append((points, mesh.triangles))
            return found

    def within(self, frames: tuple[float, float] | None) -> NDArray[np.float64]:
        """Frames in a closed range, all for None; raises UserError for a range with frames that are not there."""
        chosen = frames_within(self.frames, frames, self._source.path)
        refuse_gaps(chosen, self._source.path, "simulate again, or choose frames without it")
        return chosen

    @property
    def is_placed(self) -> bool:
        """Whether its locks have a transform, as far from the origin."""
        return bool(UsdGeom.Xformable(self._points.GetPrim()).GetOrderedXformOps())

    @property
    def cloth_prims(self) -> dict[str, str]:
        """Names of the simulated cloths, by prim path in the stage."""
        return {cloth["at"]: cloth["name"] for cloth in self._cloths}

    def cloths_at(self, frame: float) -> dict[str, NDArray[np.floating]]:
        """Positions of the cloths' vertices at a frame [m], shape (n, 3) each, by name."""
        with reading_more(self._source.path):
            return {entry["name"]: read_cloth(self._source, entry, [frame]).points[0] for entry in self._cloths}

    def cloths(self) -> list[CachedCloth]:
        """The simulated cloths at all frames."""
        return [read_cloth(self._source, cloth, self.frames.tolist()) for cloth in self._cloths]


def is_cache(path: Path | str) -> bool:
    """Whether a file is a simulation cache; reads only its metadata."""
    try:
        with reading_more(path):
            check_bytes(path)
            layer = Sdf.Layer.OpenAsAnonymous(str(path), True)  # metadata only
            data = layer.customLayerData.get("ringlet") if layer else None
            return isinstance(data, dict) and "statistics" in data
    except UserError:
        return False


def cache_groom_path(path: Path | str) -> Path:
    """Path of the groom file under a cache."""
    with reading(path) as source:
        groom_prim(source)
        layers = source.stage.GetPrimAtPath(LOCKS).GetPrimStack()
        return Path(next(spec.layer.realPath for spec in layers if spec.specifier == Sdf.SpecifierDef))


class CacheWriter(StreamWriter):
    """Writes a simulation while it runs: ``with CacheWriter(…) as writer: writer.add(frame, points, statistics)``.

    The file appears at ``path`` when the block ends; an error leaves ``path`` unchanged.

    space:     unit, up-axis and rate of the groom file
    cloths:    names and sources of simulated cloths; their points are not used
    variant:   selected variant of the groom, if it has variants
    start:     initial penetrations
    made_from: digest of all that the simulation depends on
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
        self.made_from = ""
        self._cloths = cloths
        self._statistics: list[dict[str, Any]] = []
        self._lagging: UsdGeom.Primvar | None = None
        self._place_of: dict[int, int] = {}  # index of each lock, by id
        self._before: float | None = None  # the last frame without

    def __enter__(self) -> Self:
        stage = self.begin()
        self._curves = UsdGeom.BasisCurves(stage.OverridePrim(LOCKS))
        self._locks = own_curves(Source(self.path, stage, self.space), self._curves.GetPrim())
        with reading(self.under) as groom:
            prims = ClothPrims(stage, groom)
            self._meshes = [prims.over(cloth) for cloth in self._cloths]
            cloths = {mesh.GetPrim().GetPath() for mesh in self._meshes}
            worn = [(prim, one) for prim, one in read_accessories(groom) if prim.GetPath() not in cloths]
        self._places = [Place(mesh.GetPrim(), self.space, self.path) for mesh in self._meshes]
        self._worn = [self._over(stage, prim.GetPath(), accessory) for prim, accessory in worn]
        return self

    def _over(self, stage: Usd.Stage, path: Sdf.Path, accessory: Accessory) -> tuple[UsdGeom.Mesh, Place, Accessory]:
        prim = stage.OverridePrim(path)
        return UsdGeom.Mesh(prim), Place(prim, self.space, self.path), accessory

    def add(
        self,
        frame: float,
        points: NDArray,
        statistics: dict[str, Any] | None = None,
        cloths: Sequence[NDArray] = (),
        *,
        around: NDArray | None = None,
    ) -> None:
        """Adds a frame.

        points:     positions of the locks [m], shape (n, 3), in the order of the groom's locks
        statistics: report of the solver
        cloths:     positions of each cloth's vertices [m], shape (k, 3) each
        around:     points of the head [m], shape (m, 3); by default the roots

        Raises UserError for positions that are not finite, far from the head, or not as many as the groom's.
        """
        around = points[self._locks.offsets[:-1]] if around is None else around
        self.put(self._curves, frame, points, self._locks, around)
        self._add_lag(frame, statistics or {})
        for mesh, place, positions in zip(self._meshes, self._places, cloths, strict=True):
            set_cloth(mesh, frame, positions, place, around)
        for mesh, place, accessory in self._worn:
            set_cloth(mesh, frame, accessory.at(self._locks.points, points), place, around)
        self._statistics.append(statistics or {})

    def _add_lag(self, frame: float, statistics: dict[str, Any]) -> None:
        """Per lock, the lag of what it touches [m]: a primvar, from the first frame that has any."""
        entries = (statistics.get("contact") or {}).get("lagging", [])
        if not entries and self._lagging is None:
            self._before = frame
            return
        prim = self._curves.GetPrim()
        if self._lagging is None:
            ids = own_ids(prim)
            self._place_of = {int(lock): k for k, lock in enumerate(ids)}
            self._lagging = UsdGeom.PrimvarsAPI(prim).CreatePrimvar(LAG, Types.FloatArray, "uniform")
            if self._before is not None:
                self._lagging.Set([0.0] * len(ids), self._before)
        distance = [0.0] * len(self._place_of)
        for entry in entries:
            for lock in entry["locks"]:
                place = self._place_of[lock]
                distance[place] = max(distance[place], entry["distance"])
        self._lagging.Set(distance, frame)

    def finish(self) -> None:
        """Writes the metadata of the layer."""
        folder = self.path.absolute().parent
        cloths = [cloth_metadata(*of, folder) for of in zip(self._cloths, self._meshes, strict=True)]
        metadata = {
            name: json.dumps(values, separators=(",", ":"), default=lambda value: value.tolist())
            for name, values in (("statistics", self._statistics), ("start", self.start), ("cloths", cloths))
        }
        self.layer.customLayerData = {"ringlet": {"version": VERSION, "made_from": self.made_from, **metadata}}
