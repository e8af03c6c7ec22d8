"""Cloth in USD files beside the small example."""

import numpy as np
from commands import run
from pxr import Gf, Usd, UsdGeom, Vt
from ringlet.data.cache import Cache, CachedCloth

import ringlet

SCARF = """
[contact]
[[cloth]]
file = "wear.usda"
mesh = "/wear/scarf"
[cloth.material]
thickness = 2e-3
"""


def define(stage, path, points, faces):
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(np.asarray(points, np.float32)))
    mesh.CreateExtentAttr(UsdGeom.PointBased.ComputeExtent(mesh.GetPointsAttr().Get()))
    mesh.CreateFaceVertexCountsAttr([len(face) for face in faces])
    mesh.CreateFaceVertexIndicesAttr([corner for face in faces for corner in face])
    mesh.CreateSubdivisionSchemeAttr("none")
    return mesh


def quads(columns, rows):
    return [[k + columns * j for k, j in ((i, r), (i + 1, r), (i + 1, r + 1), (i, r + 1))]
            for r in range(rows - 1) for i in range(columns - 1)]  # fmt: skip


def write_wear(folder, change=lambda mesh: None):
    """Writes a sheet of quads over the ball, in metres and with a transform; the ball is in centimetres."""
    stage = Usd.Stage.CreateNew(str(folder / "wear.usda"))
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdGeom.SetStageUpAxis(stage, "Y")
    stage.SetTimeCodesPerSecond(24)
    top = UsdGeom.Xform.Define(stage, "/wear")
    stage.SetDefaultPrim(top.GetPrim())
    top.AddTranslateOp().Set(Gf.Vec3d(0, 0.16, 0))
    at = np.linspace(-0.04, 0.04, 9)
    x, z = np.meshgrid(at, at)
    points = np.stack([x, 0 * x, z], axis=-1).reshape(-1, 3)
    mesh = define(stage, "/wear/scarf", points, quads(9, 9))
    mesh.CreateNormalsAttr(Vt.Vec3fArray.FromNumpy(np.tile(np.float32([0, 1, 0]), (81, 1))))
    change(mesh)
    stage.Save()


def write_roofed(folder):
    """Writes wide locks of the small example at rest with a horizontal sheet above them; returns its height [m]."""
    write_wear(folder)
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text() + 'lock_radius = "6 mm"\n')
    groom = ringlet.build_groom(recipe)
    ringlet.write_groom(groom, folder / "groom.usdc")
    locks = groom.locks.points
    at = np.linspace(-0.2, 0.2, 9)
    x, z = np.meshgrid(at, at)
    top = float(locks[:, 1].max()) + 1e-3
    roof = np.stack([x, 0 * x + top, z], axis=-1).reshape(1, -1, 3).astype(np.float32)
    cloth = CachedCloth("scarf", folder / "wear.usda", "/wear/scarf", roof)
    cache = Cache(np.array([1.0]), locks[None].astype(np.float32), cloths=[cloth])
    ringlet.write_cache(cache, folder / "groom.usdc", folder / "cache.usdc")
    ringlet.write_hairs(folder / "groom.usdc", folder / "hair.usdc", cache=folder / "cache.usdc")
    return top


def sim(folder, shot="small.shot.toml", *more):
    return run("sim", folder / shot, "--groom", folder / "groom.usdc", "-o", folder / "cache.usdc", *more)
