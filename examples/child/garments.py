"""Functions that the example's garments share: distance to the body, strips of triangles, and the USD writer."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import head_shape
import numpy as np
from distances import Array
from numpy.typing import NDArray
from pxr import Gf, Kind, Usd, UsdGeom, Vt

GROUND = np.array([0.0, 38.0, 0.0])  # height above the ground, as of the head
FPS = 24.0


def body(points: Array) -> Array:
    """Distance to the child with its shirt [cm]."""
    return np.minimum(head_shape.skin(points), head_shape.shirt(points))


def strip(columns: int, rows: int, closed: bool = False) -> NDArray[np.int32]:
    """Triangles of a grid with vertices numbered by column and alternating diagonals, shape (m, 3)."""
    triangles = []
    for i in range(columns if closed else columns - 1):
        for j in range(rows - 1):
            a, b = i * rows + j, (i + 1) % columns * rows + j
            triangles += [(a, b, b + 1), (a, b + 1, a + 1)] if (i + j) % 2 else [(a, b, a + 1), (b, b + 1, a + 1)]
    return np.array(triangles, np.int32)


def without(points: Array, triangles: NDArray[np.int32], kept: NDArray[np.bool_]) -> tuple[Array, NDArray[np.int32]]:
    """Removes the vertices of a mesh that are not in ``kept``."""
    number = np.cumsum(kept) - 1
    return points[kept], number[triangles[kept[triangles].all(axis=1)]].astype(np.int32)


def shifted(by: Array) -> Array:
    """Translation matrix, shape (4, 4)."""
    matrix = np.eye(4)
    matrix[:3, 3] = by
    return matrix


def write_garment(
    path: Path,
    name: str,
    points: Array,
    triangles: NDArray[np.int32],
    color: Array,
    *,
    subsets: Mapping[str, NDArray[np.int64]] | None = None,
    motion: Mapping[int, Array] | None = None,
) -> None:
    """Writes a mesh at ``/NAME``.

    points:  positions [cm], shape (n, 3)
    color:   linear colour, of the mesh or of each point
    subsets: faces by name of the subset
    motion:  4 × 4 matrices for column vectors, by frame
    """
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    UsdGeom.SetStageMetersPerUnit(stage, UsdGeom.LinearUnits.centimeters)
    stage.SetTimeCodesPerSecond(FPS)
    stage.SetFramesPerSecond(FPS)
    mesh = UsdGeom.Mesh.Define(stage, f"/{name}")
    stage.SetDefaultPrim(mesh.GetPrim())
    Usd.ModelAPI(mesh).SetKind(Kind.Tokens.component)
    mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    mesh.CreateDoubleSidedAttr(True)
    mesh.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(len(triangles), 3, np.int32)))
    mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(triangles.ravel()))
    mesh.CreateDisplayColorPrimvar(UsdGeom.Tokens.vertex).Set(
        Vt.Vec3fArray.FromNumpy(np.broadcast_to(color, points.shape).astype(np.float32))
    )
    for subset, faces in (subsets or {}).items():
        UsdGeom.Subset.CreateGeomSubset(
            mesh, subset, UsdGeom.Tokens.face, Vt.IntArray.FromNumpy(faces.astype(np.int32))
        )
    values = (points + GROUND).astype(np.float32)
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(values))
    mesh.CreateExtentAttr(Vt.Vec3fArray.FromNumpy(np.stack([values.min(axis=0), values.max(axis=0)])))
    if motion:
        stage.SetStartTimeCode(min(motion))
        stage.SetEndTimeCode(max(motion))
        operation, up = mesh.AddTransformOp(), shifted(GROUND)
        for frame, matrix in motion.items():
            operation.Set(Gf.Matrix4d(*(up @ matrix @ np.linalg.inv(up)).T.ravel().tolist()), frame)
    stage.GetRootLayer().Save()
    print(f"{path}: {len(points)} vertices, {path.stat().st_size / 1e3:.0f} kB")
