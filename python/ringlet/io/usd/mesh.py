"""Reads meshes and their animation from USD; writes meshes."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom, UsdSkel, Vt

from ringlet.data.errors import UserError
from ringlet.data.mesh import Clip, Mesh
from ringlet.data.stage import StageSpace
from ringlet.io.polygons import check_polygons, triangulate
from ringlet.io.space import check_points, from_metres, to_metres
from ringlet.io.usd.stage import Source, choose, find_prim, prims, reading
from ringlet.io.usd.values import (
    Types,
    float3,
    float_primvars,
    local_to_world,
    motion,
    read_integers,
    read_points,
    rest_time,
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


def read_usd_clip(path: Path | str, prim: str | None = None, frames: tuple[float, float] | None = None) -> Clip:
    """Reads the positions of a mesh at all whole frames [m]."""
    with reading(path) as source:
        return clip_at(source, select_mesh(source, prim), frames)


def read_bodies(path: Path | str, prim: str | None = None) -> list[Body]:
    """Reads meshes with their clips.

    prim: reads the meshes at and below this prim; by default the visible ones under the default prim, or else the root
    """
    with reading(path) as source:
        meshes = visible_meshes(source) if prim is None else meshes_below(source, prim)
        return [_body_at(source, mesh) for mesh in meshes]


def read_surfaces(path: Path | str) -> list[tuple[NDArray[np.float64], NDArray[np.int32]]]:
    """Reads all visible meshes in their rest pose: points [m], shape (n, 3), and triangles, shape (m, 3)."""
    with reading(path) as source:
        meshes = [mesh_at(source, prim) for prim in visible_meshes(source)]
        return [(mesh.points, mesh.triangles) for mesh in meshes]


def read_body(path: Path | str, prim: str | None = None) -> Body:
    """Reads a mesh with its clip: the mesh at ``prim``, or the only one at or below it."""
    with reading(path) as source:
        return _body_at(source, select_mesh(source, prim))


def _body_at(source: Source, prim: Usd.Prim) -> Body:
    return Body(mesh_at(source, prim), clip_at(source, prim), str(prim.GetPath()))


def select_mesh(source: Source, name: str | None) -> Usd.Prim:
    """The mesh prim at a path, or the only one at or below it; raises UserError for none or several."""
    _bake_skinning(source.stage)
    root = source.stage.GetPseudoRoot() if name is None else find_prim(source, name)
    meshes = [prim for prim in prims(root) if UsdGeom.Mesh(prim)]
    scalps = [prim for prim in meshes if SCALP in _subsets(prim)]
    return choose(source, scalps if len(scalps) == 1 else meshes, "Mesh")


def meshes_below(source: Source, name: str) -> list[Usd.Prim]:
    """Mesh prims at and below a path; raises UserError when there is none."""
    _bake_skinning(source.stage)
    meshes = [prim for prim in prims(find_prim(source, name)) if UsdGeom.Mesh(prim)]
    if not meshes:
        raise UserError(f"{source.path}: there is no Mesh at or below {name}; name one, or a prim above one")
    return meshes


def visible_meshes(source: Source) -> list[Usd.Prim]:
    """Meshes that are visible in a render, under the default prim."""
    _bake_skinning(source.stage)
    root = source.stage.GetDefaultPrim() or source.stage.GetPseudoRoot()
    shown = (UsdGeom.Tokens.default_, UsdGeom.Tokens.render)
    return [
        prim
        for prim in prims(root)
        if UsdGeom.Mesh(prim)
        and UsdGeom.Imageable(prim).ComputePurpose() in shown
        and UsdGeom.Imageable(prim).ComputeVisibility(Usd.TimeCode.EarliestTime()) != UsdGeom.Tokens.invisible
    ]


def mesh_at(source: Source, prim: Usd.Prim) -> Mesh:
    """Mesh of a prim in its rest pose [m]; raises UserError for a mesh without faces or with invalid indices."""
    where, time, mesh = source.where(prim), rest_time(prim), UsdGeom.Mesh(prim)
    points = read_points(prim, time, where)
    counts = read_integers(mesh.GetFaceVertexCountsAttr(), time, where)
    indices = read_integers(mesh.GetFaceVertexIndicesAttr(), time, where)
    check_polygons(counts, indices, len(points), where)

    # A mirroring transform reverses the winding, like leftHanded.
    mirrored = np.linalg.det(local_to_world(prim, time)[:3, :3]) < 0
    left_handed = mesh.GetOrientationAttr().Get(time) == UsdGeom.Tokens.leftHanded
    corners, faces = triangulate(points, counts, indices, clockwise=bool(mirrored) != left_handed)
    visible = ~np.isin(faces, read_integers(mesh.GetHoleIndicesAttr(), time, where))
    corners, faces = corners[visible], faces[visible]
    if len(faces) == 0:
        raise UserError(f"{where}: has no faces; export it again or choose another mesh")

    triangles = indices[corners]
    return Mesh(
        name=f"{source.path.name} {prim.GetPath()}",
        points=to_metres(transformed(points, prim, time), source.space),
        triangles=triangles.astype(np.int32),
        uv=_uv(prim, corners, triangles, len(points), len(indices), where),
        faces=faces.astype(np.int32),
        regions=_regions(prim, faces, len(counts), where),
        maps=_maps(float_primvars(prim), corners, triangles, faces, len(counts), where),
        vectors=_vectors(prim, time, source, corners, triangles, faces, len(counts), where),
        **_color(prim, counts, indices, len(points)),
    )


def clip_at(source: Source, prim: Usd.Prim, frames: tuple[float, float] | None = None) -> Clip:
    """Positions of a mesh prim at all whole frames of the stage, or of the closed range ``frames``.

    Raises UserError for too much data and for a number of points that changes.
    """
    where, times = source.where(prim), _frames(source, prim, frames)
    if len(times) == 0:
        start, always = source.stage.GetStartTimeCode(), Usd.TimeCode.EarliestTime()  # one sample for all times
        points = to_metres(transformed(read_points(prim, always, where), prim, always), source.space)
        return Clip(np.array([start]), points[None], source.space.fps)
    samples = []
    for frame in times:
        time = Usd.TimeCode(frame)
        at = f"{where} at frame {frame:g}"
        points = to_metres(transformed(read_points(prim, time, at), prim, time), source.space)
        check_points(points, at)  # a transform may be NaN, too
        if len(points) * len(times) > MAX_POSITIONS:
            raise UserError(
                f"{where}: has {len(points):,} points at {len(times):,} frames, more than {MAX_POSITIONS:,} places; "
                "shorten its range, or leave it out"
            )
        if samples and len(points) != len(samples[0]):
            raise UserError(
                f"{where}: has {len(points)} points at frame {frame:g}, {len(samples[0])} before; must not change"
            )
        samples.append(points)
    return Clip(times, np.stack(samples), source.space.fps)


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
    for name, triangles in mesh.regions.items():
        UsdGeom.Subset.CreateGeomSubset(
            defined, name, UsdGeom.Tokens.face, Vt.IntArray.FromNumpy(triangles.astype(np.int32))
        )
    return prim


def _bake_skinning(stage: Usd.Stage) -> None:
    """Bakes skinning to points and transforms in the session layer, which is never saved."""
    if any(UsdSkel.Root(prim) for prim in stage.Traverse()):
        stage.SetEditTarget(stage.GetSessionLayer())
        UsdSkel.BakeSkinning(Usd.PrimRange(stage.GetPseudoRoot()))


def _uv(prim: Usd.Prim, corners: NDArray, triangles: NDArray, points: int, indices: int, where: str) -> NDArray | None:
    """Texture coordinates per triangle corner, shape (m, 3, 2): of ``st``, or of the first suitable primvar.

    Raises UserError for values that do not fit the mesh.
    """
    api = UsdGeom.PrimvarsAPI(prim)
    named = [api.FindPrimvarWithInheritance(name) for name in ("st", "uv", "UVMap", "map1")]
    typed = [
        primvar for primvar in api.GetPrimvarsWithAuthoredValues() if primvar.GetTypeName() == Types.TexCoord2fArray
    ]
    for primvar in (p for p in (*named, *typed) if p and p.HasAuthoredValue()):
        values = np.array(primvar.Get(Usd.TimeCode.EarliestTime()), np.float64)
        if primvar.IsIndexed():
            rows = np.array(primvar.GetIndices(Usd.TimeCode.EarliestTime()))
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
        for name, interpolation, values in vector_primvars(prim)
    )
    return _maps(rotated, corners, triangles, faces, polygons, where)


def _subsets(prim: Usd.Prim) -> dict[str, UsdGeom.Subset]:
    found = UsdGeom.Subset.GetAllGeomSubsets(UsdGeom.Imageable(prim))
    return {s.GetPrim().GetName(): s for s in found if s.GetElementTypeAttr().Get() == UsdGeom.Tokens.face}


def _regions(prim: Usd.Prim, faces: NDArray, count: int, where: str) -> dict[str, NDArray[np.int32]]:
    """Face subsets as sets of triangles, by name; raises UserError for a face out of range."""
    regions = {}
    for name, subset in _subsets(prim).items():
        chosen = read_integers(subset.GetIndicesAttr(), Usd.TimeCode.EarliestTime(), f"{where}/{name}")
        if (bad := np.flatnonzero((chosen < 0) | (chosen >= count))).size:
            raise UserError(f"{where}/{name}: names face {chosen[bad[0]]}; must be from 0 to {count - 1}")
        inside = np.zeros(count, bool)
        inside[chosen] = True
        regions[name] = np.flatnonzero(inside[faces]).astype(np.int32)
    return regions


def _color(prim: Usd.Prim, counts: NDArray, indices: NDArray, points: int) -> dict[str, Any]:
    """Display colour of the mesh and, if it varies, of each vertex: the mean of the vertex's corners."""
    primvar = UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance("displayColor")
    values = primvar.ComputeFlattened(Usd.TimeCode.EarliestTime()) if primvar else None
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
    samples = [
        time for attribute in motion(prim) if attribute.GetNumTimeSamples() > 1 for time in attribute.GetTimeSamples()
    ]
    if not samples:
        return np.empty(0)
    stage = source.stage
    if frames is None and stage.HasAuthoredTimeCodeRange():
        frames = stage.GetStartTimeCode(), stage.GetEndTimeCode()
    first, last = frames or (min(samples), max(samples))
    return whole_frames(first, last, source.where(prim))
