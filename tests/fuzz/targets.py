"""Fuzz targets: each reader on a file of arbitrary bytes. A reader reads or raises UserError.

A target is a function of bytes and an empty folder. Text and binary files consist of these bytes. USD stages are built
from them with arbitrary lengths, counts, indices and values, since the parsers of USD are not under test.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
from ringlet.data.errors import UserError
from ringlet.io import read_bodies, read_clip, read_curves, read_groom, read_mesh
from ringlet.shot import parse_shot

from ringlet.groom import parse_recipe

MOST = 64  # entries of a generated array


class Given:
    """Decodes values from bytes, with zeros after their end, so that every input is valid."""

    def __init__(self, data: bytes) -> None:
        self._data, self._at = data, 0

    def bytes(self, count: int) -> bytes:
        """The next bytes."""
        taken = self._data[self._at : self._at + count]
        self._at += count
        return taken.ljust(count, b"\0")

    def below(self, count: int) -> int:
        """An integer from 0 to ``count`` - 1."""
        return self.bytes(1)[0] % count

    def whole(self) -> int:
        """An integer, often small, sometimes at the limits of its range."""
        kind = self.below(8)
        if kind < 6:
            return self.bytes(1)[0] - 4 * (kind == 5)
        return struct.unpack("<i", self.bytes(4))[0]

    def wholes(self) -> list[int]:
        """A list of integers."""
        return [self.whole() for _ in range(self.below(MOST))]

    def number(self) -> float:
        """A float: small, or arbitrary bits, infinities and NaN included."""
        return (self.bytes(1)[0] - 128) / 16 if self.below(4) else struct.unpack("<f", self.bytes(4))[0]

    def vectors(self, size: int, count: int | None = None) -> np.ndarray:
        """Rows of floats, float32."""
        rows = self.below(MOST) if count is None else count
        return np.array([[self.number() for _ in range(size)] for _ in range(rows)], np.float32).reshape(rows, size)

    def one_of(self, names: tuple[str, ...]) -> str:
        """One of the given names."""
        return names[self.below(len(names))]


def recipe(data: bytes, folder: Path) -> None:
    """A recipe whose files are in its folder."""
    parse_recipe(data.decode("utf-8", "replace"), folder / "a.recipe.toml")


def shot(data: bytes, folder: Path) -> None:
    """A shot."""
    parse_shot(data.decode("utf-8", "replace"), folder / "a.shot.toml")


def hair(data: bytes, folder: Path) -> None:
    """A .hair file."""
    (folder / "a.hair").write_bytes(data)
    read_curves(folder / "a.hair")


def obj(data: bytes, folder: Path) -> None:
    """An OBJ as a mesh and as curves."""
    (folder / "a.obj").write_bytes(data)
    for read in (read_mesh, read_curves):
        allowed(read, folder / "a.obj")


def usd_curves(data: bytes, folder: Path) -> None:
    """Curves of any type, basis and wrap."""
    from pxr import Sdf, Usd, UsdGeom, Vt

    given, path = Given(data), folder / "a.usda"
    layer = Sdf.Layer.CreateAnonymous(".usda")
    stage = Usd.Stage.Open(layer)
    curves = UsdGeom.BasisCurves.Define(stage, "/hair")
    curves.CreateTypeAttr(given.one_of(("linear", "cubic")))
    curves.CreateBasisAttr(given.one_of(("bezier", "bspline", "catmullRom")))
    curves.CreateWrapAttr(given.one_of(("nonperiodic", "periodic", "pinned")))
    counts = [2 + given.below(6) if given.below(64) else given.whole() for _ in range(given.below(MOST))]
    curves.CreateCurveVertexCountsAttr(Vt.IntArray(counts))
    fitting = sum(counts) if given.below(4) and 0 <= sum(counts) < 4 * MOST else None
    curves.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(given.vectors(3, fitting)))
    if given.below(2):
        curves.CreateWidthsAttr(Vt.FloatArray.FromNumpy(given.vectors(1).ravel()))
        curves.SetWidthsInterpolation(given.one_of(("constant", "uniform", "varying", "vertex", "faceVarying")))
    for name, kind in (("id", Sdf.ValueTypeNames.IntArray), ("groom_id", Sdf.ValueTypeNames.IntArray)):
        if given.below(2):
            primvar = UsdGeom.PrimvarsAPI(curves).CreatePrimvar(name, kind, given.one_of(("uniform", "vertex")))
            primvar.Set(Vt.IntArray(given.wholes()))
            if given.below(2):
                primvar.SetIndices(Vt.IntArray(given.wholes()))
    UsdGeom.SetStageMetersPerUnit(stage, abs(given.number()))
    layer.Export(str(path))
    for read in (read_curves, read_groom):
        allowed(read, path)


def usd_mesh(data: bytes, folder: Path) -> None:
    """A mesh with holes, subsets, texture coordinates, painted values and a few moving frames."""
    from pxr import Gf, Sdf, Usd, UsdGeom, Vt

    given, path = Given(data), folder / "a.usda"
    layer = Sdf.Layer.CreateAnonymous(".usda")
    stage = Usd.Stage.Open(layer)
    mesh = UsdGeom.Mesh.Define(stage, "/body")
    points = given.vectors(3)
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points))
    counts = [3 + given.below(3) if given.below(64) else given.whole() for _ in range(given.below(MOST))]
    corners = sum(counts) if 0 <= sum(counts) < 6 * MOST else given.below(MOST)
    corners = [given.below(max(len(points), 1)) if given.below(200) else given.whole() for _ in range(corners)]
    mesh.CreateFaceVertexCountsAttr(Vt.IntArray(counts))
    mesh.CreateFaceVertexIndicesAttr(Vt.IntArray(corners))
    mesh.CreateOrientationAttr(given.one_of(("rightHanded", "leftHanded")))
    if given.below(2):
        mesh.CreateHoleIndicesAttr(Vt.IntArray(given.wholes()))
    if given.below(2):
        UsdGeom.Subset.CreateGeomSubset(mesh, "scalp", "face", Vt.IntArray(given.wholes()))
    kinds = ("constant", "uniform", "varying", "vertex", "faceVarying")
    for name, kind, size in (
        ("st", Sdf.ValueTypeNames.TexCoord2fArray, 2),
        ("stiff", Sdf.ValueTypeNames.FloatArray, 1),
        ("displayColor", Sdf.ValueTypeNames.Color3fArray, 3),
        ("flow", Sdf.ValueTypeNames.Vector3fArray, 3),
    ):
        if given.below(2):
            primvar = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar(name, kind, given.one_of(kinds))
            rows = given.vectors(size)
            arrays = {1: Vt.FloatArray, 2: Vt.Vec2fArray, 3: Vt.Vec3fArray}
            primvar.Set(arrays[size].FromNumpy(rows.ravel() if size == 1 else rows))
            if given.below(2):
                primvar.SetIndices(Vt.IntArray(given.wholes()))
    if given.below(2):
        move = mesh.AddTranslateOp()
        for _ in range(given.below(4)):
            move.Set(Gf.Vec3d(*(given.number() for _ in range(3))), given.number())
        mesh.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(given.vectors(3)), given.number())
    if given.below(2):
        stage.SetStartTimeCode(given.number())
        stage.SetEndTimeCode(given.number())
    stage.SetTimeCodesPerSecond(given.number())
    layer.Export(str(path))
    for read in (read_mesh, read_clip, read_bodies):
        allowed(read, path)


TARGETS: dict[str, Callable[[bytes, Path], None]] = {
    target.__name__: target for target in (recipe, shot, hair, obj, usd_curves, usd_mesh)
}


def allowed(read: Callable[[Path], object], path: Path) -> None:
    """Reads a file and accepts a refusal in one line."""
    try:
        read(path)
    except UserError as error:
        assert "\n" not in str(error), error


def try_out(target: Callable[[bytes, Path], None], data: bytes, folder: Path) -> None:
    """Runs a target; every exception but a refusal in one line is a finding."""
    try:
        target(data, folder)
    except UserError as error:
        assert "\n" not in str(error), error
