"""Reads meshes and their animation from USD; writes meshes."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom, Vt

from ringlet.data.errors import UserError
from ringlet.data.mesh import Clip, Mesh
from ringlet.data.stage import StageSpace
from ringlet.io.polygons import check_polygons, fans
from ringlet.io.space import check_points, from_metres, to_metres
from ringlet.io.usd.instancer import instance_transforms, prototype_surfaces
from ringlet.io.usd.names import identifier, keep_name, original_name
from ringlet.io.usd.pose import motion_samples, posed_points, rest_time
from ringlet.io.usd.stage import Source, choose, find_prim, prims, reading
from ringlet.io.usd.surfaces import is_surface, passed_over, shown_surfaces
from ringlet.io.usd.values import (
    Types,
    flattened,
    float3,
    float_primvars,
    local_to_world,
    read_integers,
    read_time,
    set_primvar,
    transformed,
    vector_primvars,
)

SCALP = "scalp"
MAX_FRAMES = 100_000
MAX_POSITIONS = 2**28  # points of a mesh times frames: 6 GiB


@dataclass
class Body:
    """A mesh in its rest pose, its animation, and the path of its prim."""

    mesh: Mesh
    clip: Clip
    prim: str


def read_usd_mesh(path: Path | str, prim: str | None = None) -> Mesh:
    """Reads a mesh in its rest pose [m]."""
    with reading(path) as source:
        return mesh_at(source, select_mesh(source, prim))


def read_usd_clip(
    path: Path | str, prim: str | None = None, frames: tuple[int, int] | None = None, fps: float | None = None
) -> Clip:
    """Reads the positions of a mesh at all whole frames [m]; ``frames`` and ``fps`` as for ``shot_clip_at``."""
    with reading(path) as source:
        return shot_clip_at(source, select_mesh(source, prim), frames, fps)


def read_bodies(
    path: Path | str, prim: str | None = None, frames: tuple[int, int] | None = None, fps: float | None = None
) -> list[Body]:
    """Reads surfaces with their clips: meshes, and point instancers as one mesh of all their instances.

    prim:        reads what is at and below this prim; by default what is visible under the default prim, or else the
                 root
    frames, fps: as for ``shot_clip_at``
    """
    with reading(path) as source:
        surfaces = shown_surfaces(source) if prim is None else surfaces_below(source, prim)
        return [_body_at(source, surface, frames, fps) for surface in surfaces]


def unread_surfaces(path: Path | str, prim: str | None = None, named: Collection[str] = ()) -> list[str]:
    """A sentence for each visible prim that has a surface, but is not among those of ``read_bodies``.

    named: paths of prims that are read by name
    """
    with reading(path) as source:
        return list(passed_over(source, None if prim is None else find_prim(source, prim), named))


def read_meshes(path: Path | str) -> list[Mesh]:
    """Reads all visible surfaces in their rest pose."""
    with reading(path) as source:
        return [mesh_at(source, prim) for prim in shown_surfaces(source)]


def read_body(
    path: Path | str, prim: str | None = None, frames: tuple[int, int] | None = None, fps: float | None = None
) -> Body:
    """Reads a mesh with its clip: the mesh at ``prim``, or the only one at or below it; see ``read_bodies``."""
    with reading(path) as source:
        return _body_at(source, select_mesh(source, prim), frames, fps)


def _body_at(source: Source, prim: Usd.Prim, frames: tuple[int, int] | None, fps: float | None) -> Body:
    return Body(mesh_at(source, prim), shot_clip_at(source, prim, frames, fps), str(prim.GetPath()))


def select_mesh(source: Source, name: str | None) -> Usd.Prim:
    """The mesh prim at a path, or the only one at or below it; raises UserError for none or several."""
    root = source.stage.GetPseudoRoot() if name is None else find_prim(source, name)
    meshes = [prim for prim in prims(root) if UsdGeom.Mesh(prim)]
    scalps = [prim for prim in meshes if SCALP in _subsets(prim)]
    return choose(source, scalps if len(scalps) == 1 else meshes, "Mesh")


def surfaces_below(source: Source, name: str) -> list[Usd.Prim]:
    """Meshes and point instancers at and below a path; raises UserError when there is none."""
    surfaces = [prim for prim in prims(find_prim(source, name)) if is_surface(prim)]
    if not surfaces:
        raise UserError(f"{source.path}: there is no Mesh at or below {name}; name one, or a prim above one")
    return surfaces


def mesh_at(source: Source, prim: Usd.Prim) -> Mesh:
    """Surface of a prim in its rest pose [m]; raises UserError for one without faces or with invalid indices."""
    if UsdGeom.PointInstancer(prim):
        return _instanced_mesh(source, prim)
    where, time, mesh = source.where(prim), rest_time(source, prim), UsdGeom.Mesh(prim)
    points = posed_points(source, prim, time, where)
    counts = read_integers(mesh.GetFaceVertexCountsAttr(), time, where)
    indices = read_integers(mesh.GetFaceVertexIndicesAttr(), time, where)
    check_polygons(counts, indices, len(points), where)

    # A mirroring transform reverses the winding, like leftHanded.
    mirrored = np.linalg.det(local_to_world(prim, time)[:3, :3]) < 0
    left_handed = mesh.GetOrientationAttr().Get(time) == UsdGeom.Tokens.leftHanded
    corners, faces = fans(counts, clockwise=bool(mirrored) != left_handed)
    visible = ~np.isin(faces, read_integers(mesh.GetHoleIndicesAttr(), time, where))
    corners, faces = corners[visible], faces[visible]
    if len(faces) == 0:
        raise UserError(f"{where}: has no faces; export it again or choose another mesh")

    triangles = indices[corners]
    return Mesh(
        name=f"{source.path.name} {prim.GetPath()}",
        points=points,
        triangles=triangles.astype(np.int32),
        uv=_uv(prim, time, corners, triangles, len(points), len(indices), where),
        faces=faces.astype(np.int32),
        regions=_regions(prim, time, faces, len(counts), where),
        maps=_maps(float_primvars(prim, time), corners, triangles, faces, len(counts), where),
        vectors=_vectors(prim, time, source, corners, triangles, faces, len(counts), where),
        **_color(prim, time, counts, indices, len(points)),
    )


def _instanced_mesh(source: Source, prim: Usd.Prim) -> Mesh:
    """One mesh of all instances of a point instancer, in the order of their points."""
    where, time = source.where(prim), rest_time(source, prim)
    prototypes = [[mesh_at(source, surface) for surface in surfaces] for surfaces in prototype_surfaces(prim)]
    triangles, start = list[NDArray[np.int32]](), 0
    for k, matrix in instance_transforms(prim, time):
        turn = 1 if np.linalg.det(matrix[:3, :3]) > 0 else -1  # a mirrored instance has its winding reversed
        for mesh in prototypes[k]:
            triangles.append(start + mesh.triangles[:, ::turn])
            start += len(mesh.points)
    if not triangles:
        raise UserError(f"{where}: has no instances of meshes; make it invisible, or leave it out")
    points = posed_points(source, prim, time, where)
    color = next(mesh.color for meshes in prototypes for mesh in meshes)
    return Mesh(f"{source.path.name} {prim.GetPath()}", points, np.concatenate(triangles).astype(np.int32), color=color)


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
    where, rate = source.where(prim), source.space.fps if fps is None else fps
    times = _frames(source, prim, frames)
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


def whole_frames(first: float, last: float, where: str) -> NDArray[np.float64]:
    """Whole frames of a closed range, shape (k,); raises UserError for none or too many."""
    if not abs(last - first) < MAX_FRAMES:  # also true for NaN
        raise UserError(f"{where}: moves from {first:g} to {last:g}; must be fewer than {MAX_FRAMES:,} frames")
    frames = np.arange(math.ceil(first), math.floor(last) + 1, dtype=np.float64)
    if len(frames) == 0:
        raise UserError(f"{where}: there is no whole frame from {first:g} to {last:g}; give a longer range")
    return frames


def define_mesh(stage: Usd.Stage, path: str, mesh: Mesh, space: StageSpace) -> Usd.Prim:
    """Writes a mesh with its regions at a prim path."""
    defined = UsdGeom.Mesh.Define(stage, path)
    prim, points = defined.GetPrim(), float3(from_metres(mesh.points, space))
    defined.CreatePointsAttr(points)
    defined.CreateExtentAttr(UsdGeom.PointBased.ComputeExtent(points))
    defined.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(len(mesh.triangles), 3, np.int32)))
    defined.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(mesh.triangles.astype(np.int32).ravel()))
    defined.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    varies = mesh.colors is not None
    colors = np.array(mesh.colors if varies else [mesh.color], np.float32)
    set_primvar(prim, "displayColor", "vertex" if varies else "constant", colors, Types.Color3fArray)
    if mesh.uv is not None:
        set_primvar(prim, "st", "faceVarying", mesh.uv.reshape(-1, 2).astype(np.float32), Types.TexCoord2fArray)
    taken: list[str] = []
    for name, triangles in mesh.regions.items():
        taken.append(identifier(name, taken))
        indices = Vt.IntArray.FromNumpy(triangles.astype(np.int32))
        subset = UsdGeom.Subset.CreateGeomSubset(defined, taken[-1], UsdGeom.Tokens.face, indices)
        if taken[-1] != name:
            keep_name(subset.GetPrim(), name)
    return prim


def _uv(
    prim: Usd.Prim, time: Usd.TimeCode, corners: NDArray, triangles: NDArray, points: int, indices: int, where: str
) -> NDArray | None:
    """Texture coordinates per triangle corner, shape (m, 3, 2): of ``st``, or of the first suitable primvar.

    Raises UserError for values that do not fit the mesh.
    """
    api = UsdGeom.PrimvarsAPI(prim)
    named = [api.FindPrimvarWithInheritance(name) for name in ("st", "uv", "UVMap", "map1")]
    typed = [
        primvar for primvar in api.GetPrimvarsWithAuthoredValues() if primvar.GetTypeName() == Types.TexCoord2fArray
    ]
    for primvar in (p for p in (*named, *typed) if p and p.HasAuthoredValue()):
        at = read_time(time, primvar.GetAttr(), primvar.GetIndicesAttr())
        values = np.array(primvar.Get(at), np.float64)
        if primvar.IsIndexed():
            rows = np.array(primvar.GetIndices(at))
            if ((rows < 0) | (rows >= len(values))).any():
                raise UserError(f"{where}: {primvar.GetName()} has an index that is not from 0 to {len(values) - 1}")
            values = values[rows]
        faceted = primvar.GetInterpolation() == UsdGeom.Tokens.faceVarying
        if not faceted and primvar.GetInterpolation() not in (UsdGeom.Tokens.vertex, UsdGeom.Tokens.varying):
            continue
        if values.shape != (indices if faceted else points, 2):
            expected = f"{indices} corners" if faceted else f"{points} points"
            raise UserError(
                f"{where}: {primvar.GetName()} has {len(values)} values for {expected}; must have one for each"
            )
        if not np.isfinite(values).all():
            raise UserError(f"{where}: {primvar.GetName()} has a value that is no number; must be finite")
        return values[corners if faceted else triangles]
    return None


def _maps(
    primvars: Iterable[tuple[str, str, NDArray]],
    corners: NDArray,
    triangles: NDArray,
    faces: NDArray,
    polygons: int,
    where: str,
) -> dict[str, NDArray[np.float64]]:
    """Primvars at the corners of each triangle, by name; raises UserError for too few values."""
    maps = {}
    for name, interpolation, values in primvars:
        rows = {
            UsdGeom.Tokens.constant: np.zeros_like(corners),
            UsdGeom.Tokens.uniform: np.repeat(faces[:, None], 3, axis=1),
            UsdGeom.Tokens.faceVarying: corners,
        }.get(interpolation, triangles)
        if len(values) <= rows.max(initial=-1) or (interpolation == UsdGeom.Tokens.uniform and len(values) != polygons):
            raise UserError(
                f"{where}: {name} has {len(values)} values, too few for being {interpolation}; paint it again"
            )
        maps[name] = values[rows]
    return maps


def _vectors(
    prim: Usd.Prim,
    time: Usd.TimeCode,
    source: Source,
    corners: NDArray,
    triangles: NDArray,
    faces: NDArray,
    polygons: int,
    where: str,
) -> dict[str, NDArray[np.float64]]:
    """Primvars of directions at the corners of each triangle, transformed with the points, by name."""
    upright = StageSpace(1.0, source.space.up_axis)
    origin = transformed(np.zeros((1, 3)), prim, time)
    rotated = (
        (name, interpolation, to_metres(transformed(values, prim, time) - origin, upright))
        for name, interpolation, values in vector_primvars(prim, time)
    )
    return _maps(rotated, corners, triangles, faces, polygons, where)


def _subsets(prim: Usd.Prim) -> dict[str, UsdGeom.Subset]:
    found = UsdGeom.Subset.GetAllGeomSubsets(UsdGeom.Imageable(prim))
    faces = [s for s in found if s.GetElementTypeAttr().Get() == UsdGeom.Tokens.face]
    return {original_name(s.GetPrim(), s.GetPrim().GetName()): s for s in faces}


def _regions(
    prim: Usd.Prim, time: Usd.TimeCode, faces: NDArray, count: int, where: str
) -> dict[str, NDArray[np.int32]]:
    """Face subsets as sets of triangles, by name; raises UserError for a face out of range."""
    regions = {}
    for name, subset in _subsets(prim).items():
        chosen = read_integers(subset.GetIndicesAttr(), time, f"{where}/{name}")
        if (bad := np.flatnonzero((chosen < 0) | (chosen >= count))).size:
            raise UserError(f"{where}/{name}: names face {chosen[bad[0]]}; must be from 0 to {count - 1}")
        inside = np.zeros(count, bool)
        inside[chosen] = True
        regions[name] = np.flatnonzero(inside[faces]).astype(np.int32)
    return regions


def _color(prim: Usd.Prim, time: Usd.TimeCode, counts: NDArray, indices: NDArray, points: int) -> dict[str, Any]:
    """Display colour of the mesh and, if it varies, of each vertex: the mean of the vertex's corners."""
    primvar = UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance("displayColor")
    values = flattened(primvar, time) if primvar else None
    colors = np.array(values if values is not None else [], np.float64).reshape(-1, 3)
    if len(colors) == 0 or not np.isfinite(colors).all():
        return {}
    color = dict(color=tuple(map(float, colors.mean(axis=0))))
    interpolation = primvar.GetInterpolation()
    if interpolation == UsdGeom.Tokens.uniform and len(colors) == len(counts):
        corners = np.repeat(colors, counts, axis=0)
    elif interpolation == UsdGeom.Tokens.faceVarying and len(colors) == len(indices):
        corners = colors
    elif interpolation in (UsdGeom.Tokens.vertex, UsdGeom.Tokens.varying) and len(colors) == points:
        return {**color, "colors": colors}
    else:
        return color
    sums = np.stack([np.bincount(indices, channel, points) for channel in corners.T], axis=1)
    return {**color, "colors": sums / np.maximum(np.bincount(indices, minlength=points), 1)[:, None]}


def _frames(source: Source, prim: Usd.Prim, frames: tuple[float, float] | None) -> NDArray[np.float64]:
    """Whole frames to read; empty for a static mesh."""
    samples = motion_samples(source, prim)
    if not samples:
        return np.empty(0)
    samples = [time for time in samples if math.isfinite(time)]
    start, end = source.stage.GetStartTimeCode(), source.stage.GetEndTimeCode()
    if frames is None and source.stage.HasAuthoredTimeCodeRange() and 0 <= end - start < MAX_FRAMES:
        frames = start, end
    first, last = frames or (min(samples), max(samples))
    return whole_frames(first, last, source.where(prim))
