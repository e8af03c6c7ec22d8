"""Render hairs as USD: ``/groom/hairs`` in a layer over the groom or the cache, which includes the head.

Of several grooms each has its own prim, ``/groom/hairs/NAME``, for its own material and visibility.

Also reads the bodies and hairs of a stage for pictures.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Self

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Usd, UsdGeom

from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.errors import UserError
from ringlet.data.frames import refuse_gaps
from ringlet.data.groom import GROOM as GROOM_ROW
from ringlet.data.groom import Groom
from ringlet.data.mesh import Clip
from ringlet.data.precision import compact
from ringlet.io.usd.clips import clip_at, whole_frames
from ringlet.io.usd.curves import (
    curve_widths,
    curves_at,
    define_curves,
    own_curves,
    set_display_color,
    set_rest,
    set_roots,
)
from ringlet.io.usd.material import bind_hair_material
from ringlet.io.usd.mesh import Body, mesh_at
from ringlet.io.usd.on_demand import HAIRS, OnDemand, on_demand_prims
from ringlet.io.usd.pose import rest_time
from ringlet.io.usd.stage import Source, prims, reading
from ringlet.io.usd.stream import StreamWriter
from ringlet.io.usd.surfaces import filled, shown_surfaces
from ringlet.io.usd.values import Types, set_primvar

LOD = "LOD"  # variant set of /groom/hairs, with the variants LOD0, LOD1, … from the finest on
COLOR = (0.06, 0.035, 0.02)  # dark brown, for viewports
LOCK_INDEX = "lock"  # curve attribute: row of a hair's lock


class HairWriter(StreamWriter):
    """Writes hairs: ``with HairWriter(…) as writer: writer.add(frame, points)``.

    The file appears at ``path`` when the block ends; an error leaves ``path`` unchanged.

    curves:     hairs at rest with their attributes; ``width`` is the diameter [m], ``lock`` the row of a hair's lock
    groom_path: groom or cache under the layer
    velocities: writes them too, in units per second, which doubles the size of the file
    coarser:    hairs of further levels of detail; with any, each level is a variant of ``/groom/hairs``
    """

    def __init__(
        self,
        path: Path | str,
        groom: Groom,
        curves: Curves,
        groom_path: Path | str,
        velocities: bool = False,
        coarser: Sequence[Curves] = (),
    ) -> None:
        super().__init__(path, groom_path, groom.space, groom.variant)
        self._groom, self._levels, self.moving = groom, [curves, *coarser], velocities
        self._has_rest: set[int] = set()

    def __enter__(self) -> Self:
        stages = [self.begin()]
        if len(self._levels) > 1:
            choice = self._stage.OverridePrim(HAIRS).GetVariantSets().AddVariantSet(LOD)
            names = [f"{LOD}{level}" for level in range(len(self._levels))]
            for name in names:
                choice.AddVariant(name)
            choice.SetVariantSelection(names[0])
            stages = [self._selecting(name) for name in names]
        # Prims are valid while their stage is.
        self._stages, each = stages, zip(stages, self._levels, strict=True)
        self._prims = [self._define_level(stage, hairs) for stage, hairs in each]
        return self

    def _selecting(self, level: str) -> Usd.Stage:
        """A stage of the layer in which a level of detail is selected, and written to."""
        stage = Usd.Stage.Open(self.layer, Sdf.Layer.CreateAnonymous())
        stage.SetEditTarget(stage.GetSessionLayer())
        choice = stage.GetPrimAtPath(HAIRS).GetVariantSets().GetVariantSet(LOD)
        choice.SetVariantSelection(level)
        stage.SetEditTarget(choice.GetVariantEditTarget(self.layer))
        return stage

    def _define_level(self, stage: Usd.Stage, hairs: Curves) -> list[tuple[UsdGeom.BasisCurves, Curves, slice]]:
        """Defines the prims of one level: each with its hairs, and their rows among the points of the level."""
        if not self._groom.grooms:
            return [(self._define(stage, HAIRS, hairs), hairs, slice(None))]
        UsdGeom.Scope.Define(stage, HAIRS)
        defined = []
        for row, name in enumerate(self._groom.grooms):
            chosen = np.flatnonzero(hairs.curve[GROOM_ROW] == row)
            own, offsets = hairs.take(chosen), hairs.offsets
            rows = slice(int(offsets[chosen[0]]), int(offsets[chosen[-1] + 1]))
            defined.append((self._define(stage, f"{HAIRS}/{name}", own), own, rows))
        return defined

    def _define(self, stage: Usd.Stage, path: str, hairs: Curves) -> UsdGeom.BasisCurves:
        """Defines curves with the primvars that other programs need."""
        curves = define_curves(stage, path, hairs, self.space, guide=False)
        prim = curves.GetPrim()
        set_roots(prim, hairs, self._groom.scalp)
        if not set_display_color(prim, hairs):
            set_primvar(prim, "displayColor", "constant", np.array([COLOR], np.float32), Types.Color3fArray)
        if LOCK_INDEX in hairs.curve:
            for name in ("guide_curve_index", "clumpid"):
                set_primvar(prim, name, "uniform", hairs.curve[LOCK_INDEX].astype(np.int32))
        if "color" in hairs.point:
            set_primvar(prim, "groom_color", "vertex", hairs.point["color"].astype(np.float32), Types.Color3fArray)
        bind_hair_material(prim, hairs, self._stage)
        return curves

    def add_adjacent(self, frame: float, points: NDArray, *, level: int = 0) -> None:
        """Takes the frame before the first, or after the last, of a level of detail [m], for the velocities there."""
        for prim, _, rows in self._prims[level]:
            self.put_adjacent(prim, frame, points[rows])

    def add(self, frame: float | None, points: NDArray, *, around: NDArray | None = None, level: int = 0) -> None:
        """Adds a frame of a level of detail, or the rest pose for None.

        points: positions [m], shape (n, 3), preferably float32
        around: points of the head [m], shape (k, 3); by default the roots

        Raises UserError for positions that are not finite, far from the head, or not as many as the curves have.
        """
        for prim, hairs, rows in self._prims[level]:
            if level not in self._has_rest:
                rest = points[rows] if frame is None else hairs.points
                set_rest(prim, self.put(prim, None, rest, hairs, self._groom.scalp.points))
            if frame is not None:
                self.put(prim, frame, points[rows], hairs, around)
        self._has_rest.add(level)


def read_hairs(path: Path | str, frame: float | None = None) -> Curves:
    """Reads the hairs of a stage at a frame [m], float32; by default at the first frame, or at rest if static.

    Raises UserError for a stage without hairs.
    """
    with reading(path) as source:
        hairs = _hairs(source, frame)
        if hairs is None:
            raise UserError(f"{path}: has no hairs; make them with: ringlet hair GROOM -o hair.usdc")
        return hairs


def read_stage(path: Path | str, frame: float | None = None) -> tuple[list[Body], Curves | None, NDArray[np.float64]]:
    """Reads visible bodies, hairs (None if there are none) and the whole frames of a stage, for a picture.

    frame: reads hairs and clips at this frame only; by default whole clips and the hairs of the first frame
    """
    with reading(path) as source:
        hairs, frames = _hairs(source, frame), _frames(source)
        bodies = []
        for prim in shown_surfaces(source):
            mesh = mesh_at(source, prim)
            if frame is not None:
                clip = clip_at(source, prim, (frame, frame))
            elif hairs is not None and not len(frames):  # static hairs need the head at rest
                clip = Clip(np.zeros(1), mesh.points[None], source.space.fps)
            else:
                clip = clip_at(source, prim)
            bodies.append(Body(mesh, clip, str(prim.GetPath())))
        return bodies, hairs, frames


def groom_names(path: Path | str) -> list[str]:
    """Names of the grooms of the hairs of a stage, where these are of several."""
    with reading(path) as source:
        own = source.stage.GetPrimAtPath(HAIRS)
        scope = bool(own) and own.GetTypeName() == "Scope"
        return [prim.GetName() for prim in own.GetChildren()] if scope else []


def read_hair_frames(path: Path | str) -> NDArray[np.float64]:
    """Whole frames of a stage with animated hairs; empty for static hairs."""
    with reading(path) as source:
        return _frames(source)


def _frames(source: Source) -> NDArray[np.float64]:
    if made := on_demand_prims(source):
        samples = UsdGeom.Boundable(made[0]).GetExtentAttr().GetTimeSamples()
    else:
        points = (UsdGeom.PointBased(prim).GetPointsAttr() for prim in _hair_prims(source))
        samples = sorted({time for attribute in points for time in attribute.GetTimeSamples()})
    if source.stage.GetPrimAtPath(HAIRS):  # one sample a frame
        refuse_gaps(np.array(samples), source.path, "make the hairs again")
    return whole_frames(min(samples), max(samples), str(source.path)) if samples else np.empty(0)


def _hair_prims(source: Source) -> list[Usd.Prim]:
    """Curves that are visible in a render."""
    if own := source.stage.GetPrimAtPath(HAIRS):
        return [own] if UsdGeom.BasisCurves(own) else [prim for prim in own.GetChildren() if UsdGeom.BasisCurves(prim)]
    shown = (UsdGeom.Tokens.default_, UsdGeom.Tokens.render)
    found = filled(prim for prim in prims(source.stage.GetPseudoRoot()) if UsdGeom.BasisCurves(prim))
    return [prim for prim in found if UsdGeom.Imageable(prim).ComputePurpose() in shown]


def _hairs(source: Source, frame: float | None) -> Curves | None:
    """Hairs of a stage at a frame, merged into one list of curves."""
    if on_demand_prims(source):
        return OnDemand(source).curves(frame).check(str(source.path))
    found = [_hairs_at(source, prim, frame) for prim in _hair_prims(source)]
    if len(found) < 2:
        return found[0] if found else None
    if all(GROOM_ROW in curves.curve for curves in found):
        return Curves.joined(found)
    counts = np.concatenate([curves.counts for curves in found])
    return Curves(
        np.concatenate([curves.points for curves in found]),
        offsets_from_counts(counts),
        np.arange(len(counts), dtype=np.int64),
        point={"width": np.concatenate([curves.point["width"] for curves in found])},
    )


def _hairs_at(source: Source, prim: Usd.Prim, frame: float | None) -> Curves:
    """Hairs of one prim at a frame, float32, with the point attribute ``width``."""
    samples = UsdGeom.PointBased(prim).GetPointsAttr().GetTimeSamples()
    if frame is None and samples:
        frame = samples[0]
    time = rest_time(source, prim) if frame is None else Usd.TimeCode(frame)
    if prim.GetPath().HasPrefix(HAIRS):
        curves = own_curves(source, prim, time, np.float32)
    else:
        curves = curves_at(source, prim, time)
        curves.points = compact(curves.points)
    if "width" not in curves.point:
        curves.point["width"] = curve_widths(curves)
    return curves.check(source.where(prim))
