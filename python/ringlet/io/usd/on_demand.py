"""Hairs on demand as USD: what a renderer makes hairs of, in place of their points.

``/groom/hairs`` is a ``GenerativeProcedural``: places of hairs in their locks, which stand once for all frames. Locks,
head and their motion are those of the layer below. Of several grooms each has its own prim, ``/groom/hairs/NAME``.

Primvars ``ringlet:layout:…`` are the inputs of the kernel (src/ringlet/groom/hairs.h), in SI units. Those of hairs are
``uniform``; those of locks, and ramps along hairs, are ``constant``. Lengths across a lock are in half precision.
The extents have a sample at each frame of the hairs.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Usd, UsdGeom, UsdProc

from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.errors import UserError
from ringlet.data.groom import GROOM as GROOM_ROW
from ringlet.data.groom import Groom
from ringlet.deform import AnyHairs, Hairs, JoinedHairs
from ringlet.io.space import from_metres
from ringlet.io.usd.cache import CacheFile
from ringlet.io.usd.clips import clip_at
from ringlet.io.usd.curves import OWN, add_own_attributes, set_attribute, set_display_color
from ringlet.io.usd.groom import GROOM, LOCKS, groom_at
from ringlet.io.usd.material import bind_hair_material
from ringlet.io.usd.mesh import mesh_at
from ringlet.io.usd.model import HAIRS_API
from ringlet.io.usd.stage import Source, prims, reading, reading_more
from ringlet.io.usd.stream import StreamWriter
from ringlet.io.usd.surfaces import shown_surfaces
from ringlet.io.usd.values import Types, float3, rows, set_primvar

HAIRS = f"{GROOM}/hairs"
KIND, TYPE = "RingletHairs", "hdGp:proceduralType"  # of the procedural, and the primvar that names it
LAYOUT = f"{OWN}layout:"
ACROSS = ("offset", "frizz", "escape", "family")  # lengths across a lock: half precision is 1/2048 of each
PER_HAIR = ("tip", "join", "flat", "taper", "share", "slip", "relax", "coil", "phase", *ACROSS)
PER_POINT = ("profile", "hold", "pace", "blend", "escaping", "relaxing", "tight", "opening")
CURL = ("slip", "escape", "relax", "family", "coil", "phase", "escaping", "relaxing", "tight", "opening")
DERIVED = {"guide_id", "lock"}  # attributes of hairs that follow from others


class OnDemandWriter(StreamWriter):
    """Writes hairs on demand: ``with OnDemandWriter(…) as writer: writer.add(frame, lock_points, scalp_points)``.

    The file appears at ``path`` when the block ends; an error leaves ``path`` unchanged.

    hairs:      with their attributes
    groom_path: groom or cache under the layer
    """

    def __init__(self, path: Path | str, groom: Groom, hairs: AnyHairs, groom_path: Path | str) -> None:
        super().__init__(path, groom_path, groom.space, groom.variant)
        self._groom, self._hairs = groom, hairs
        self._buffer = np.empty((max(len(part.curves.points) for part in hairs.parts), 3), np.float32)

    def __enter__(self) -> Self:
        stage, names = self.begin(), list(self._groom.grooms)
        if names:
            UsdGeom.Scope.Define(stage, HAIRS)
        self._prims, curves, first_lock = list[UsdProc.GenerativeProcedural](), self._hairs.curves, 0
        for row, part in enumerate(self._hairs.parts):
            own = curves.take(curves.curve[GROOM_ROW] == row) if names else curves
            ids = self._groom.locks.ids[first_lock : first_lock + len(part.axis)]
            self._prims.append(_define(stage, f"{HAIRS}/{names[row]}" if names else HAIRS, part, own, first_lock, ids))
            first_lock += len(part.axis)
        return self

    def add(self, frame: float | None, lock_points: NDArray, scalp_points: NDArray) -> None:
        """Adds a frame, or the rest pose for None: the extents of hairs on these locks and this scalp.

        lock_points, scalp_points: positions [m], shape (n, 3)
        """
        time, first = Usd.TimeCode.Default() if frame is None else Usd.TimeCode(float(frame)), 0
        for prim, part in zip(self._prims, self._hairs.parts, strict=True):
            end = first + len(part.groom.locks.points)
            own = np.ascontiguousarray(lock_points[first:end])
            points = part.deformed(own, scalp_points, out=self._buffer[: len(part.curves.points)])
            corners = np.stack([points.min(axis=0), points.max(axis=0)])
            corners += np.array([[-0.5], [0.5]]) * part.curves.point["width"].max()
            box = from_metres(corners, self.space)
            prim.CreateExtentAttr().Set(float3(np.stack([box.min(axis=0), box.max(axis=0)])), time)
            first = end
        self.record(frame, 24 * len(self._prims))


def _define(
    stage: Usd.Stage, path: str, hairs: Hairs, curves: Curves, first_lock: int, lock_ids: NDArray[np.int64]
) -> UsdProc.GenerativeProcedural:
    """Defines the prim of one groom's hairs.

    curves:     the hairs with their attributes, among those of all grooms
    first_lock: row of the groom's first lock in ``/groom/locks``
    lock_ids:   ids of the groom's locks there
    """
    defined = UsdProc.GenerativeProcedural.Define(stage, path)
    prim = defined.GetPrim()
    defined.CreateProceduralSystemAttr("hydraGenerativeProcedural")
    UsdGeom.PrimvarsAPI(prim).CreatePrimvar(TYPE, Types.Token, "constant").Set(KIND)
    prim.AddAppliedSchema(HAIRS_API)
    prim.CreateRelationship(f"primvars:{OWN}locks", custom=True).SetTargets([Sdf.Path(LOCKS)])
    set_primvar(prim, f"{OWN}id", "uniform", curves.ids)
    lock = np.repeat(np.arange(len(hairs.axis), dtype=np.int32), np.diff(hairs.layout["first"])) + np.int32(first_lock)
    set_primvar(prim, f"{OWN}lock", "uniform", lock)
    for name, values in curves.curve.items():
        if name not in DERIVED:
            narrow = values.astype(np.float32) if values.dtype == np.float64 else values
            set_attribute(prim, name, "uniform", narrow)
    along = hairs.layout["profile"].size
    _set_widths(prim, curves.point["width"].reshape(-1, along))
    for name, values in curves.point.items():
        if name != "width":
            set_attribute(prim, name, "vertex", values.astype(np.float32))
    _set_layout(prim, hairs, first_lock, lock_ids)
    set_display_color(prim, curves)
    bind_hair_material(prim, curves)
    return defined


def _set_widths(prim: Usd.Prim, widths: NDArray) -> None:
    """Widths [m], shape (hairs, points): one a hair and a ramp that all share, or else one a point."""
    most = widths.max(axis=1)
    ramp = widths[most.argmax()] / max(float(most.max()), 1e-12)
    if np.abs(most[:, None] * ramp - widths).max() <= 1e-4 * most.max():
        set_primvar(prim, f"{LAYOUT}width", "uniform", most)
        set_primvar(prim, f"{LAYOUT}thinning", "constant", ramp.astype(np.float32))
    else:
        set_primvar(prim, f"{LAYOUT}width", "vertex", widths.reshape(-1))


def _set_layout(prim: Usd.Prim, hairs: Hairs, first_lock: int, lock_ids: NDArray[np.int64]) -> None:
    values = {**hairs.layout, **hairs.layout["curl"]}
    for name in PER_HAIR:
        if name in values and len(values[name]):
            narrow = values[name].astype(np.float16 if name in ACROSS else np.float32)
            set_primvar(prim, LAYOUT + name, "uniform", narrow)
    for name in PER_POINT:
        if name in values:
            set_primvar(prim, LAYOUT + name, "constant", np.asarray(values[name], np.float32))
    if len(values["other"]):
        set_primvar(prim, f"{LAYOUT}other", "uniform", values["other"] + np.int32(first_lock))
    if len(values["window"]):
        set_primvar(prim, f"{LAYOUT}window", "constant", values["window"])
    set_primvar(prim, f"{LAYOUT}axis", "constant", hairs.axis.astype(np.float32))
    set_primvar(prim, f"{LAYOUT}lock_id", "constant", lock_ids)


def is_on_demand(prim: Usd.Prim) -> bool:
    """Whether a prim holds hairs on demand."""
    primvar = UsdGeom.PrimvarsAPI(prim).GetPrimvar(TYPE) if UsdProc.GenerativeProcedural(prim) else None
    return bool(primvar) and primvar.Get() == KIND


def on_demand_prims(source: Source) -> list[Usd.Prim]:
    """Prims of a stage that hold hairs on demand, those of each groom."""
    top = source.stage.GetPrimAtPath(HAIRS)
    return [prim for prim in prims(top) if is_on_demand(prim)] if top else []


def has_hairs_on_demand(path: Path | str) -> bool:
    """Whether a USD file holds hairs on demand."""
    with reading(path) as source:
        return bool(on_demand_prims(source))


def layer_under_on_demand(path: Path | str) -> Path:
    """The groom or cache under the layer with the hairs on demand of a stage."""
    with reading(path) as source:
        stack = on_demand_prims(source)[0].GetPrimStack()
        layer = next(spec.layer for spec in stack if spec.specifier == Sdf.SpecifierDef)
        return Path(layer.ComputeAbsolutePath(layer.subLayerPaths[0]))


def read_on_demand(path: Path | str) -> AnyHairs:
    """Reads the hairs on demand of a stage, for its locks at rest; raises UserError for a stage without."""
    with reading(path) as source:
        if not on_demand_prims(source):
            raise UserError(f"{path}: has no hairs on demand; make them with: ringlet hair GROOM --on-demand")
        return OnDemand(source).hairs


class OnDemand:
    """Hairs on demand of an open stage, with the locks, the scalp and the surfaces that carry them.

    hairs:  the hairs, without points
    frames: frames that they were made for, shape (k,); empty at rest
    """

    def __init__(self, source: Source) -> None:
        self._source, self.groom = source, groom_at(source)
        found, first = on_demand_prims(source), 0
        self.frames = np.array(UsdGeom.Boundable(found[0]).GetExtentAttr().GetTimeSamples(), np.float64)
        members, locks, points = dict[str, Hairs](), list[slice](), list[slice]()
        for prim in found:
            part = _read(source, prim, self.groom, first)
            members[prim.GetName()] = part
            end, offsets = first + len(part.axis), self.groom.locks.offsets
            locks.append(slice(first, end))
            points.append(slice(int(offsets[first]), int(offsets[end])))
            first = end
        if len(members) == 1 and not self.groom.grooms:
            self.hairs: AnyHairs = next(iter(members.values()))
        else:
            self.hairs = JoinedHairs(_joined(members, locks), members, locks, points)
        self._cache = CacheFile(source) if len(self.frames) else None
        self._bodies = [(prim, mesh_at(source, prim)) for prim in shown_surfaces(source)] if self._cache is None else []

    def points(self, frame: float | None) -> NDArray[np.floating]:
        """Positions of all hairs at a frame, at rest for None [m], shape (n, 3)."""
        scalp, triangles = self.groom.scalp.points, self.groom.scalp.triangles
        if frame is None or self._cache is None:
            around = [(mesh.points, mesh.triangles) for _, mesh in self._bodies] or [(scalp, triangles)]
            return self.hairs.deformed(self.groom.locks.points, scalp, surfaces=around)
        with reading_more(self._source.path):
            target = self._source.stage.GetRelationshipAtPath(f"{GROOM}.ringlet:scalp").GetTargets()[0]
            moved = clip_at(self._source, self._source.stage.GetPrimAtPath(target), (frame, frame)).points[0]
        around = self._cache.surfaces(frame) or [(moved, triangles)]
        return self.hairs.deformed(self._cache.points(frame), moved, surfaces=around)

    def curves(self, frame: float | None) -> Curves:
        """The hairs at a frame, by default the first, or at rest where nothing moves."""
        if frame is None and len(self.frames):
            frame = float(self.frames[0])
        return replace(self.hairs.curves, points=self.points(frame))

    def sets(self) -> list[tuple[str, Curves, slice]]:
        """Names and hairs of each prim, without points, and their rows among the points of all."""
        found, first, lock = [], 0, 0
        for prim, part in zip(on_demand_prims(self._source), self.hairs.parts, strict=True):
            end = first + int(part.curves.offsets[-1])
            found.append((prim.GetName(), _of_all_locks(part.curves, lock), slice(first, end)))
            first, lock = end, lock + len(part.axis)
        return found


def _read(source: Source, prim: Usd.Prim, groom: Groom, first_lock: int) -> Hairs:
    """The hairs of one prim, whose locks begin at a row of those of all grooms.

    Raises UserError for a groom that has changed since, and for damaged hairs.
    """
    where, values = source.where(prim), _layout_values(prim)
    try:
        axis, ids = np.asarray(values.pop("axis"), np.float64), values.pop("lock_id")
        rows_of = slice(first_lock, first_lock + len(axis))
        if not np.array_equal(ids, groom.locks.ids[rows_of]):
            raise UserError(f"{where}: the groom under it has other locks than when it was made; make the hairs again")
        lock = np.array(UsdGeom.PrimvarsAPI(prim).GetPrimvar(f"{OWN}lock").Get(), np.int32) - np.int32(first_lock)
        counts = np.bincount(lock, minlength=len(axis))
        if len(counts) != len(axis) or (np.diff(lock) < 0).any() or not counts.all():
            raise ValueError("locks")
        along = values["profile"].size
        width = values.pop("width")
        if "thinning" in values:
            width = (width[:, None] * values.pop("thinning")).reshape(-1)
        curves = Curves(
            np.empty((len(lock) * along, 3), np.float32),
            offsets_from_counts(np.full(len(lock), along)),
            np.array(UsdGeom.PrimvarsAPI(prim).GetPrimvar(f"{OWN}id").Get(), np.int64),
        )
        add_own_attributes(curves, prim, where, skipped=(LAYOUT, TYPE))
        curves.point["width"] = width
        curves.curve |= {"lock": lock, "guide_id": groom.locks.ids[rows_of][lock]}
        barycentric = np.asarray(curves.curve["root_barycentric"], np.float64)
        curves.curve["root_barycentric"] = barycentric / barycentric.sum(axis=1, keepdims=True)
        triangle = curves.curve["root_triangle"]
        if (triangle < 0).any() or (triangle >= len(groom.scalp.triangles)).any() or len(width) != len(curves.points):
            raise ValueError("roots")
        chosen = np.arange(rows_of.start, rows_of.stop)
        hairs = Hairs(curves, replace(groom, locks=groom.locks.take(chosen)), axis, _layout(values, lock, first_lock))
        hairs.deformed(hairs.groom.locks.points, groom.scalp.points, out=curves.points)  # refuses what does not fit
    except (AttributeError, IndexError, KeyError, TypeError, ValueError):
        raise UserError(f"{where}: its hairs are damaged; make them again: ringlet hair GROOM --on-demand") from None
    return hairs


def _joined(members: dict[str, Hairs], locks: list[slice]) -> Curves:
    """Hairs of all grooms, whose locks are rows of those of all."""
    each = zip((hairs.curves for hairs in members.values()), locks, strict=True)
    return Curves.joined([_of_all_locks(curves, rows_of.start) for curves, rows_of in each])


def _of_all_locks(curves: Curves, first: int) -> Curves:
    """Hairs of one groom, with the rows of their locks among those of all grooms, which begin at ``first``."""
    return replace(curves, curve={**curves.curve, "lock": curves.curve["lock"] + np.int32(first)})


def _layout_values(prim: Usd.Prim) -> dict[str, NDArray]:
    """Arrays of the layout by name, in single precision."""
    found = dict[str, NDArray]()
    for primvar in UsdGeom.PrimvarsAPI(prim).GetPrimvarsWithAuthoredValues():
        if (name := primvar.GetPrimvarName()).startswith(LAYOUT):
            values = rows(primvar, np.array(primvar.Get()))
            found[name.removeprefix(LAYOUT)] = values.astype(np.float32) if values.dtype == np.float16 else values
    return found


def _layout(values: dict[str, NDArray], lock: NDArray[np.int32], first_lock: int) -> dict[str, Any]:
    """Inputs of the kernel, of the arrays of a prim."""
    if "other" in values:
        values["other"] = values["other"] - np.int32(first_lock)
    return {
        "other": np.empty(0, np.int32),
        "share": np.empty(0, np.float32),
        "window": np.empty(0, np.int32),
        **{name: array for name, array in values.items() if name not in CURL},
        "first": offsets_from_counts(np.bincount(lock)),
        "curl": {name: values[name] for name in CURL if name in values},
    }
