"""All curves and surfaces of a stage, whoever wrote it; and a stage of curves and surfaces from other formats."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom, UsdShade

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.frames import gaps
from ringlet.data.hair_scene import CurveSet, HairScene
from ringlet.data.mesh import Clip, Mesh
from ringlet.data.reads import record
from ringlet.data.stage import StageSpace
from ringlet.io.usd.clips import clip_over, sampled_frames
from ringlet.io.usd.curves import COMMON, curves_at, define_curves, points_at, set_points, set_rest, unused
from ringlet.io.usd.groom import GROOM, GUIDES, LOCKS
from ringlet.io.usd.material import HAIR_BSDF, OWN_MATERIAL, bind_hair_material
from ringlet.io.usd.mesh import define_mesh, mesh_at
from ringlet.io.usd.model import make_model, set_extents_hint
from ringlet.io.usd.names import identifier
from ringlet.io.usd.on_demand import OnDemand, on_demand_prims
from ringlet.io.usd.place import Place
from ringlet.io.usd.pose import motion_samples, rest_time
from ringlet.io.usd.stage import Source, layer_files, new_stage, prims, reading, reading_more, writing
from ringlet.io.usd.surfaces import is_empty, is_shown, shown_surfaces
from ringlet.io.usd.values import Types, set_primvar
from ringlet.io.usd.velocities import Velocities

DEFAULT = Usd.TimeCode.Default()
PLAIN = {  # attributes with a type of their own in the schema of other programs
    "st": Types.TexCoord2fArray,
    "displayColor": Types.Color3fArray,
    "groom_color": Types.Color3fArray,
    "surface_uv_coordinate": None,
    "displayOpacity": None,
    "groom_root_uv": None,
    "skinprim": None,
    "skinprimuv": Types.TexCoord2fArray,
    "guide_curve_index": None,
    "clumpid": None,
}


@contextmanager
def open_usd_scene(path: Path) -> Iterator[HairScene]:
    """Opens a stage; its frames are read as they are asked for.

    Locks of a groom of Ringlet's are its guides. Its drawn guides, which nothing moves, are left out.
    """
    with reading(path) as source:
        found = [prim for prim in prims(source.stage.GetPseudoRoot()) if UsdGeom.BasisCurves(prim)]
        if source.stage.GetPrimAtPath(LOCKS):
            found = [prim for prim in found if str(prim.GetPath()) != GUIDES]
        found = [prim for prim in found if UsdGeom.Imageable(prim).ComputeVisibility() != UsdGeom.Tokens.invisible]
        found = [prim for prim in found if not is_empty(prim)]
        surfaces = shown_surfaces(source)
        times = [time for prim in found for time in _posed_at(source, prim)]
        around = [time for prim in surfaces for time in motion_samples(source, prim)]
        times += [time for time in around if not found or (times and min(times) < time < max(times))]
        frames = sampled_frames(times, str(path)) if times else np.empty(0)
        unread = [f"{prim.GetPath()} is a {prim.GetTypeName()}, which is not read" for prim in _others(source, found)]
        sets = [*_made_on_demand(source), *(one for prim in found for one in _curve_sets(source, prim, unread))]
        record(path, *layer_files(source.stage))  # the caller may write while the stage is open
        bodies = [_body(source, prim, frames) for prim in surfaces]
        unread += _unread_motion(around, frames, bool(found))
        yield HairScene(sorted(sets, key=lambda one: one.guide), bodies, frames, source.space, unread)


def _others(source: Source, found: list[Usd.Prim]) -> Iterator[Usd.Prim]:
    """Visible geometry that is neither curves that are read nor a surface."""
    for prim in prims(source.stage.GetPseudoRoot()):
        if UsdGeom.Gprim(prim) and prim not in found and not UsdGeom.Mesh(prim) and is_shown(prim):
            own = prim.GetPath().HasPrefix(GROOM)
            if not (own or UsdGeom.BasisCurves(prim)):
                yield prim


def _unread_motion(times: list[float], frames: NDArray, curves: bool) -> Iterator[str]:
    """A sentence for motion of surfaces that the frames of curves do not have."""
    if not times or not curves:
        return
    span = f"surfaces move from {min(times):g} to {max(times):g}"
    if not len(frames):
        yield f"{span} and the curves do not: without that motion"
    elif min(times) < frames[0] or max(times) > frames[-1]:
        yield f"{span}: only {frames[0]:g} to {frames[-1]:g} are kept, in which the curves move"


def _curve_sets(source: Source, prim: Usd.Prim, unread: list[str]) -> list[CurveSet]:
    """The curves of a prim; its hairs and its guides apart, where it has both."""
    names = list[str]()
    curves = curves_at(source, prim, rest_time(source, prim), names)
    moves, name = _posed_at(source, prim), prim.GetName()
    unread += [note.removeprefix(f"{source.path} ") for note in unused(source, prim)]
    if names:
        unread.append(f"{name}: {', '.join(names)} have no type or length of attributes of curves")
    timed = [
        primvar.GetPrimvarName()
        for primvar in UsdGeom.PrimvarsAPI(prim).GetPrimvarsWithAuthoredValues()
        if primvar.ValueMightBeTimeVarying()
    ]
    if UsdGeom.BasisCurves(prim).GetWidthsAttr().ValueMightBeTimeVarying():
        timed.append("widths")
    if timed:
        unread.append(f"{name}: {', '.join(timed)} change over time and are kept as at first")
    rates = UsdGeom.PointBased(prim).GetVelocitiesAttr(), UsdGeom.PointBased(prim).GetAccelerationsAttr()
    if rated := [one.GetName() for one in (rates if len(moves) < 2 else rates[1:]) if one.HasAuthoredValue()]:
        unread.append(f"{name}: its {' and '.join(rated)} are not read; the motion is that of its points")
    guide = UsdGeom.Imageable(prim).ComputePurpose() in (UsdGeom.Tokens.guide, UsdGeom.Tokens.proxy)
    if (gaps_in := gaps(np.unique(moves))) and str(prim.GetPath()).startswith(GROOM):
        unread.append(f"{name}: has no samples at {', '.join(map(str, gaps_in[:8]))}, which lie between its neighbours")
    name = "guides" if str(prim.GetPath()) == LOCKS else name
    material = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0].GetPath()

    def motion(frame: float) -> NDArray[np.float64]:
        with reading_more(source.path):
            points = points_at(source, prim, Usd.TimeCode(float(frame)))
        if points.shape != curves.points.shape:
            raise UserError(
                f"{source.where(prim)}: has {len(points)} points at frame {frame:g}, {len(curves.points)} "
                "at rest; export it with one topology"
            )
        return points

    bsdf = None if material.isEmpty else UsdShade.Shader(source.stage.GetPrimAtPath(material.AppendChild("bsdf")))
    bound = OWN_MATERIAL if bsdf and bsdf.GetIdAttr().Get() == HAIR_BSDF else str(material)
    return CurveSet(name, curves, guide, motion if moves else None, bound).apart()


def _posed_at(source: Source, prim: Usd.Prim) -> list[float]:
    """Time codes of the poses of curves that are not their rest pose: those of motion, or one sample over a default."""
    if samples := motion_samples(source, prim):
        return samples
    points = UsdGeom.BasisCurves(prim).GetPointsAttr()
    times = points.GetTimeSamples()
    return times if times and points.Get(Usd.TimeCode.Default()) is not None else []


def _made_on_demand(source: Source) -> Iterator[CurveSet]:
    """The hairs of a stage that are made on demand, a set for each groom; those of a frame are made once for all."""
    if not on_demand_prims(source):
        return
    made = OnDemand(source)
    rest, points = made.points(None), lru_cache(maxsize=1)(made.points)
    for name, curves, rows in made.sets():
        motion = (lambda frame, rows=rows: points(frame)[rows]) if len(made.frames) else None
        yield CurveSet(name, replace(curves, points=rest[rows]).check(f"{source.path} {name}"), motion=motion)


def _body(source: Source, prim: Usd.Prim, frames: NDArray) -> tuple[Mesh, Clip | None]:
    mesh = mesh_at(source, prim)
    mesh.name = prim.GetName()
    if not len(frames) or not motion_samples(source, prim):
        return mesh, None
    return mesh, clip_over(source, prim, frames, source.space.fps)


def unwritten_in_usd(scene: HairScene) -> Iterator[str]:
    """A sentence for each thing that ``write_usd_scene`` leaves out."""
    if foreign := sorted({one.material for one in scene.sets} - {"", OWN_MATERIAL}):
        yield f"hairs get Ringlet's material, of their pigments: without {', '.join(foreign)}"
    made = {*COMMON} - {*PLAIN, "rest"}  # anew, for whole curves
    if names := sorted({name for one in scene.sets for name in one.curves.point} & made):
        yield f"ids and groups are those of whole curves: without {', '.join(names)} of points"
    if maps := sorted({name for mesh, _ in scene.bodies for name in (*mesh.maps, *mesh.vectors)}):
        yield f"surfaces are written without painted maps: without {', '.join(maps)}"


def write_usd_scene(scene: HairScene, path: Path, space: StageSpace) -> None:
    """Writes curves and surfaces below ``/groom``, in metres and axes of ``space`` and at the rate of the scene."""
    with writing(path) as aside:
        stage = new_stage(aside, replace(space, fps=scene.space.fps))
        root = UsdGeom.Xform.Define(stage, GROOM).GetPrim()
        if len(scene.frames):
            stage.SetStartTimeCode(float(scene.frames[0]))
            stage.SetEndTimeCode(float(scene.frames[-1]))
        taken = list[str]()
        for one, ids in zip(scene.sets, scene.groom_ids, strict=True):
            taken.append(identifier(one.name, taken))
            _define_set(stage, f"{GROOM}/{taken[-1]}", one, ids, scene.frames, space, path)
        for mesh, clip in scene.bodies:
            taken.append(identifier(mesh.name.split("/")[-1].split(" ")[-1], taken))
            _define_body(stage, f"{GROOM}/{taken[-1]}", mesh, clip, space, path)
        make_model(root)
        set_extents_hint(root, scene.frames.tolist())
        stage.Save()


def _define_set(
    stage: Usd.Stage, path: str, one: CurveSet, ids: NDArray[np.int32], frames: NDArray, space: StageSpace, file: Path
) -> None:
    kept, curves = dict[str, tuple[str, NDArray]](), one.curves
    for interpolation, attributes in (("uniform", curves.curve), ("vertex", curves.point)):
        kept |= {name: (interpolation, values) for name, values in attributes.items() if name in PLAIN}
    own = {*COMMON, *PLAIN}
    curve, point = ({n: v for n, v in kind.items() if n not in own} for kind in (curves.curve, curves.point))
    plain = Curves(curves.points, curves.offsets, curves.ids, curve, point)
    defined = define_curves(stage, path, plain, space, guide=one.guide)
    prim = defined.GetPrim()
    set_primvar(prim, "groom_id", "uniform", ids)
    set_primvar(prim, "groom_group_id", "uniform", one.group_ids)
    if "st" in kept and "groom_root_uv" not in kept:
        kept["groom_root_uv"] = kept["st"]
    for name, (interpolation, values) in kept.items():
        values = values.astype(np.int32 if values.dtype.kind in "iu" else np.float32)
        set_primvar(prim, name, interpolation, values, PLAIN[name])
    if not one.guide:
        bind_hair_material(prim, plain)
    place = Place(prim, space, file, plain)
    set_rest(defined, set_points(defined, curves.points, place, DEFAULT))
    velocities = Velocities(defined, stage.GetTimeCodesPerSecond())
    for frame in frames.tolist() if one.motion else ():
        velocities.add(frame, np.array(set_points(defined, one.points(frame), place, Usd.TimeCode(frame))))
    velocities.finish()


def _define_body(stage: Usd.Stage, path: str, mesh: Mesh, clip: Clip | None, space: StageSpace, file: Path) -> None:
    defined = UsdGeom.Mesh(define_mesh(stage, path, mesh, space, file))
    if clip is None:
        return
    place = Place(defined.GetPrim(), space, file)
    for frame, points in zip(clip.frames, clip.points, strict=True):
        value, time = place.local(points, Usd.TimeCode(float(frame))), Usd.TimeCode(float(frame))
        defined.GetPointsAttr().Set(value, time)
        defined.GetExtentAttr().Set(UsdGeom.PointBased.ComputeExtent(value), time)
