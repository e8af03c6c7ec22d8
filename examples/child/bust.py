"""Meshes a head and writes it as USD in centimetres: skin with regions, shirt, eyes, brows and lashes."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import parts
from anatomy import Head, mirrored
from charts import unwrap
from distances import Array, project, sphere
from motion import FPS, eye_matrix, head_matrix, pose
from numpy.typing import NDArray
from pxr import Gf, Kind, Sdf, Usd, UsdGeom, UsdShade, Vt
from regions import NAMES, label, patches
from remesh import mesh_shape

GROUND = np.array([0.0, 38.0, 0.0])  # translation that puts the bust on the ground, y = 0

# Linear red, green, blue.
EYEBALL = np.array([0.82, 0.80, 0.77])
RIM = np.array([0.016, 0.007, 0.004])
PUPIL = np.array([0.004, 0.004, 0.004])
BROW = np.array([0.030, 0.017, 0.012])
LASH = np.array([0.012, 0.008, 0.007])


@dataclass
class Piece:
    """A mesh with its material.

    points:    positions in the rest pose, in the frame of the head or of the piece [cm], shape (n, 3)
    triangles: shape (m, 3)
    color:     linear colour, of the piece (3,) or of each point (n, 3)
    roughness: roughness of the surface, 0 to 1
    uv:        texture coordinates of triangle corners, shape (m, 3, 2)
    regions:   triangles of named regions, a partition
    patches:   triangles of further named regions
    """

    points: Array
    triangles: NDArray[np.int32]
    color: Array
    roughness: float
    uv: Array | None = None
    regions: dict[str, NDArray[np.int32]] = field(default_factory=dict)
    patches: dict[str, NDArray[np.int32]] = field(default_factory=dict)


def skin_size(head: Head, points: Array) -> Array:
    """Target edge lengths [cm], shape (n,): short around eyes, lips, nose and ears, and longer with distance."""
    p = mirrored(points)
    sizes = [size + 0.21 * np.maximum(distance(p), 0.0) for distance, size in head.fine]
    return np.min([*sizes, np.full(len(p), 0.64)], axis=0)


def pressed(head: Head, points: Array) -> Array:
    """Points of the skin with those under the shirt pressed down by it; all others stay, and so does where hair grows.

    The mesh is made before: a mesh of another shape has other triangles everywhere, and hair grows elsewhere.
    """
    under = np.flatnonzero(head.dressed(points) > head.skin(points) + 0.01)
    points = points.copy()
    points[under] = project(head.dressed, points[under])
    return points


def skin_color(head: Head, points: Array) -> Array:
    """Colours of points, shape (n, 3): pink lips, warm cheeks, nose and ears."""
    p = mirrored(points)
    skin, blush, lips = (head.colors[name] for name in ("skin", "blush", "lips"))
    warm = np.max([np.exp(-((sphere(p, centre, 0.0) / reach) ** 2)) for centre, reach in head.glow], axis=0)[:, None]
    on_lips = np.clip(0.5 - head.lips(p) / 0.15, 0.0, 1.0)[:, None]
    color = skin + 0.8 * warm * (blush - skin)
    return color + on_lips * (lips - color)


def iris_color(head: Head, points: Array) -> Array:
    """Colours of points, shape (n, 3): a dark rim, and a brighter lower half."""
    polar = np.arctan2(np.hypot(points[:, 0], points[:, 1]), points[:, 2]) / head.iris
    rim = np.clip((polar - 20.0 / 30.0) / 0.3, 0.0, 1.0)[:, None] ** 2
    glow = 1.0 - 0.7 * points[:, 1:2] / np.abs(points[:, 1]).max()
    return glow * head.colors["iris"] + rim * (RIM - glow * head.colors["iris"])


def shirt_size(head: Head, points: Array) -> Array:
    """Target edge lengths [cm], shape (n,): short along the neckline."""
    return np.minimum(0.3 + 0.3 * np.maximum(np.abs(head.neckline(points)) - 0.5, 0.0), 1.3)


def build(head: Head) -> dict[str, Piece]:
    """Builds all meshes, by name."""
    low, high = np.asarray(head.skin_box)
    points, triangles = mesh_shape(head.skin, low, high, head.cell, lambda p: skin_size(head, p))
    labels = label(head, points, triangles)
    regions = {name: np.flatnonzero(labels == k).astype(np.int32) for k, name in enumerate(NAMES)}
    uv, color = unwrap(points, triangles, labels, head.skull), skin_color(head, points)
    low, high = np.asarray(head.shirt_box)
    shirt = mesh_shape(head.shirt, low, high, head.cell, lambda p: shirt_size(head, p))
    pieces = {
        "skin": Piece(pressed(head, points), triangles, color, 0.5, uv, regions, patches(head, points, triangles)),
        "shirt": Piece(*shirt, head.colors["shirt"], 0.9),
    }
    iris = parts.iris(head)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        pieces[f"eye_{side}/eyeball"] = Piece(*parts.eyeball(head), EYEBALL, 0.12)
        pieces[f"eye_{side}/iris"] = Piece(*iris, iris_color(head, iris[0]), 0.08)
        pieces[f"eye_{side}/pupil"] = Piece(*parts.pupil(head), PUPIL, 0.05)
        pieces[f"brow_{side}"] = Piece(*parts.brow(head, sign), BROW, 0.8)
        pieces[f"lash_{side}"] = Piece(*parts.lash(head, sign), LASH, 0.7)
    return pieces


class Writer:
    """Writes the pieces of a head to a stage.

    frames: of the clip of ``motion``; a head without frames does not move
    """

    def __init__(self, head: Head, path: Path, frames: Sequence[int]) -> None:
        self.head, self.root = head, f"/{head.name}"
        # The default time has the rest pose, which is that of the first frame.
        self.times = [Usd.TimeCode.Default(), *map(Usd.TimeCode, map(float, frames))]
        self.stage = stage = Usd.Stage.CreateNew(str(path))
        UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
        UsdGeom.SetStageMetersPerUnit(stage, UsdGeom.LinearUnits.centimeters)
        if len(frames):
            stage.SetTimeCodesPerSecond(FPS)
            stage.SetFramesPerSecond(FPS)
            stage.SetStartTimeCode(float(frames[0]))
            stage.SetEndTimeCode(float(frames[-1]))
        root = UsdGeom.Xform.Define(stage, self.root)
        stage.SetDefaultPrim(root.GetPrim())
        Usd.ModelAPI(root).SetKind(Kind.Tokens.component)
        UsdGeom.Scope.Define(stage, f"{self.root}/materials")

    def write(self, pieces: dict[str, Piece]) -> None:
        for name, piece in pieces.items():
            if name in ("skin", "shirt"):
                self.soft(name, piece)
            else:
                self.rigid(name, piece)
        self.stage.GetRootLayer().Save()

    def mesh(self, name: str, piece: Piece) -> UsdGeom.Mesh:
        """Defines the static attributes of a mesh: topology, colour, material, texture coordinates and regions."""
        mesh = UsdGeom.Mesh.Define(self.stage, f"{self.root}/{name}")
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
        families = (
            ("region", UsdGeom.Tokens.partition, piece.regions),
            ("patch", UsdGeom.Tokens.unrestricted, piece.patches),
        )
        for family, kind, regions in families:
            for region, faces in regions.items():
                indices = Vt.IntArray.FromNumpy(faces)
                UsdGeom.Subset.CreateGeomSubset(mesh, region, UsdGeom.Tokens.face, indices, family, kind)
        material = self.material(name.split("/")[-1].split("_")[0], piece)
        UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(material)
        return mesh

    def material(self, name: str, piece: Piece) -> UsdShade.Material:
        material = UsdShade.Material.Define(self.stage, f"{self.root}/materials/{name}")
        shader = UsdShade.Shader.Define(self.stage, f"{self.root}/materials/{name}/surface")
        shader.CreateIdAttr("UsdPreviewSurface")
        diffuse = shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f)
        if piece.color.ndim == 1:
            diffuse.Set(Gf.Vec3f(*piece.color.tolist()))
        else:
            reader = UsdShade.Shader.Define(self.stage, f"{self.root}/materials/{name}/color")
            reader.CreateIdAttr("UsdPrimvarReader_float3")
            reader.CreateInput("varname", Sdf.ValueTypeNames.String).Set("displayColor")
            reader.CreateOutput("result", Sdf.ValueTypeNames.Float3)
            diffuse.ConnectToSource(reader.ConnectableAPI(), "result")
        shader.CreateInput("roughness", Sdf.ValueTypeNames.Float).Set(piece.roughness)
        material.CreateSurfaceOutput().ConnectToSource(shader.ConnectableAPI(), "surface")
        return material

    def soft(self, name: str, piece: Piece) -> None:
        """Writes a deforming piece, skin or cloth, with points at every frame."""
        mesh = self.mesh(name, piece)
        for time in self.times:
            points = piece.points if time.IsDefault() else pose(piece.points, time.GetValue())
            set_points(mesh, points + GROUND, time)

    def rigid(self, name: str, piece: Piece) -> None:
        """Writes a rigid piece, eye, lash or brow, with a transform at every frame."""
        mesh = self.mesh(name, piece)
        set_points(mesh, piece.points, Usd.TimeCode.Default())
        owner = UsdGeom.Xform.Define(self.stage, f"{self.root}/{name.split('/')[0]}") if "/" in name else mesh
        operation = UsdGeom.Xformable(owner).MakeMatrixXform()
        centre = self.head.eye.centre * [1.0 if "left" in name else -1.0, 1.0, 1.0]
        for time in self.times:
            frame = 0.0 if time.IsDefault() else time.GetValue()  # every channel of the clip is constant up to frame 1
            matrix = eye_matrix(centre, frame) if "/" in name else head_matrix(frame)
            matrix[:3, 3] += GROUND
            operation.Set(Gf.Matrix4d(*matrix.T.ravel().tolist()), time)


def set_points(mesh: UsdGeom.Mesh, points: Array, time: Usd.TimeCode) -> None:
    values = points.astype(np.float32)
    mesh.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(values), time)
    mesh.GetExtentAttr().Set(Vt.Vec3fArray.FromNumpy(np.stack([values.min(axis=0), values.max(axis=0)])), time)


def run(head: Head, path: Path, frames: Sequence[int] = ()) -> None:
    """Makes a head from the command line: ``-o`` names another file than ``path``."""
    parser = argparse.ArgumentParser(description=f"Makes the head of the {head.name}.")
    parser.add_argument("-o", "--output", type=Path, default=path)
    output = parser.parse_args().output
    pieces = build(head)
    Writer(head, output, frames).write(pieces)
    vertices = sum(len(piece.points) for piece in pieces.values())
    print(f"{output}: {len(pieces)} meshes, {vertices} vertices, {output.stat().st_size / 1e6:.1f} MB")
