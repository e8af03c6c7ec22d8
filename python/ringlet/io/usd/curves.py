"""Reads USD curves of every type, basis and wrap; writes Ringlet's own curves and reads them back.

Ringlet writes pinned Catmull-Rom curves, whose vertices are the points of the polyline. Attributes of Ringlet are
primvars ``ringlet:…`` in SI units, Y-up. Those of 64 bits are attributes ``ringlet:…``, a value a curve: Blender warns
of such primvars in each frame. Attributes of drawn guides keep their names.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Usd, UsdGeom, Vt

from ringlet.data.curves import ID_HALVES, Curves, id_halves, offsets_from_counts, pop_id_halves
from ringlet.data.errors import UserError
from ringlet.data.former_names import ATTRIBUTES
from ringlet.data.groom import GROOM
from ringlet.data.mesh import Mesh
from ringlet.data.pigment import DYE, FIBER, curve_reflectance, display_color
from ringlet.data.stage import StageSpace
from ringlet.io.basis import Sampling
from ringlet.io.space import to_metres
from ringlet.io.usd.model import CURVES_API
from ringlet.io.usd.names import identifier, keep_name, original_name
from ringlet.io.usd.place import Place, placed
from ringlet.io.usd.pose import posed_points, rest_time
from ringlet.io.usd.stage import Source, choose, find_prim, prims, reading
from ringlet.io.usd.surfaces import filled
from ringlet.io.usd.values import (
    Types,
    flattened,
    from_usd,
    local_to_world,
    read_integers,
    read_time,
    rows,
    set_primvar,
    to_usd,
    transformed,
    triples,
)

OWN = "ringlet:"
ID_NAMES = ("ringlet:id", "groom_id", "id", "hair_id", "hairid", "curve_id")
# Names with a meaning in the schema or in other programs; attributes of Ringlet with these names get a prefix.
COMMON = {"rest", "skinprim", "skinprimuv", "st", "surface_uv_coordinate", "guide_curve_index", "clumpid", *ID_HALVES}
COMMON |= {"groom_id", "groom_group_id", "groom_guide", "groom_root_uv", "groom_color"}
COMMON |= {"displayColor", "displayOpacity"}
INNER = {"root_triangle", "root_barycentric", "lock", "guide_id", "pin", "tied", GROOM}
INNER |= {"groomed", "stiffened", "off", "moving"}
WIDE = ("int64", "float64")  # types of Ringlet's own attributes that are no primvars
CONSTANT = {DYE, *FIBER}  # attributes of curves that are written once where all curves have the same
MOST_WIDTH = 1.0  # largest diameter of a curve that is written [m]
SCHEMA = {"widths", "normals"}  # primvars that take precedence over the attribute of the same name
HAIR_WIDTH = 70e-6  # default diameter of a hair [m]


def read_usd_curves(path: Path | str, prim: str | None = None, notes: list[str] | None = None) -> Curves:
    """Reads a ``BasisCurves`` prim in its rest pose as polylines [m]; by default the only one.

    notes: receives a sentence for each thing in the prim that is not used
    """
    with reading(path) as source:
        root = source.stage.GetPseudoRoot() if prim is None else find_prim(source, prim)
        found = filled(p for p in prims(root) if UsdGeom.BasisCurves(p))
        chosen = choose(source, found, "BasisCurves")
        if notes is not None:
            notes += unused(source, chosen)
        return curves_at(source, chosen, rest_time(source, chosen))


def curves_at(source: Source, prim: Usd.Prim, time: Usd.TimeCode, unread: list[str] | None = None) -> Curves:
    """Polylines of a curves prim at a time [m], with its primvars as attributes.

    unread: receives the names of primvars of types and lengths that no attribute has
    """
    where = source.where(prim)
    vertices, sampling = _sampled(source, prim, time)
    ids = np.arange(len(sampling.offsets) - 1, dtype=np.int64)
    curves = Curves(sampling.vertex(vertices), sampling.offsets, ids)

    for primvar in UsdGeom.PrimvarsAPI(prim).GetPrimvarsWithAuthoredValues():
        name = primvar.GetPrimvarName().removeprefix(OWN)
        if name in SCHEMA:
            continue
        values = rows(primvar, np.atleast_1d(from_usd(flattened(primvar, time))))
        if values.dtype.kind not in "bifuSU":
            continue
        if primvar.GetTypeName().role == Sdf.ValueRoleNames.Point:
            values = to_metres(transformed(np.asarray(values, np.float64), prim, time), source.space)
        _add(curves, sampling, name, values, primvar.GetInterpolation(), f"{where}: {primvar.GetName()}")
    for name, values in wide_attributes(prim).items():
        _add(curves, sampling, name, values, UsdGeom.Tokens.uniform, f"{where}: {OWN}{name}")
    if unread is not None:
        api, held = UsdGeom.PrimvarsAPI(prim), {*curves.curve, *curves.point, *SCHEMA}
        names = [primvar.GetPrimvarName().removeprefix(OWN) for primvar in api.GetPrimvarsWithAuthoredValues()]
        unread += [name for name in names if name not in held]
    _add_widths(curves, sampling, source, prim, time)
    _assign_ids(curves)
    return curves.check(where)


def points_at(source: Source, prim: Usd.Prim, time: Usd.TimeCode) -> NDArray[np.float64]:
    """Points of the polylines of a curves prim at a time [m], shape (n, 3)."""
    vertices, sampling = _sampled(source, prim, time)
    return sampling.vertex(vertices)


def _sampled(source: Source, prim: Usd.Prim, time: Usd.TimeCode) -> tuple[NDArray[np.float64], Sampling]:
    """Vertices of a curves prim at a time [m], and their interpolation."""
    where = source.where(prim)
    vertices = posed_points(source, prim, time, where)
    counts = _counts(prim, time, len(vertices), where)
    Curves(vertices, offsets_from_counts(counts), np.arange(len(counts), dtype=np.int64)).check(where)
    schema = UsdGeom.BasisCurves(prim)
    kind, basis, wrap = (
        attribute.Get(time) for attribute in (schema.GetTypeAttr(), schema.GetBasisAttr(), schema.GetWrapAttr())
    )
    return vertices, Sampling(kind, basis, wrap, counts, where)


def own_curves(source: Source, prim: Usd.Prim, time: Usd.TimeCode | None = None, dtype: type = np.float64) -> Curves:
    """Reads curves that Ringlet wrote, at rest or at a time.

    Raises UserError when ids or widths are missing.
    """
    where, time = source.where(prim), time or Usd.TimeCode.Default()
    value = UsdGeom.PointBased(prim).GetPointsAttr().Get(time)
    local = triples(value, f"{where}: its points", dtype)
    points = to_metres(placed(local, prim, time), source.space)
    counts = _counts(prim, time, len(points), where)
    ids = own_ids(prim)
    if len(ids) != len(counts):
        raise UserError(f"{where}: has no ringlet:id for each of its {len(counts)} curves; write the file again")
    curves = Curves(points, offsets_from_counts(counts), ids)
    add_own_attributes(curves, prim, where)
    schema = UsdGeom.BasisCurves(prim)
    if schema.GetWidthsInterpolation() == UsdGeom.Tokens.vertex and "width" not in curves.curve:
        widths = np.array(schema.GetWidthsAttr().Get() or [], np.float32)
        if len(widths) != len(points):
            raise UserError(f"{where}: has {len(widths)} widths for {len(points)} points; write the file again")
        curves.point["width"] = widths * np.float32(source.space.meters_per_unit)
    return curves


def own_ids(prim: Usd.Prim) -> NDArray[np.int64]:
    """Ids of Ringlet's curves on a prim; empty where it has none. Files of earlier versions have them as a primvar."""
    attribute = prim.GetAttribute(f"{OWN}id") or prim.GetAttribute(f"primvars:{OWN}id")
    return np.array((attribute.Get() if attribute else None) or [], np.int64)


def wide_attributes(prim: Usd.Prim) -> dict[str, NDArray]:
    """Ringlet's own attributes of curves that are no primvars, by name."""
    found = [one for one in prim.GetAuthoredPropertiesInNamespace(OWN.rstrip(":")) if isinstance(one, Usd.Attribute)]
    values = {one.GetName().removeprefix(OWN): from_usd(one.Get()) for one in found if one.GetTypeName().isArray}
    return {name: value for name, value in values.items() if value.dtype.name in WIDE}


def add_own_attributes(curves: Curves, prim: Usd.Prim, where: str, skipped: tuple[str, ...] = ()) -> None:
    """Adds the attributes of Ringlet's curves on a prim, but those whose primvar begins with one of ``skipped``.

    Raises UserError for a wrong number of values.
    """
    for primvar in UsdGeom.PrimvarsAPI(prim).GetPrimvarsWithAuthoredValues():
        name = primvar.GetPrimvarName()
        if name not in (f"{OWN}id", *COMMON) and not name.startswith(skipped):
            own = original_name(primvar.GetAttr(), name.removeprefix(OWN))
            _add_own(curves, primvar, ATTRIBUTES.get(own, own), where)
    for name, values in wide_attributes(prim).items():
        if name != "id":
            curves.curve[name] = _checked(values, len(curves), f"{where}: {OWN}{name}", UsdGeom.Tokens.uniform)


def define_curves(
    stage: Usd.Stage, path: str, curves: Curves, space: StageSpace, *, guide: bool
) -> UsdGeom.BasisCurves:
    """Defines curves at a prim path without their points: type, counts, widths, ids and attributes."""
    defined = UsdGeom.BasisCurves.Define(stage, path)
    defined.CreateTypeAttr(UsdGeom.Tokens.cubic)
    defined.CreateBasisAttr(UsdGeom.Tokens.catmullRom)
    defined.CreateWrapAttr(UsdGeom.Tokens.pinned)
    defined.CreatePurposeAttr(UsdGeom.Tokens.guide if guide else UsdGeom.Tokens.default_)
    defined.CreateCurveVertexCountsAttr(Vt.IntArray.FromNumpy(curves.counts))
    has_width = {"width"} & (curves.point.keys() | curves.curve.keys())
    diameters = curve_widths(curves) if has_width else np.array([HAIR_WIDTH])
    if not ((diameters >= 0.0) & (diameters <= MOST_WIDTH)).all():  # also true for NaN
        raise UserError(
            f"{path}: widths are from {diameters.min():.4g} to {diameters.max():.4g} m; must be from 0 to "
            f"{MOST_WIDTH:g} m"
        )
    widths = diameters / space.meters_per_unit
    defined.CreateWidthsAttr(Vt.FloatArray.FromNumpy(np.ascontiguousarray(widths, np.float32)))
    defined.SetWidthsInterpolation(UsdGeom.Tokens.vertex if has_width else UsdGeom.Tokens.constant)

    prim = defined.GetPrim()
    prim.AddAppliedSchema(CURVES_API)
    set_attribute(prim, "id", "uniform", curves.ids)
    for interpolation, attributes in (("uniform", curves.curve), ("vertex", curves.point)):
        expected = len(curves) if interpolation == "uniform" else int(curves.offsets[-1])
        for name, values in attributes.items():
            if len(values) != expected:
                raise UserError(f"{path}: {name} has {len(values)} values; must have {expected}, being {interpolation}")
            if interpolation == "uniform" or name != "width":  # the width of points is in ``widths``
                set_attribute(prim, name, interpolation, values)
    fits = np.abs(curves.ids).max(initial=0) < 2**31
    set_primvar(prim, "groom_id", "uniform", (curves.ids if fits else np.arange(len(curves))).astype(np.int32))
    for name, half in id_halves(curves.ids).items():
        set_primvar(prim, name, "uniform", half)
    set_primvar(prim, "groom_group_id", "uniform", curves.curve.get(GROOM, np.zeros(len(curves), np.int32)))
    set_primvar(prim, "groom_guide", "uniform", np.full(len(curves), guide, np.int32))
    return defined


def set_attribute(prim: Usd.Prim, name: str, interpolation: str, values: NDArray) -> None:
    """Writes an attribute of curves as a primvar whose name USD accepts; one of Ringlet of 64 bits as an attribute."""
    valid = f"primvars:{name}"
    if Sdf.Path.IsValidNamespacedIdentifier(valid) and UsdGeom.Primvar.IsValidPrimvarName(valid):
        if name in CONSTANT and len(values) and (values == values[0]).all():
            kind = Types.Color3fArray if name == DYE and values.shape[1:] == (3,) else None
            set_primvar(prim, name, "constant", values[:1], kind)
            return
        own = name in COMMON | INNER | SCHEMA | {"id", "width"}
        if own and interpolation == "uniform" and values.dtype.name in WIDE:
            kind, value = to_usd(values)
            prim.CreateAttribute(OWN + name, kind, custom=False).Set(value)
            return
        set_primvar(prim, OWN + name if own else name, interpolation, values)
        return
    given = UsdGeom.PrimvarsAPI(prim).GetPrimvarsWithAuthoredValues()
    taken = [primvar.GetPrimvarName().removeprefix(OWN) for primvar in given]
    stored = OWN + identifier(name, taken)
    set_primvar(prim, stored, interpolation, values)
    keep_name(UsdGeom.PrimvarsAPI(prim).GetPrimvar(stored).GetAttr(), name)


def set_points(
    curves: UsdGeom.BasisCurves, points: NDArray, place: Place, time: Usd.TimeCode, around: NDArray | None = None
) -> Vt.Vec3fArray:
    """Writes points [m] and their extent at a time; ``around`` as for ``Place.local``. Returns the value."""
    value = place.local(points, time, around)
    curves.CreatePointsAttr().Set(value, time)
    curves.CreateExtentAttr().Set(UsdGeom.Curves.ComputeExtent(value, curves.GetWidthsAttr().Get()), time)
    return value


def set_rest(curves: UsdGeom.PointBased, value: Vt.Vec3fArray) -> None:
    """Writes the rest pose, in the space of the prim, as the primvar of Houdini and of hair materials."""
    UsdGeom.PrimvarsAPI(curves).CreatePrimvar("rest", Types.Point3fArray, "vertex").Set(value)


def set_roots(prim: Usd.Prim, curves: Curves, scalp: Mesh) -> None:
    """Writes the positions of roots on the scalp as primvars of Houdini, Blender, Unreal and renderers.

    Needs the curve attributes ``root_triangle`` and ``root_barycentric``; writes nothing without them.
    """
    if not {"root_triangle", "root_barycentric"} <= curves.curve.keys():
        return
    triangle, weights = curves.curve["root_triangle"], curves.curve["root_barycentric"]
    if scalp.faces is not None and scalp.places is not None:
        set_primvar(prim, "skinprim", "uniform", scalp.faces[triangle].astype(np.int32))
        place = np.einsum("nk,nkd->nd", weights, scalp.places[triangle]).astype(np.float32)
        set_primvar(prim, "skinprimuv", "uniform", place, Types.TexCoord2fArray)
    if scalp.uv is not None:
        uv = np.einsum("nk,nkd->nd", weights, scalp.uv[triangle]).astype(np.float32)
        set_primvar(prim, "st", "uniform", uv, Types.TexCoord2fArray)
        set_primvar(prim, "surface_uv_coordinate", "uniform", uv)
        set_primvar(prim, "groom_root_uv", "uniform", uv)


def set_display_color(prim: Usd.Prim, curves: Curves) -> bool:
    """Writes the colour of curves by their pigments as ``displayColor``; returns whether they have any."""
    colors = curve_reflectance(curves, str(prim.GetPath()))
    if colors is None:
        return False
    interpolation = "uniform" if len(colors) == len(curves) else "vertex"
    set_primvar(prim, "displayColor", interpolation, display_color(colors).astype(np.float32), Types.Color3fArray)
    return True


def curve_widths(curves: Curves) -> NDArray:
    """Diameters [m], shape (points,)."""
    if "width" in curves.point:
        return curves.point["width"]
    return np.repeat(curves.curve.get("width", np.full(len(curves), HAIR_WIDTH)), curves.counts).astype(np.float32)


def _counts(prim: Usd.Prim, time: Usd.TimeCode, points: int, where: str) -> NDArray[np.int64]:
    """Vertices per curve, shape (count,); raises UserError for counts that do not fit the points."""
    counts = read_integers(UsdGeom.Curves(prim).GetCurveVertexCountsAttr(), time, where)
    if len(counts) == 0:
        raise UserError(f"{where}: there are no curves; give at least one")
    if counts.min() < 2:
        raise UserError(f"{where}: curve {counts.argmin()} has {counts.min()} point(s); must have at least 2")
    if counts.sum() != points:
        raise UserError(
            f"{where}: curveVertexCounts add up to {counts.sum()}, but there are {points} points; export it again"
        )
    return counts


def _add_widths(curves: Curves, sampling: Sampling, source: Source, prim: Usd.Prim, time: Usd.TimeCode) -> None:
    """Stores the diameters of curves [m]; ``primvars:widths`` has precedence over ``widths``, as in USD.

    Diameters are scaled with the points; under a transform that is not uniform, by the cube root of its volume.
    """
    primvar, schema = UsdGeom.PrimvarsAPI(prim).GetPrimvar("widths"), UsdGeom.BasisCurves(prim)
    if primvar.HasAuthoredValue():
        name, value, interpolation = primvar.GetName(), flattened(primvar, time), primvar.GetInterpolation()
    else:
        attribute = schema.GetWidthsAttr()
        name, value = attribute.GetName(), attribute.Get(read_time(time, attribute))
        interpolation = schema.GetWidthsInterpolation()
    if value is None or not len(value):
        return
    where = f"{source.where(prim)}: {name}"
    if interpolation == UsdGeom.Tokens.constant and len(value) != 1:
        raise UserError(f"{where} has {len(value)} values; must have 1, being constant")
    scale = np.cbrt(abs(np.linalg.det(local_to_world(prim, time)[:3, :3]))) * source.space.meters_per_unit
    _add(curves, sampling, "width", np.array(value, np.float64) * scale, interpolation, where)


def unused(source: Source, prim: Usd.Prim) -> list[str]:
    """A sentence for each thing in a prim of curves that is not used."""
    where, schema, notes = source.where(prim), UsdGeom.BasisCurves(prim), list[str]()
    normals = schema.GetNormalsAttr(), UsdGeom.PrimvarsAPI(prim).GetPrimvar("normals")
    if used := next((one for one in normals if one and one.HasAuthoredValue()), None):
        notes.append(f"{where}: its {used.GetName()} are not used, since hairs are round")
    counts = schema.GetCurveVertexCountsAttr()
    if len({tuple(counts.Get(time)) for time in counts.GetTimeSamples()}) > 1:
        notes.append(f"{where}: its curveVertexCounts change over time; the curves are read in their rest pose")
    return notes


def _add(curves: Curves, sampling: Sampling, name: str, values: NDArray, interpolation: str, what: str) -> None:
    """Stores a primvar as an attribute of curves or of points; raises UserError for a wrong number of values."""
    expected = {
        UsdGeom.Tokens.constant: 1,
        UsdGeom.Tokens.uniform: len(curves),
        UsdGeom.Tokens.varying: int((sampling.segments + 1).sum()),
    }.get(interpolation, int(sampling.offsets_in[-1]))
    if len(values) != expected:
        if interpolation == UsdGeom.Tokens.constant:
            return  # an array on the whole prim
        raise UserError(f"{what} has {len(values)} values; must have {expected}, being {interpolation}")
    if interpolation == UsdGeom.Tokens.constant:
        curves.curve[name] = np.repeat(values, len(curves), axis=0)
    elif interpolation == UsdGeom.Tokens.uniform:
        curves.curve[name] = values
    elif values.dtype.kind in "bifu":
        curves.point[name] = (
            sampling.varying(values) if interpolation == UsdGeom.Tokens.varying else sampling.vertex(values)
        )


def _add_own(curves: Curves, primvar: UsdGeom.Primvar, name: str, where: str) -> None:
    """Stores a primvar of Ringlet's curves as an attribute; raises UserError for a wrong number of values."""
    values, interpolation = np.atleast_1d(from_usd(primvar.ComputeFlattened())), primvar.GetInterpolation()
    values = rows(primvar, values)
    if values.dtype.kind not in "bifuSU":
        return
    per_curve = interpolation in (UsdGeom.Tokens.constant, UsdGeom.Tokens.uniform)
    expected = len(curves) if per_curve else len(curves.points)
    if interpolation == UsdGeom.Tokens.constant:
        if len(values) != 1:
            return  # an array on the whole prim
        values = np.repeat(values, expected, axis=0)
    what = f"{where}: {primvar.GetPrimvarName()}"
    (curves.curve if per_curve else curves.point)[name] = _checked(values, expected, what, interpolation)


def _checked(values: NDArray, expected: int, what: str, interpolation: str) -> NDArray:
    """Values of Ringlet's curves; raises UserError where there are not as many as expected."""
    if len(values) != expected:
        raise UserError(
            f"{what} has {len(values)} values; must have {expected}, being {interpolation}: one for each curve or "
            "point; write it again"
        )
    return values


def _assign_ids(curves: Curves) -> None:
    """Sets the ids of curves from the first attribute of ``ID_NAMES`` with unique integers."""
    ids = pop_id_halves(curves.curve)
    if "id" not in curves.curve and ids is not None:
        curves.curve["id"] = ids
    for name in (full_name.removeprefix(OWN) for full_name in ID_NAMES):
        ids = curves.curve.get(name)
        if ids is not None and ids.dtype.kind in "iu" and ids.ndim == 1 and len(np.unique(ids)) == len(ids):
            curves.ids = curves.curve.pop(name).astype(np.int64)
            return
