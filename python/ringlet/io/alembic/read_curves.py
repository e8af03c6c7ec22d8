"""Reads the curves of an archive with their attributes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves, pop_id_halves
from ringlet.data.errors import UserError
from ringlet.data.hair_scene import CurveSet
from ringlet.io.alembic.archive import Archive
from ringlet.io.basis import Sampling


def curve_sets(archive: Archive, schema: Any, above: list[Any], moves: bool) -> Iterator[CurveSet]:
    """The curves of a schema; its guides and its hairs apart, where it has both."""
    where, sample = archive.where(schema), schema.getValue(archive.first())
    counts = np.array(sample.getCurvesNumVertices(), np.int64)
    if len(counts) == 0:  # as valid as a mesh without faces
        return
    controls = archive.placed(schema, above, None)
    if counts.min() < 2 or counts.sum() != len(controls):
        raise UserError(f"{where}: its {len(counts)} curves do not fit its {len(controls)} points; export it again")
    sampling = _sampling(archive, sample, counts, where)

    def motion(frame: float) -> NDArray[np.float64]:
        points = archive.placed(schema, above, frame)
        if points.shape != controls.shape:
            raise UserError(
                f"{where}: has {len(points)} points at frame {frame:g}, {len(controls)} at first; export it with "
                "one topology"
            )
        return sampling.vertex(points)

    ids = np.arange(len(counts), dtype=np.int64)
    curves = Curves(sampling.vertex(controls), sampling.offsets, ids)
    for name, values, scope in _attributes(archive, schema):
        _add(curves, sampling, name, values, scope, where)
    _tell_unread(archive, schema, sample, curves, moves)
    rest = curves.point.pop("rest", None)
    if rest is not None and rest.shape == curves.points.shape and np.isfinite(rest).all():
        curves.points = archive.in_world(rest.astype(np.float64), above, None)
    if not curves.curve.get("groom_group_id", np.ones(1)).any():  # one group
        del curves.curve["groom_group_id"]
    root_uv = curves.curve.pop("groom_root_uv", None)
    if root_uv is not None and root_uv.shape == (len(ids), 2):
        curves.curve["st"] = root_uv.astype(np.float32)
    named = curves.curve.get("groom_id", ids)
    if named.dtype.kind in "iu" and len(np.unique(named)) == len(ids):
        curves.ids = named.astype(np.int64)
    exact = pop_id_halves(curves.curve)
    curves.ids = curves.ids if exact is None else exact
    curves.check(where)
    yield from CurveSet(archive.name(schema), curves, motion=motion if moves else None).apart()


def _sampling(archive: Archive, sample: Any, counts: NDArray[np.int64], where: str) -> Sampling:
    """How points on the curves come from their control points."""
    geom = archive.library.geom
    basis = {
        geom.BasisType.kBezierBasis: "bezier",
        geom.BasisType.kBsplineBasis: "bspline",
        geom.BasisType.kCatmullromBasis: "catmullRom",
    }.get(sample.getBasis())
    linear = sample.getType() != geom.CurveType.kCubic or basis is None
    periodic = sample.getWrap() == geom.CurvePeriodicity.kPeriodic
    wrap = "periodic" if periodic else "nonperiodic"
    return Sampling("linear" if linear else "cubic", basis or "", wrap, counts, where)


def _attributes(archive: Archive, schema: Any) -> Iterator[tuple[str, NDArray, str]]:
    """Names, values and scopes of widths and of arbitrary parameters, of types that attributes have."""
    geom = archive.library.geom
    if (widths := schema.getWidthsParam()).valid():
        yield "width", archive.values(widths) * np.float32(archive.space.meters_per_unit), str(widths.getScope())
    if (uvs := schema.getUVsParam()).valid():
        yield "st", archive.values(uvs), str(uvs.getScope())
    parameters = schema.getArbGeomParams()
    if not parameters.valid():
        return
    kinds = (
        geom.IFloatGeomParam,
        geom.IInt32GeomParam,
        geom.IInt16GeomParam,
        geom.IV2fGeomParam,
        geom.IV3fGeomParam,
        geom.IC3fGeomParam,
        geom.IV2iGeomParam,
        geom.IV3iGeomParam,
    )
    for header in (parameters.getPropertyHeader(k) for k in range(parameters.getNumProperties())):
        for kind in kinds:
            if kind.matches(header):
                parameter = kind(parameters, header.getName())
                yield header.getName(), archive.values(parameter), str(parameter.getScope())
                break


def _add(curves: Curves, sampling: Sampling, name: str, values: NDArray, scope: str, where: str) -> None:
    """Stores an attribute; raises UserError for a width without a value for each curve or point."""
    if scope == "kConstantScope" and len(values) == 1:
        curves.curve[name] = np.repeat(values, len(curves), axis=0)
    elif len(values) == len(curves) and scope != "kVertexScope":
        curves.curve[name] = values
    elif len(values) == sampling.offsets_in[-1]:
        curves.point[name] = sampling.vertex(values)
    elif name == "width":
        raise UserError(
            f"{where}: has {len(values)} widths for {len(curves)} curves and {sampling.offsets_in[-1]} points; "
            "export it again"
        )


def _tell_unread(archive: Archive, schema: Any, sample: Any, curves: Curves, moves: bool) -> None:
    """Notes what curves of the archive have and those that are read have not."""
    unheld = archive.parameters(schema) - {*curves.curve, *curves.point}
    lost = [f"{', '.join(sorted(unheld))} have no type or length of attributes of curves"] if unheld else []
    if schema.getNormalsParam().valid():
        lost.append("its normals are not used, since hairs are round")
    if schema.getVelocitiesProperty().valid() and not moves:
        lost.append("its velocities are not read; the motion is that of its points")
    if sample.getType() == archive.library.geom.CurveType.kVariableOrder:
        lost.append("its curves are NURBS, read as lines through their control points")
    archive.unread += [f"{archive.name(schema)}: {one}" for one in lost]
