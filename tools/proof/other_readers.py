"""Hair files as other libraries read them: the judges of what Ringlet writes. Nothing here is Ringlet's.

USD is read by OpenUSD, Alembic by alembic3d, OBJ by tinyobjloader. No library on the package index reads ``.hair`` and
``.tfx``: these are read by their published layouts, http://www.cemyuksel.com/research/hairmodels/ and
``TressFXFileFormat.h``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray


@dataclass
class Found:
    """What is in a file, in its own unit and axes; arrays that it lacks are missing or None.

    points: at rest, shape (n, 3)
    later:  at the second frame; None for curves that stand still
    guides: number of curves that are guides, apart from the others
    head:   points of the mesh
    curve:  attributes with a value a curve, ids among them
    point:  attributes with a value a point
    space:  metres of a unit, and the up-axis
    """

    points: NDArray
    counts: list[int]
    later: NDArray | None = None
    guides: int = 0
    head: NDArray | None = None
    curve: dict[str, NDArray] = field(default_factory=dict)
    point: dict[str, NDArray] = field(default_factory=dict)
    space: tuple[float, str] | None = None


def read_usd(path: Path) -> Found:
    """By OpenUSD: primvars by their interpolation."""
    from pxr import Usd, UsdGeom

    stage = Usd.Stage.Open(str(path))
    curves = {str(prim.GetName()): UsdGeom.BasisCurves(prim) for prim in stage.Traverse() if prim.IsA("BasisCurves")}
    (mesh,) = (UsdGeom.Mesh(prim) for prim in stage.Traverse() if prim.IsA("Mesh"))
    hairs = curves.pop("hairs")
    times = hairs.GetPointsAttr().GetTimeSamples()
    found = Found(
        np.array(hairs.GetPointsAttr().Get()),
        list(hairs.GetCurveVertexCountsAttr().Get()),
        np.array(hairs.GetPointsAttr().Get(times[-1])) if len(times) == 2 else None,
        sum(
            len(one.GetCurveVertexCountsAttr().Get())
            for one in curves.values()
            if one.GetPurposeAttr().Get() == "guide"
        ),
        np.array(mesh.GetPointsAttr().Get()),
        space=(UsdGeom.GetStageMetersPerUnit(stage), str(UsdGeom.GetStageUpAxis(stage))),
    )
    found.point["width"] = np.array(hairs.GetWidthsAttr().Get())
    for primvar in UsdGeom.PrimvarsAPI(hairs).GetPrimvars():
        scope = {"uniform": found.curve, "vertex": found.point}.get(primvar.GetInterpolation())
        if scope is not None:
            scope[primvar.GetPrimvarName()] = np.array(primvar.Get())
    ids = hairs.GetPrim().GetAttribute("ringlet:id").Get()
    return found if ids is None else _with(found, "id", np.array(ids))


def read_alembic(path: Path) -> Found:
    """By alembic3d: geometry parameters by their scope; the rest pose is the parameter ``rest``."""
    from alembic3d import Abc, AbcGeom  # pyright: ignore[reportMissingImports]

    def shapes(parent):
        for child in (parent.getChild(k) for k in range(parent.getNumChildren())):
            yield child
            yield from shapes(child)

    archive = Abc.IArchive(str(path))
    wrap, found = Abc.WrapExistingFlag.kWrapExisting, Found(np.empty((0, 3)), [])
    for shape in shapes(archive.getTop()):
        if AbcGeom.IPolyMesh.matches(shape.getMetaData()):
            found.head = _array(AbcGeom.IPolyMesh(shape, wrap).getSchema().getValue().getPositions())
        if not AbcGeom.ICurves.matches(shape.getMetaData()):
            continue
        schema = AbcGeom.ICurves(shape, wrap).getSchema()
        samples = [schema.getValue(Abc.ISampleSelector(k)) for k in range(schema.getNumSamples())]
        if shape.getName() == "guidesShape":
            found.guides = samples[0].getNumCurves()
            continue
        found.counts = _array(samples[0].getCurvesNumVertices()).tolist()
        found.later = _array(samples[-1].getPositions()) if len(samples) == 2 else None
        found.point["width"] = _array(schema.getWidthsParam().getExpandedValue().getVals())
        found.curve["st"] = _array(schema.getUVsParam().getExpandedValue().getVals())
        parameters = schema.getArbGeomParams()
        for k in range(parameters.getNumProperties()):
            header = parameters.getPropertyHeader(k)
            for kind in ("Float", "Int32", "V2f", "V3f", "C3f", "V3i"):
                typed = getattr(AbcGeom, f"I{kind}GeomParam")
                if typed.matches(header):
                    one = typed(parameters, header.getName())
                    scope = found.point if str(one.getScope()) == "kVertexScope" else found.curve
                    scope[header.getName()] = _array(one.getExpandedValue().getVals())
    found.points = found.point["rest"]
    del archive
    return found if "groom_id" not in found.curve else _with(found, "id", found.curve["groom_id"])


def read_hair(path: Path) -> Found:
    """By the layout of Cem Yuksel's page: a header of 128 bytes, then the arrays whose bits are set."""
    data = path.read_bytes()
    hairs, points, bits = (int(one) for one in np.frombuffer(data, "<u4", 3, 4))
    place, arrays = 128, list[NDArray | None]()
    for bit, (kind, count) in enumerate(
        (("<u2", hairs), ("<f4", 3 * points), *(2 * [("<f4", points)]), ("<f4", 3 * points))
    ):
        there = bits >> bit & 1
        arrays.append(np.frombuffer(data, kind, count, place) if there else None)
        place += there * count * np.dtype(kind).itemsize
    segments, positions, thickness, _, colors = arrays
    assert segments is not None and positions is not None
    found = Found(positions.reshape(-1, 3), (segments.astype(int) + 1).tolist())
    found.point = {name: one for name, one in (("width", thickness), ("color", colors)) if one is not None}
    if colors is not None:
        found.point["color"] = colors.reshape(-1, 3)
    return found


def read_tfx(path: Path) -> Found:
    """By the struct ``TressFXFileHeader``: numbers of strands and points, then the places of the arrays."""
    data = path.read_bytes()
    strands, each, positions, root_uv, _, thickness, _ = (int(one) for one in np.frombuffer(data, "<u4", 7, 4))
    found = Found(np.frombuffer(data, "<f4", 4 * strands * each, positions).reshape(-1, 4)[:, :3], strands * [each])
    if thickness:
        found.curve["width"] = np.frombuffer(data, "<f4", strands, thickness)
    if root_uv:
        found.curve["st"] = np.frombuffer(data, "<f4", 2 * strands, root_uv).reshape(-1, 2)
    return found


def read_obj(path: Path) -> Found:
    """By tinyobjloader: lines of all shapes."""
    import tinyobjloader  # pyright: ignore[reportMissingImports]

    reader = tinyobjloader.ObjReader()
    assert reader.ParseFromFile(str(path)), reader.Error()
    points = np.array(reader.GetAttrib().vertices).reshape(-1, 3)
    lines = [shape.lines for shape in reader.GetShapes()]
    rows = [index.vertex_index for line in lines for index in line.indices]
    return Found(points[rows], [int(count) for line in lines for count in line.num_line_vertices])


READERS: dict[str, Callable[[Path], Found]] = {
    ".usdc": read_usd,
    ".abc": read_alembic,
    ".hair": read_hair,
    ".tfx": read_tfx,
    ".obj": read_obj,
}


def _with(found: Found, name: str, values: NDArray) -> Found:
    found.curve[name] = values
    return found


def _array(values) -> NDArray:
    """Values of Alembic as an array."""
    try:
        return np.array(memoryview(values))
    except TypeError:
        return np.array([tuple(row) for row in values])
