"""Simulated cloth in a cache: an over on the prim of its mesh.

A mesh from another file than the groom's or the head's is referenced under ``/groom/cloths``.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Usd, UsdGeom

from ringlet.data.cache import CachedCloth
from ringlet.data.errors import UserError
from ringlet.io.space import to_metres
from ringlet.io.usd.groom import BODY, GROOM, scalp_source
from ringlet.io.usd.names import identifier
from ringlet.io.usd.place import Place, placed
from ringlet.io.usd.stage import Source, relative

CLOTHS = f"{GROOM}/cloths"


class ClothPrims:
    """Prims of cloths in a stage over a groom.

    groom: stage of the groom, to find the file of the head
    """

    def __init__(self, stage: Usd.Stage, groom: Source) -> None:
        self._stage, self._groom = stage, groom.path
        self._head, scalp = scalp_source(groom)
        self._head_top = Sdf.Path(scalp).GetPrefixes()[0]
        self._tops: dict[tuple[Path, Sdf.Path], Sdf.Path] = {}

    def over(self, cloth: CachedCloth) -> UsdGeom.Mesh:
        """Overrides the prim of a cloth; its points are in the space of the stage."""
        mesh = UsdGeom.Mesh(self._stage.OverridePrim(self._place(cloth)))
        mesh.ClearXformOpOrder()
        mesh.SetResetXformStack(True)
        if mesh.GetNormalsAttr().HasAuthoredValue():
            mesh.GetNormalsAttr().Block()  # normals of the rest shape
        return mesh

    def _place(self, cloth: CachedCloth) -> Sdf.Path:
        if cloth.file is None:
            raise UserError(f"cloth '{cloth.name}': comes from no file; write its mesh as USD and read it from there")
        prim = Sdf.Path(cloth.prim)
        if cloth.file.resolve() == self._groom.resolve():
            return prim
        top = prim.GetPrefixes()[0]
        if cloth.file.resolve() == self._head.resolve() and top == self._head_top:
            return prim.ReplacePrefix(top, Sdf.Path(BODY))
        key = cloth.file.resolve(), top
        if key not in self._tops:
            self._tops[key] = self._reference(cloth.file, top)
        return prim.ReplacePrefix(top, self._tops[key])

    def _reference(self, file: Path, top: Sdf.Path) -> Sdf.Path:
        UsdGeom.Scope.Define(self._stage, CLOTHS)
        place = Sdf.Path(CLOTHS).AppendChild(identifier(file.stem, [path.name for path in self._tops.values()]))
        name = relative(file, self._stage.GetRootLayer().realPath)
        self._stage.DefinePrim(place).GetReferences().AddReference(Sdf.Reference(name, top))
        return place


def set_cloth(
    mesh: UsdGeom.Mesh, frame: float, points: NDArray[np.floating], place: Place, around: NDArray[np.floating]
) -> None:
    """Writes points [m] and their extent at a frame; ``around`` are points of the head [m]."""
    time = Usd.TimeCode(float(frame))
    value = place.local(points, time, around)
    mesh.CreatePointsAttr().Set(value, time)
    mesh.CreateExtentAttr().Set(UsdGeom.PointBased.ComputeExtent(value), time)


def cloth_metadata(cloth: CachedCloth, mesh: UsdGeom.Mesh, folder: Path) -> dict[str, str]:
    """Metadata of a cloth: its name, source file and prim, and its prim in the cache."""
    assert cloth.file is not None
    return {
        "name": cloth.name,
        "file": relative(cloth.file, folder / "cache"),
        "prim": cloth.prim,
        "at": str(mesh.GetPath()),
    }


def read_cloth(source: Source, entry: dict[str, Any], frames: list[float]) -> CachedCloth:
    """Reads a cloth of a cache at some frames.

    entry: metadata of the cloth (``cloth_metadata``)

    Raises UserError when the prim of the cloth is missing.
    """
    prim = source.stage.GetPrimAtPath(entry["at"])
    if not prim:
        raise UserError(
            f"{source.path}: its cloth {entry['at']} is not there; put {entry['file']} back, or simulate again"
        )
    attribute = UsdGeom.PointBased(prim).GetPointsAttr()
    local = [placed(np.array(attribute.Get(frame)), prim, Usd.TimeCode(frame)) for frame in frames]
    points = np.stack([to_metres(points, source.space) for points in local])
    return CachedCloth(entry["name"], source.path.parent / entry["file"], entry["prim"], points)
