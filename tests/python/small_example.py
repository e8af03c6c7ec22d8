"""A small example of the whole pipeline: a sphere as head, eight locks, four frames."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from pxr import Gf, Usd, UsdGeom, Vt

RADIUS = 9.0  # [cm]
FRAMES = 4

RECIPE = """
ringlet = 2
name = "small"

[scalp]
file = "head.usda"
region = "scalp"

[guides]
count = 6
length = 5

[locks]
count = 8
points = 40

[curl]
width = 1.0
pitch = 1.5

[hairs]
per_lock = 3
"""

SHOT = f"""
ringlet = 2
groom = "small.recipe.toml"
frames = [1, {FRAMES}]
preroll = 0
"""


def write_head(path: Path, *, unit: float = 0.01, up: str = "Y") -> Path:
    """A sphere that turns about the vertical, its upper half the scalp, of the same size in any unit."""
    size, rings, sides = RADIUS * 0.01 / unit, 8, 16
    polar = np.linspace(0, np.pi, rings + 1)[1:-1, None]
    around = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    ring = np.stack(
        [np.sin(polar) * np.sin(around), np.cos(polar) + 0 * around, np.sin(polar) * np.cos(around)], axis=-1
    ).reshape(-1, 3)
    points = size * np.concatenate([[[0, 1, 0]], ring, [[0, -1, 0]]])
    faces = [[0, 1 + k, 1 + (k + 1) % sides] for k in range(sides)]
    for row in range(rings - 2):
        a = 1 + row * sides + np.arange(sides)
        b = 1 + row * sides + (np.arange(sides) + 1) % sides
        faces += np.stack([a, a + sides, b + sides], 1).tolist() + np.stack([a, b + sides, b], 1).tolist()
    first, last = 1 + (rings - 2) * sides, len(points) - 1
    faces += [[first + k, last, first + (k + 1) % sides] for k in range(sides)]
    upper = [index for index, face in enumerate(faces) if points[face, 1].mean() > 0.1 * size]
    if up == "Z":
        points = points[:, [0, 2, 1]] * (1, -1, 1)

    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageMetersPerUnit(stage, unit)
    UsdGeom.SetStageUpAxis(stage, up)
    stage.SetTimeCodesPerSecond(24)
    stage.SetStartTimeCode(1)
    stage.SetEndTimeCode(FRAMES)
    root = UsdGeom.Xform.Define(stage, "/ball")
    stage.SetDefaultPrim(root.GetPrim())
    turn = root.AddRotateZOp() if up == "Z" else root.AddRotateYOp()
    for frame in range(1, FRAMES + 1):
        turn.Set(5.0 * (frame - 1), frame)
    mesh = UsdGeom.Mesh.Define(stage, "/ball/skin")
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points.astype(np.float32)))
    mesh.CreateFaceVertexCountsAttr([3] * len(faces))
    mesh.CreateFaceVertexIndicesAttr(np.array(faces).ravel().tolist())
    mesh.CreateSubdivisionSchemeAttr("none")
    mesh.CreateExtentAttr([Gf.Vec3f(-size), Gf.Vec3f(size)])
    UsdGeom.Subset.CreateGeomSubset(mesh, "scalp", "face", upper, "region")
    stage.Save()
    return path


def write_example(folder: Path) -> Path:
    """Writes head, recipe and shot to a folder; returns it."""
    folder.mkdir(parents=True, exist_ok=True)
    write_head(folder / "head.usda")
    (folder / "small.recipe.toml").write_text(RECIPE)
    (folder / "small.shot.toml").write_text(SHOT)
    return folder
