"""Writes archives: curves with Unreal's groom attributes, and surfaces."""

from __future__ import annotations

import mmap
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.files import replacing
from ringlet.data.hair_scene import CurveSet, HairScene
from ringlet.data.mesh import Clip, Mesh
from ringlet.data.names import unique
from ringlet.data.stage import StageSpace
from ringlet.io.alembic.library import SHAPE, library
from ringlet.io.space import from_metres
from ringlet.io.unreal import TOOL, VERSION, curve_attributes

# Attributes that have a property of their own in the schema of curves, or that the writer makes.
SCHEMA = {"width", "rest"}
DATE, NO_DATE = b"_ai_DateWritten=", b"Thu Jan  1 00:00:00 1970"  # of the same length as any other


def write_alembic(scene: HairScene, path: Path, space: StageSpace) -> None:
    """Writes curves with Unreal's groom attributes, and surfaces; the same scene makes the same bytes.

    space: unit and up-axis to write in; Unreal expects centimetres and Y up
    """
    modules = library(path)
    with replacing(path) as aside:
        _write(modules, scene, aside, space)  # the archive is closed when its objects are gone
        _forget_date(aside)


def _forget_date(path: Path) -> None:
    """Replaces the date that the library writes near the end of an archive."""
    with path.open("r+b") as file, mmap.mmap(file.fileno(), 0) as content:
        if (place := content.rfind(DATE)) >= 0:
            content.seek(place + len(DATE))
            content.write(NO_DATE)


def _write(modules: SimpleNamespace, scene: HairScene, path: Path, space: StageSpace) -> None:
    abc, geom, fps = modules.abc, modules.geom, scene.space.fps
    archive = abc.CreateArchiveWithInfo(str(path), fps, "Ringlet", "")
    times = archive.addTimeSampling(_sampling(modules, scene.frames / fps, 1.0 / fps))
    root = geom.OXform(archive.getTop(), "groom")
    properties = root.getSchema().getUserProperties()
    for name, value in zip(("major", "minor"), VERSION, strict=True):
        abc.OInt16Property(properties, f"groom_version_{name}").setValue(value)
    abc.OStringProperty(properties, "groom_tool").setValue(TOOL)
    taken = list[str]()
    for one, attributes in zip(scene.sets, curve_attributes(scene), strict=True):
        taken.append(unique(_last_word(one.name), taken))
        held = [(name, values, scope) for name, values, scope in attributes if name not in SCHEMA and holds(values)]
        _write_curves(modules, root, taken[-1], (one, held), scene.frames, times, space)
    for mesh, clip in scene.bodies:
        taken.append(unique(_last_word(mesh.name), taken))
        _write_body(modules, root, taken[-1], (mesh, clip), scene.frames, times, space)


def _sampling(modules: SimpleNamespace, seconds: NDArray[np.float64], cycle: float) -> Any:
    """Times of samples: even ones by their distance, which is ``cycle`` for a single one, others one by one."""
    core, steps = modules.core, np.diff(seconds)
    if len(steps) and not np.allclose(steps, steps[0], rtol=1e-6):
        times = core.TimeVector()
        times.extend(seconds.tolist())
        return core.TimeSampling(core.TimeSamplingType(core.AcyclicFlag.kAcyclic), times)
    return core.TimeSampling(*map(float, (steps.mean() if len(steps) else cycle, seconds[0] if len(seconds) else 0.0)))


def _last_word(name: str) -> str:
    """The last word of a path, without what Alembic reserves."""
    return next(reversed(name.replace("/", " ").split()), "object")


def _place(modules: SimpleNamespace, root: Any, name: str) -> tuple[Any, str]:
    """The transform of a shape, and its name: other programs show the transform as the object."""
    return modules.geom.OXform(root, name), name + SHAPE


def _write_curves(
    modules: SimpleNamespace,
    root: Any,
    name: str,
    given: tuple[CurveSet, list[tuple[str, NDArray, str]]],
    frames: NDArray,
    times: int,
    space: StageSpace,
) -> None:
    geom, imath, (one, attributes), curves = modules.geom, modules.imath, given, given[0].curves
    vertex, uniform = geom.GeometryScope.kVertexScope, geom.GeometryScope.kUniformScope
    moves = one.motion is not None and len(frames) > 0
    schema = geom.OCurves(*_place(modules, root, name), *([times] if moves else [])).getSchema()
    widths = curves.point.get("width")
    if widths is None and "width" in curves.curve:
        widths = np.repeat(curves.curve["width"], curves.counts)
    for frame in frames.tolist() if moves else [None]:
        sample = geom.OCurvesSchemaSample()
        sample.setPositions(imath.V3fArrayFromBuffer(from_metres(one.points(frame), space)))
        sample.setCurvesNumVertices(imath.IntArrayFromBuffer(curves.counts.astype(np.int32)))
        # Polylines: a Catmull-Rom curve of Alembic ends before its first and last points.
        sample.setType(geom.CurveType.kLinear)
        sample.setWrap(geom.CurvePeriodicity.kNonPeriodic)
        sample.setBasis(geom.BasisType.kNoBasis)
        if widths is not None:
            value = imath.FloatArrayFromBuffer(np.ascontiguousarray(widths / space.meters_per_unit, np.float32))
            sample.setWidths(geom.OFloatGeomParamSample(value, vertex))
        if "st" in curves.curve:
            value = imath.V2fArrayFromBuffer(np.ascontiguousarray(curves.curve["st"], np.float32))
            sample.setUVs(geom.OV2fGeomParamSample(value, uniform))
        schema.set(sample)
    parameters = schema.getArbGeomParams()
    if moves:
        _write_attribute(modules, parameters, "rest", from_metres(curves.points, space), vertex)
    for attribute, values, scope in attributes:
        _write_attribute(modules, parameters, attribute, values, vertex if scope == "vertex" else uniform)


def holds(values: NDArray) -> bool:
    """Whether an attribute can be written: numbers, alone or in rows of two or three, in 32 bits."""
    if values.dtype.kind not in "bifu" or values.shape[1:] not in ((), (2,), (3,)):
        return False
    return values.dtype.kind in "bf" or bool(np.abs(values.astype(np.float64)).max(initial=0.0) < 2.0**31)


def _write_attribute(modules: SimpleNamespace, parent: Any, name: str, values: NDArray, scope: Any) -> None:
    geom, imath = modules.geom, modules.imath
    whole = values.dtype.kind in "biu"
    kind, array = {
        (True, ()): ("Int32", imath.IntArrayFromBuffer),
        (True, (2,)): ("V2i", imath.V2iArrayFromBuffer),
        (True, (3,)): ("V3i", imath.V3iArrayFromBuffer),
        (False, ()): ("Float", imath.FloatArrayFromBuffer),
        (False, (2,)): ("V2f", imath.V2fArrayFromBuffer),
        (False, (3,)): ("V3f", imath.V3fArrayFromBuffer),
    }[whole, values.shape[1:]]
    value = array(np.ascontiguousarray(values, np.int32 if whole else np.float32))
    parameter = getattr(geom, f"O{kind}GeomParam")(parent, name, False, scope, 1)
    parameter.set(getattr(geom, f"O{kind}GeomParamSample")(value, scope))


def _write_body(
    modules: SimpleNamespace,
    root: Any,
    name: str,
    body: tuple[Mesh, Clip | None],
    frames: NDArray,
    times: int,
    space: StageSpace,
) -> None:
    geom, imath, (mesh, clip) = modules.geom, modules.imath, body
    moves = clip is not None and len(frames) > 0
    schema = geom.OPolyMesh(*_place(modules, root, name), *([times] if moves else [])).getSchema()
    counts = imath.IntArrayFromBuffer(np.full(len(mesh.triangles), 3, np.int32))
    indices = imath.IntArrayFromBuffer(np.ascontiguousarray(mesh.triangles[:, ::-1], np.int32).ravel())
    for frame in frames.tolist() if moves else [None]:
        points = mesh.points if frame is None or clip is None else clip.at(frame)
        sample = geom.OPolyMeshSchemaSample()
        sample.setPositions(imath.V3fArrayFromBuffer(from_metres(points, space)))
        sample.setFaceIndices(indices)
        sample.setFaceCounts(counts)
        if mesh.uv is not None:
            uv = np.ascontiguousarray(mesh.uv[:, ::-1].reshape(-1, 2), np.float32)
            value = geom.OV2fGeomParamSample(imath.V2fArrayFromBuffer(uv), geom.GeometryScope.kFacevaryingScope)
            sample.setUVs(value)
        schema.set(sample)
