"""Reads meshes, with their animation and attributes, from USD; writes meshes."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom, Vt

from ringlet.data.attributes import check_attribute
from ringlet.data.errors import UserError
from ringlet.data.mesh import Clip, Mesh
from ringlet.data.stage import StageSpace
from ringlet.io.space import to_metres
from ringlet.io.usd.clips import shot_clip_at
from ringlet.io.usd.instancer import instance_transforms, prototype_surfaces
from ringlet.io.usd.names import identifier, keep_name, original_name
from ringlet.io.usd.place import Place
from ringlet.io.usd.pose import posed_points, rest_time
from ringlet.io.usd.refinement import unrefined
from ringlet.io.usd.stage import Source, choose, find_prim, prims, reading
from ringlet.io.usd.surfaces import filled, is_surface, passed_over, shown_surfaces
from ringlet.io.usd.triangles import Triangles
from ringlet.io.usd.values import (
    Types,
    flattened,
    float_primvars,
    read_integers,
    read_time,
    set_primvar,
    transformed,
    triples,
    vector_primvars,
)

SCALP = "scalp"


@dataclass
class Body:
    """A mesh in its rest pose, its animation, and the path of its prim."""

    mesh: Mesh
    clip: Clip
    prim: str


def read_usd_mesh(
    path: Path | str, prim: str | None = None, cage: bool | None = None, notes: list[str] | None = None
) -> Mesh:
    """Reads a mesh in its rest pose [m].

    cage:  as for ``reading``
    notes: receives a sentence for what is not read as a render shows it
    """
    with reading(path, cage) as source:
        return _noted_mesh(source, select_mesh(source, prim), notes)


def read_usd_head(
    path: Path | str, prim: str | None = None, cage: bool | None = None, notes: list[str] | None = None
) -> tuple[Mesh, list[Mesh], StageSpace]:
    """Reads a mesh, the other visible surfaces of its file in their rest pose [m], and the space of the file.

    cage, notes: as for ``read_usd_mesh``
    """
    with reading(path, cage) as source:
        chosen = select_mesh(source, prim)
        mesh = _noted_mesh(source, chosen, notes)
        others = [mesh_at(source, surface) for surface in shown_surfaces(source) if surface != chosen]
        return mesh, others, source.space


def _noted_mesh(source: Source, prim: Usd.Prim, notes: list[str] | None) -> Mesh:
    if notes is not None and (note := unrefined(source, prim)):
        notes.append(note)
    return mesh_at(source, prim)


def read_usd_clip(
    path: Path | str,
    prim: str | None = None,
    frames: tuple[int, int] | None = None,
    fps: float | None = None,
    cage: bool | None = None,
) -> Clip:
    """Reads the positions of a mesh at all whole frames [m].

    frames, fps: as for ``shot_clip_at``
    cage:        as for ``reading``
    """
    with reading(path, cage) as source:
        return shot_clip_at(source, select_mesh(source, prim), frames, fps)


def read_bodies(
    path: Path | str,
    prim: str | None = None,
    frames: tuple[int, int] | None = None,
    fps: float | None = None,
    cage: bool | None = None,
) -> list[Body]:
    """Reads surfaces with their clips: meshes, and point instancers as one mesh of all their instances.

    prim:        reads what is at and below this prim; by default what is visible under the default prim, or else the
                 root
    frames, fps: as for ``shot_clip_at``
    cage:        as for ``reading``
    """
    with reading(path, cage) as source:
        surfaces = shown_surfaces(source) if prim is None else surfaces_below(source, prim)
        return [_body_at(source, surface, frames, fps) for surface in surfaces]


def unread_surfaces(path: Path | str, prim: str | None = None, named: Collection[str] = ()) -> list[str]:
    """A sentence for each visible prim that has a surface, but is not among those of ``read_bodies``.

    named: paths of prims that are read by name
    """
    with reading(path) as source:
        return list(passed_over(source, None if prim is None else find_prim(source, prim), named))


def read_meshes(path: Path | str, cage: bool | None = None) -> list[Mesh]:
    """Reads all visible surfaces in their rest pose; ``cage`` as for ``reading``."""
    with reading(path, cage) as source:
        return [mesh_at(source, prim) for prim in shown_surfaces(source)]


def read_body(
    path: Path | str,
    prim: str | None = None,
    frames: tuple[int, int] | None = None,
    fps: float | None = None,
    cage: bool | None = None,
) -> Body:
    """Reads a mesh with its clip: the mesh at ``prim``, or the only one at or below it; see ``read_bodies``."""
    with reading(path, cage) as source:
        return _body_at(source, select_mesh(source, prim), frames, fps)


def _body_at(source: Source, prim: Usd.Prim, frames: tuple[int, int] | None, fps: float | None) -> Body:
    return Body(mesh_at(source, prim), shot_clip_at(source, prim, frames, fps), str(prim.GetPath()))


def select_mesh(source: Source, name: str | None) -> Usd.Prim:
    """The mesh prim at a path, or the only one at or below it; raises UserError for none or several."""
    root = source.stage.GetPseudoRoot() if name is None else find_prim(source, name)
    meshes = filled(prim for prim in prims(root) if UsdGeom.Mesh(prim))
    scalps = [prim for prim in meshes if SCALP in _subsets(prim)]
    return choose(source, scalps if len(scalps) == 1 else meshes, "Mesh")


def surface_paths(path: Path | str, names: Sequence[str], what: str) -> list[str]:
    """Paths of the meshes at and below prims; raises UserError, which begins with ``what``, for a prim without any."""
    with reading(path) as source:
        try:
            return [str(prim.GetPath()) for name in names for prim in surfaces_below(source, name)]
        except UserError as error:
            raise UserError(f"{what}: {error}") from error


def surfaces_below(source: Source, name: str) -> list[Usd.Prim]:
    """Meshes and point instancers at and below a path; raises UserError when there is none."""
    surfaces = filled(prim for prim in prims(find_prim(source, name)) if is_surface(prim))
    if not surfaces:
        raise UserError(f"{source.path}: there is no Mesh at or below {name}; name one, or a prim above one")
    return surfaces


def mesh_at(source: Source, prim: Usd.Prim) -> Mesh:
    """Surface of a prim in its rest pose [m]; raises UserError for one without faces or with invalid indices."""
    if UsdGeom.PointInstancer(prim):
        return _instanced_mesh(source, prim)
    where, time = source.where(prim), rest_time(source, prim)
    points = posed_points(source, prim, time, where)
    surface = Triangles(source, prim, time)
    return Mesh(
        name=f"{source.path.name} {prim.GetPath()}",
        points=points,
        triangles=surface.triangles.astype(np.int32),
        uv=_uv(prim, time, surface),
        faces=surface.faces.astype(np.int32),
        places=surface.places,
        regions=_regions(prim, time, surface),
        maps=_maps(float_primvars(prim, time), surface),
        vectors=_vectors(prim, time, source, surface),
        **_color(prim, time, surface),
    )


def _instanced_mesh(source: Source, prim: Usd.Prim) -> Mesh:
    """One mesh of all instances of a point instancer, in the order of their points."""
    where, time = source.where(prim), rest_time(source, prim)
    prototypes = [[mesh_at(source, surface) for surface in surfaces] for surfaces in prototype_surfaces(prim)]
    triangles, start = list[NDArray[np.int32]](), 0
    for k, matrix in instance_transforms(prim, time):
        with np.errstate(all="ignore"):  # points under a transform that is no number are refused
            turn = 1 if np.linalg.det(matrix[:3, :3]) > 0 else -1  # a mirrored instance has its winding reversed
        for mesh in prototypes[k]:
            triangles.append(start + mesh.triangles[:, ::turn])
            start += len(mesh.points)
    if not triangles:
        raise UserError(f"{where}: has no instances of meshes; make it invisible, or leave it out")
    points = posed_points(source, prim, time, where)
    color = next(mesh.color for meshes in prototypes for mesh in meshes)
    return Mesh(f"{source.path.name} {prim.GetPath()}", points, np.concatenate(triangles).astype(np.int32), color=color)


def define_mesh(stage: Usd.Stage, path: str, mesh: Mesh, space: StageSpace, file: Path | str) -> Usd.Prim:
    """Writes a mesh with its regions at a prim path; ``file`` is for messages."""
    defined = UsdGeom.Mesh.Define(stage, path)
    prim = defined.GetPrim()
    points = Place(prim, space, file).local(mesh.points, Usd.TimeCode.Default())
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


def _uv(prim: Usd.Prim, time: Usd.TimeCode, surface: Triangles) -> NDArray | None:
    """Texture coordinates per triangle corner, shape (m, 3, 2): of ``st``, or of the first suitable primvar.

    Raises UserError for values that do not fit the mesh.
    """
    api, where = UsdGeom.PrimvarsAPI(prim), surface.where
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
                raise UserError(
                    f"{where}: {primvar.GetName()} has an index outside of 0 to {len(values) - 1}; export it again"
                )
            values = values[rows]
        interpolation = primvar.GetInterpolation()
        faceted = interpolation == UsdGeom.Tokens.faceVarying
        if not faceted and interpolation not in (UsdGeom.Tokens.vertex, UsdGeom.Tokens.varying):
            continue
        if values.shape != (surface.count(interpolation), 2):
            expected = f"{surface.count(interpolation)} {'corners' if faceted else 'points'}"
            raise UserError(
                f"{where}: {primvar.GetName()} has {len(values)} values for {expected}; must have one for each"
            )
        if not np.isfinite(values).all():
            raise UserError(f"{where}: {primvar.GetName()} has a value that is no number; must be finite")
        return surface.spread(values, interpolation)
    return None


def _maps(primvars: Iterable[tuple[str, str, NDArray]], surface: Triangles) -> dict[str, NDArray[np.float64]]:
    """Primvars at the corners of each triangle, by name; raises UserError for too few values."""
    maps = {}
    for name, interpolation, values in primvars:
        needed = surface.count(interpolation)
        if len(values) < needed or (interpolation == UsdGeom.Tokens.uniform and len(values) != needed):
            raise UserError(
                f"{surface.where}: {name} has {len(values)} values, too few for being {interpolation}; paint it again"
            )
        maps[name] = surface.spread(values, interpolation)
    return maps


def _vectors(prim: Usd.Prim, time: Usd.TimeCode, source: Source, surface: Triangles) -> dict[str, NDArray[np.float64]]:
    """Primvars of directions at the corners of each triangle, transformed with the points, by name."""
    upright = StageSpace(1.0, source.space.up_axis)
    origin = transformed(np.zeros((1, 3)), prim, time)
    rotated = (
        (name, interpolation, to_metres(transformed(values, prim, time) - origin, upright))
        for name, interpolation, values in vector_primvars(prim, time)
    )
    return _maps(rotated, surface)


def _subsets(prim: Usd.Prim) -> dict[str, UsdGeom.Subset]:
    found = UsdGeom.Subset.GetAllGeomSubsets(UsdGeom.Imageable(prim))
    faces = [s for s in found if s.GetElementTypeAttr().Get() == UsdGeom.Tokens.face]
    return {original_name(s.GetPrim(), s.GetPrim().GetName()): s for s in faces}


def _regions(prim: Usd.Prim, time: Usd.TimeCode, surface: Triangles) -> dict[str, NDArray[np.int32]]:
    """Face subsets as sets of triangles, by name; raises UserError for a face out of range."""
    regions, count = {}, len(surface.counts)
    for name, subset in _subsets(prim).items():
        where = f"{surface.where}/{name}"
        chosen = read_integers(subset.GetIndicesAttr(), time, where)
        if (bad := np.flatnonzero((chosen < 0) | (chosen >= count))).size:
            raise UserError(f"{where}: names face {chosen[bad[0]]}; must be from 0 to {count - 1}")
        inside = np.zeros(count, bool)
        inside[chosen] = True
        regions[name] = np.flatnonzero(inside[surface.faces]).astype(np.int32)
    return regions


def _color(prim: Usd.Prim, time: Usd.TimeCode, surface: Triangles) -> dict[str, Any]:
    """Display colour of the mesh and, if it varies, of each vertex: the mean of the vertex's corners.

    Raises UserError for colours that are not finite or negative.
    """
    primvar = UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance("displayColor")
    values = flattened(primvar, time) if primvar else None
    colors = triples(values, f"{surface.where}: its displayColor")
    if len(colors) == 0:
        return {}
    check_attribute("displayColor", colors, surface.where, "value", lambda row: f"value {row}")
    color = dict(color=tuple(map(float, colors.mean(axis=0))))
    interpolation = primvar.GetInterpolation()
    if interpolation == UsdGeom.Tokens.constant or len(colors) != surface.count(interpolation):
        return color
    if interpolation in (UsdGeom.Tokens.vertex, UsdGeom.Tokens.varying):
        return {**color, "colors": surface.at_points(colors)}
    corners = np.repeat(colors, surface.counts, axis=0) if interpolation == UsdGeom.Tokens.uniform else colors
    sums = np.stack([np.bincount(surface.indices, channel, surface.points) for channel in corners.T], axis=1)
    means = sums / np.maximum(np.bincount(surface.indices, minlength=surface.points), 1)[:, None]
    return {**color, "colors": surface.at_points(means)}
