"""The head of a stage that also holds hair: a reference to it without the curves."""

from __future__ import annotations

from pathlib import Path

from pxr import Sdf, UsdGeom

from ringlet.io.usd.mesh import select_mesh
from ringlet.io.usd.stage import new_stage, prims, reading, relative, writing

HEAD = "/head"


def write_head(source: Path | str, mesh: str, path: Path | str) -> None:
    """Writes a file that refers to the head of another, with its motion and without its curves.

    mesh: prim of the head in the source; ``head_path`` is its path in the file
    """
    with reading(source) as opened:
        top = opened.stage.GetPrimAtPath(Sdf.Path(mesh).GetPrefixes()[0])
        curves = [prim.GetPath() for prim in prims(top) if UsdGeom.BasisCurves(prim) and not prim.IsInstanceProxy()]
        select_mesh(opened, mesh)
        with writing(path) as aside:
            stage = new_stage(aside, opened.space)
            stage.GetRootLayer().defaultPrim = HEAD[1:]
            if opened.stage.HasAuthoredTimeCodeRange():
                stage.SetStartTimeCode(opened.stage.GetStartTimeCode())
                stage.SetEndTimeCode(opened.stage.GetEndTimeCode())
            stage.DefinePrim(HEAD).GetReferences().AddReference(Sdf.Reference(relative(source, aside), top.GetPath()))
            for curve in curves:
                stage.OverridePrim(head_path(str(curve))).SetActive(False)
            stage.Save()


def head_path(mesh: str) -> str:
    """Path of a prim of the source in the file of its head."""
    path = Sdf.Path(mesh)
    return str(path.ReplacePrefix(path.GetPrefixes()[0], HEAD))
