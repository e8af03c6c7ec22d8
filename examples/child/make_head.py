"""Makes the example head: a child's bust with a named scalp and a clip of 48 frames, as USD in centimetres.

    python examples/child/make_head.py [-o head.usdc]

Needs scikit-image in addition to Ringlet's requirements. The result is in the repository; there is no need to run the
script.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass, field
from pathlib import Path

import head_shape
import numpy as np
import parts
from charts import unwrap
from distances import Array, capsule, sphere
from motion import FPS, FRAMES, eye_matrix, head_matrix, pose
from numpy.typing import NDArray
from pxr import Gf, Kind, Sdf, Usd, UsdGeom, UsdShade, Vt
from regions import NAMES, label
from remesh import mesh_shape

GROUND = np.array([0.0, 38.0, 0.0])  # translation that puts the bust on the ground, y = 0

# Linear red, green, blue.
SKIN = np.array([0.34, 0.165, 0.095])
LIPS = np.array([0.32, 0.085, 0.07])
BLUSH = np.array([0.40, 0.125, 0.08])
SHIRT = np.array([0.55, 0.31, 0.085])
EYEBALL = np.array([0.82, 0.80, 0.77])
IRIS = np.array([0.105, 0.041, 0.016])
RIM = np.array([0.016, 0.007, 0.004])
PUPIL = np.array([0.004, 0.004, 0.004])
BROW = np.array([0.030, 0.017, 0.012])
LASH = np.array([0.012, 0.008, 0.007])

TIMES = [Usd.TimeCode.Default(), *map(Usd.TimeCode, map(float, FRAMES))]  # the default time has the rest pose


@dataclass
class Piece:
    """A mesh with its material.

    points:    positions in the rest pose, in the frame of the head or of the piece [cm], shape (n, 3)
    triangles: shape (m, 3)
    color:     linear colour, of the piece (3,) or of each point (n, 3)
    roughness: roughness of the surface, 0 to 1
    uv:        texture coordinates of triangle corners, shape (m, 3, 2)
    regions:   triangles of named regions
    """

    points: Array
    triangles: NDArray[np.int32]
    color: Array
    roughness: float
    uv: Array | None = None
    regions: dict[str, NDArray[np.int32]] = field(default_factory=dict)


def skin_size(points: Array) -> Array:
    """Target edge lengths [cm], shape (n,): short around eyes, lips, nose and ears, and longer with distance."""
    p = head_shape.mirrored(points)
    fine = [
        (sphere(p, head_shape.EYE_CENTRE + [0, 0, 1.4], 1.9), 0.155),
        (capsule(p, (0, -5.1, 7.0), (2.3, -4.9, 6.0), 0.8), 0.14),
        (sphere(p, (0.5, -3.2, 7.8), 1.0), 0.155),
        (sphere(p, head_shape.EAR_CENTRE + [0.5, 0, -0.5], 2.8), 0.235),
    ]
    return np.min(
        [size + 0.21 * np.maximum(distance, 0.0) for distance, size in fine] + [np.full(len(p), 0.64)], axis=0
    )


def skin_color(points: Array) -> Array:
    """Colours of points, shape (n, 3): pink lips, warm cheeks, nose and ears."""
    p = head_shape.mirrored(points)
    glow = [(3.9, -3.4, 6.0), 1.7], [(0.0, -3.2, 8.6), 1.0], [head_shape.EAR_CENTRE + [1.2, 0.5, -1.0], 2.0]
    blush = np.max([np.exp(-((sphere(p, centre, 0.0) / reach) ** 2)) for centre, reach in glow], axis=0)[:, None]
    lips = np.clip(0.5 - head_shape.lips(p) / 0.15, 0.0, 1.0)[:, None]
    color = SKIN + 0.8 * blush * (BLUSH - SKIN)
    return color + lips * (LIPS - color)


def iris_color(points: Array) -> Array:
    """Colours of points, shape (n, 3): a dark rim, and a brighter lower half."""
    polar = np.degrees(np.arctan2(np.hypot(points[:, 0], points[:, 1]), points[:, 2]))
    rim = np.clip((polar - 20.0) / 9.0, 0.0, 1.0)[:, None] ** 2
    glow = 1.0 - 0.7 * points[:, 1:2] / np.abs(points[:, 1]).max()
    return glow * IRIS + rim * (RIM - glow * IRIS)


def shirt_size(points: Array) -> Array:
    """Target edge lengths [cm], shape (n,): short along the neckline."""
    return np.minimum(0.3 + 0.3 * np.maximum(np.abs(head_shape.neckline(points)) - 0.5, 0.0), 1.3)


def build() -> dict[str, Piece]:
    """Builds all meshes, by name."""
    low, high = np.array([-9.6, -20.0, -11.2]), np.array([9.6, 11.2, 9.8])
    points, triangles = mesh_shape(head_shape.skin, low, high, 0.3, skin_size)
    labels = label(points, triangles)
    regions = {name: np.flatnonzero(labels == k).astype(np.int32) for k, name in enumerate(NAMES)}
    skin = Piece(points, triangles, skin_color(points), 0.5, unwrap(points, triangles, labels), regions)
    low, high = np.array([-11.6, -38.6, -9.2]), np.array([11.6, -7.6, 3.2])
    pieces = {"skin": skin, "shirt": Piece(*mesh_shape(head_shape.shirt, low, high, 0.3, shirt_size), SHIRT, 0.9)}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        pieces[f"eye_{side}/eyeball"] = Piece(*parts.eyeball(), EYEBALL, 0.12)
        pieces[f"eye_{side}/iris"] = Piece(*parts.iris(), iris_color(parts.iris()[0]), 0.08)
        pieces[f"eye_{side}/pupil"] = Piece(*parts.pupil(), PUPIL, 0.05)
        pieces[f"brow_{side}"] = Piece(*parts.brow(sign), BROW, 0.8)
        pieces[f"lash_{side}"] = Piece(*parts.lash(sign), LASH, 0.7)
    return pieces


def write(pieces: dict[str, Piece], path: Path) -> None:
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    UsdGeom.SetStageMetersPerUnit(stage, UsdGeom.LinearUnits.centimeters)
    stage.SetTimeCodesPerSecond(FPS)
    stage.SetFramesPerSecond(FPS)
    stage.SetStartTimeCode(float(FRAMES[0]))
    stage.SetEndTimeCode(float(FRAMES[-1]))
    child = UsdGeom.Xform.Define(stage, "/child")
    stage.SetDefaultPrim(child.GetPrim())
    Usd.ModelAPI(child).SetKind(Kind.Tokens.component)
    UsdGeom.Scope.Define(stage, "/child/materials")
    for name, piece in pieces.items():
        if name in ("skin", "shirt"):
            define_soft(stage, name, piece)
        else:
            define_rigid(stage, name, piece)
    stage.GetRootLayer().Save()


def define_mesh(stage: Usd.Stage, name: str, piece: Piece) -> UsdGeom.Mesh:
    """Defines the static attributes of a mesh: topology, colour, material, texture coordinates and regions."""
    mesh = UsdGeom.Mesh.Define(stage, f"/child/{name}")
    mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    mesh.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(len(piece.triangles), 3, np.int32)))
    mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(piece.triangles.ravel()))
    per_point = piece.color.ndim == 2
    color = mesh.CreateDisplayColorPrimvar(UsdGeom.Tokens.vertex if per_point else UsdGeom.Tokens.constant)
    color.Set(Vt.Vec3fArray.FromNumpy(np.atleast_2d(piece.color).astype(np.float32)))
    if piece.uv is not None:
        values, indices = np.unique(piece.uv.reshape(-1, 2).astype(np.float32), axis=0, return_inverse=True)
        st = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar(
            "st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.faceVarying
        )
        st.Set(Vt.Vec2fArray.FromNumpy(values))
        st.SetIndices(Vt.IntArray.FromNumpy(indices.ravel().astype(np.int32)))
    for region, faces in piece.regions.items():
        UsdGeom.Subset.CreateGeomSubset(
            mesh, region, UsdGeom.Tokens.face, Vt.IntArray.FromNumpy(faces), "region", UsdGeom.Tokens.partition
        )
    material = define_material(stage, name.split("/")[-1].split("_")[0], piece)
    UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(material)
    return mesh


def define_material(stage: Usd.Stage, name: str, piece: Piece) -> UsdShade.Material:
    material = UsdShade.Material.Define(stage, f"/child/materials/{name}")
    shader = UsdShade.Shader.Define(stage, f"/child/materials/{name}/surface")
    shader.CreateIdAttr("UsdPreviewSurface")
    diffuse = shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f)
    if piece.color.ndim == 1:
        diffuse.Set(Gf.Vec3f(*piece.color.tolist()))
    else:
        reader = UsdShade.Shader.Define(stage, f"/child/materials/{name}/color")
        reader.CreateIdAttr("UsdPrimvarReader_float3")
        reader.CreateInput("varname", Sdf.ValueTypeNames.String).Set("displayColor")
        reader.CreateOutput("result", Sdf.ValueTypeNames.Float3)
        diffuse.ConnectToSource(reader.ConnectableAPI(), "result")
    shader.CreateInput("roughness", Sdf.ValueTypeNames.Float).Set(piece.roughness)
    material.CreateSurfaceOutput().ConnectToSource(shader.ConnectableAPI(), "surface")
    return material


def define_soft(stage: Usd.Stage, name: str, piece: Piece) -> None:
    """Writes a deforming piece, skin or cloth, with points at every frame."""
    mesh = define_mesh(stage, name, piece)
    for time in TIMES:
        points = piece.points if time.IsDefault() else pose(piece.points, time.GetValue())
        set_points(mesh, points + GROUND, time)


def define_rigid(stage: Usd.Stage, name: str, piece: Piece) -> None:
    """Writes a rigid piece, eye, lash or brow, with a transform at every frame."""
    mesh = define_mesh(stage, name, piece)
    set_points(mesh, piece.points, Usd.TimeCode.Default())
    owner = UsdGeom.Xform.Define(stage, f"/child/{name.split('/')[0]}") if "/" in name else mesh
    operation = UsdGeom.Xformable(owner).MakeMatrixXform()
    centre = head_shape.EYE_CENTRE * [1.0 if "left" in name else -1.0, 1.0, 1.0]
    for time in TIMES:
        frame = FRAMES[0] if time.IsDefault() else time.GetValue()
        matrix = eye_matrix(centre, frame) if "/" in name else head_matrix(frame)
        matrix[:3, 3] += GROUND
        operation.Set(Gf.Matrix4d(*matrix.T.ravel().tolist()), time)


def set_points(mesh: UsdGeom.Mesh, points: Array, time: Usd.TimeCode) -> None:
    values = points.astype(np.float32)
    mesh.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(values), time)
    mesh.GetExtentAttr().Set(Vt.Vec3fArray.FromNumpy(np.stack([values.min(axis=0), values.max(axis=0)])), time)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).with_name("head.usdc"))
    output = parser.parse_args().output
    pieces = build()
    write(pieces, output)
    vertices = sum(len(piece.points) for piece in pieces.values())
    print(f"{output}: {len(pieces)} meshes, {vertices} vertices, {output.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
