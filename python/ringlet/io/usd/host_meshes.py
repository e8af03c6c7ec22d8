"""Polygon meshes of other programs as a USD file, for programs that hand over arrays instead of files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom, Vt

from ringlet.data.errors import UserError
from ringlet.data.names import distinct
from ringlet.data.stage import StageSpace
from ringlet.io.usd.names import identifier, keep_name
from ringlet.io.usd.stage import new_stage, writing
from ringlet.io.usd.values import Types, float3, set_primvar

ROOT = "scene"


@dataclass
class PolygonMesh:
    """A polygon mesh in the unit and axes of its file.

    points:     rest pose, shape (n, 3)
    counts:     corners of each face, shape (faces,)
    indices:    points of the corners, shape (corners,)
    uv:         texture coordinates of the corners, shape (corners, 2), or None
    maps:       painted values of the points by name, shape (n,)
    regions:    faces by name, shape (k,)
    motion:     points at successive frames, shape (frames, n, 3), or None for a mesh that stands still
    subdivided: whether it is the cage of a Catmull-Clark surface
    """

    name: str
    points: NDArray
    counts: NDArray
    indices: NDArray
    uv: NDArray | None = None
    maps: Mapping[str, NDArray] = field(default_factory=dict)
    regions: Mapping[str, NDArray] = field(default_factory=dict)
    motion: NDArray | None = None
    subdivided: bool = False

    def check(self) -> None:
        """Raises UserError for arrays that do not fit one another, with the name of the array."""
        n, corners = len(self.points), len(self.indices)
        expected = {
            "points": (self.points, (n, 3)),
            "counts": (self.counts, (len(self.counts),)),
            "indices": (self.indices, (int(np.sum(self.counts)),)),
            "uv": (self.uv, (corners, 2)),
            "motion": (self.motion, (0 if self.motion is None else len(self.motion), n, 3)),
            **{f"map {name}": (values, (n,)) for name, values in self.maps.items()},
        }
        for what, (values, shape) in expected.items():
            if values is not None and values.shape != shape:
                raise UserError(f"mesh '{self.name}': {what} has the shape {values.shape}; must be {shape}")
            if values is not None and not np.isfinite(values).all():
                raise UserError(f"mesh '{self.name}': {what} has a value that is not finite; mend the mesh")
        if not corners or self.counts.min() < 3:
            raise UserError(f"mesh '{self.name}': has no faces of three corners; give it some")
        if self.indices.min() < 0 or self.indices.max() >= n:
            raise UserError(f"mesh '{self.name}': a corner is outside of its {n} points; send it again")


def write_polygon_meshes(
    meshes: Sequence[PolygonMesh], path: Path | str, space: StageSpace, first_frame: int = 1
) -> list[str]:
    """Writes meshes below ``/scene`` and returns the paths of their prims, in the same order.

    first_frame: frame of the first row of each ``motion``
    """
    for mesh in meshes:
        mesh.check()
    taken: list[str] = []
    with writing(path) as aside:
        stage = new_stage(aside, space)
        stage.SetDefaultPrim(UsdGeom.Xform.Define(stage, f"/{ROOT}").GetPrim())
        frames = max((len(mesh.motion) for mesh in meshes if mesh.motion is not None), default=0)
        if frames:
            stage.SetStartTimeCode(first_frame)
            stage.SetEndTimeCode(first_frame + frames - 1)
        for mesh in meshes:
            taken.append(identifier(mesh.name, taken))
            _define(stage, f"/{ROOT}/{taken[-1]}", mesh, first_frame)
        stage.Save()
    return [f"/{ROOT}/{name}" for name in taken]


def _define(stage: Usd.Stage, path: str, mesh: PolygonMesh, first_frame: int) -> None:
    defined = UsdGeom.Mesh.Define(stage, path)
    prim, tokens = defined.GetPrim(), UsdGeom.Tokens
    keep_name(prim, mesh.name)
    defined.CreateSubdivisionSchemeAttr(tokens.catmullClark if mesh.subdivided else tokens.none)
    defined.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(mesh.counts.astype(np.int32)))
    defined.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(mesh.indices.astype(np.int32)))
    poses = [(Usd.TimeCode.Default(), mesh.points)]
    if mesh.motion is not None:
        poses += [(Usd.TimeCode(first_frame + k), points) for k, points in enumerate(mesh.motion)]
    for time, points in poses:
        value = float3(points)
        defined.CreatePointsAttr().Set(value, time)
        defined.CreateExtentAttr().Set(UsdGeom.PointBased.ComputeExtent(value), time)
    if mesh.uv is not None:
        set_primvar(prim, "st", tokens.faceVarying, mesh.uv.astype(np.float32), Types.TexCoord2fArray)
    names = distinct(["st", *mesh.maps])[1:]
    for name, values in zip(names, mesh.maps.values(), strict=True):
        set_primvar(prim, name, tokens.vertex, values.astype(np.float32))
    subsets: list[str] = []
    for name, faces in mesh.regions.items():
        subsets.append(identifier(name, subsets))
        indices = Vt.IntArray.FromNumpy(faces.astype(np.int32))
        subset = UsdGeom.Subset.CreateGeomSubset(defined, subsets[-1], tokens.face, indices)
        if subsets[-1] != name:
            keep_name(subset.GetPrim(), name)
