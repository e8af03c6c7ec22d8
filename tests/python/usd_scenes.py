"""Small USD files for tests of reading and writing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from pxr import Gf, Sdf, Usd, UsdGeom, Vt
from ringlet.io import read_mesh, read_space

from ringlet import Curves, Groom, Mesh

CUBE = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])  # corner 4x + 2y + z
CUBE_FACES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]  # outward
FRAMES = (1, 4)


def new_stage(path: Path, *, unit: float | None = 0.01, axis: str = "Y") -> Usd.Stage:
    stage = Usd.Stage.CreateNew(str(path))
    if unit is not None:
        UsdGeom.SetStageMetersPerUnit(stage, unit)
    UsdGeom.SetStageUpAxis(stage, axis)
    stage.SetTimeCodesPerSecond(24)
    stage.SetDefaultPrim(UsdGeom.Xform.Define(stage, "/head").GetPrim())
    return stage


def add_cube(
    stage: Usd.Stage, path: str = "/head/skin", *, points: np.ndarray = CUBE, scalp: bool = True
) -> UsdGeom.Mesh:
    """A cube of quads; its last face, z = 1, is the scalp."""
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreateSubdivisionSchemeAttr("none")
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points.astype(np.float32)))
    mesh.CreateExtentAttr(UsdGeom.PointBased.ComputeExtent(mesh.GetPointsAttr().Get()))
    mesh.CreateFaceVertexCountsAttr([4] * 6)
    mesh.CreateFaceVertexIndicesAttr([corner for face in CUBE_FACES for corner in face])
    if scalp:
        UsdGeom.Subset.CreateGeomSubset(mesh, "scalp", UsdGeom.Tokens.face, [5])
    return mesh


def write_head(path: Path, *, unit: float = 0.01, axis: str = "Y", moving: bool = True) -> Path:
    """A cube of 0.1 m that slides 0.01 m a frame along +x, saved in the given unit and up-axis."""
    stage = new_stage(path, unit=unit, axis=axis)
    points = CUBE * 0.1 / unit
    if axis == "Z":
        points = np.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1)
    mesh = add_cube(stage, points=points)
    uv = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, "faceVarying")
    uv.Set([Gf.Vec2f(*corner) for _ in range(6) for corner in ((0, 0), (1, 0), (1, 1), (0, 1))])
    if moving:
        stage.SetStartTimeCode(FRAMES[0])
        stage.SetEndTimeCode(FRAMES[1])
        slide = UsdGeom.Xformable(stage.GetPrimAtPath("/head")).AddTranslateOp()
        for frame in range(FRAMES[0], FRAMES[1] + 1):
            slide.Set(Gf.Vec3d(0.01 / unit * (frame - FRAMES[0]), 0, 0), frame)
    stage.Save()
    return path


def make_groom(head: Path | None, scalp: Mesh | None = None) -> Groom:
    """Five locks of seven points on the scalp of a head, with attributes of every kind."""
    mesh = scalp or read_mesh(head)
    rng = np.random.default_rng(3)
    triangles = rng.choice(mesh.region("scalp"), 5).astype(np.int32)
    weights = rng.dirichlet([1, 1, 1], 5)
    roots = np.einsum("nk,nkd->nd", weights, mesh.points[mesh.triangles[triangles]])
    locks = Curves.from_list(
        [root + np.linspace(0, 0.05, 7)[:, None] * [0.1, 0.2, 1.0] for root in roots], [7, 3, 11, 2**40, 5]
    )
    locks.curve = {
        "root_triangle": triangles,
        "root_barycentric": weights,
        "frame": rng.random((5, 3, 3)),
        "name": np.array(["a", "b", "ç", "d", "e"]),
        "free": np.array([True, False, True, True, False]),
    }
    locks.point = {"width": rng.random(35).astype(np.float32) * 1e-4, "ramp": rng.random(35)}
    guides = Curves.from_list([root + np.linspace(0, 0.05, 4)[:, None] * [0.0, 0.0, 1.0] for root in roots[:2]])
    space = read_space(head) if head else Groom(guides, locks, mesh).space
    return Groom(
        guides, locks, mesh, head, "/head/skin" if head else None, "scalp", space, {"per_lock": 4}, "recipe = 'ñ'\n"
    )


def hairs_of(groom):
    """Two hairs for every lock."""
    lock = np.repeat(np.arange(len(groom.locks), dtype=np.int32), 2)
    hairs = groom.locks.take(lock)
    hairs.points = (hairs.points + np.repeat([0.0, 0.001] * len(groom.locks), 7)[:, None]).astype(np.float32)
    curve = {name: hairs.curve[name] for name in ("root_triangle", "root_barycentric")} | {"lock": lock}
    return Curves(hairs.points, hairs.offsets, np.arange(len(hairs)), curve, {"width": hairs.point["width"]})
