"""Conversion between numpy arrays and USD values; points, transforms and times of prims."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Usd, UsdGeom, Vt

from ringlet.data.errors import UserError
from ringlet.io.space import check_points

Types = Sdf.ValueTypeNames

# USD type of an array, by dtype and row shape, and the class that converts it without a loop in Python.
_TYPES: dict[tuple[str, tuple[int, ...]], tuple[Sdf.ValueTypeName, Any]] = {
    ("bool", ()): (Types.BoolArray, Vt.BoolArray),
    ("uint8", ()): (Types.UCharArray, Vt.UCharArray),
    ("int32", ()): (Types.IntArray, Vt.IntArray),
    ("int32", (2,)): (Types.Int2Array, Vt.Vec2iArray),
    ("int32", (3,)): (Types.Int3Array, Vt.Vec3iArray),
    ("int32", (4,)): (Types.Int4Array, Vt.Vec4iArray),
    ("uint32", ()): (Types.UIntArray, Vt.UIntArray),
    ("int64", ()): (Types.Int64Array, Vt.Int64Array),
    ("uint64", ()): (Types.UInt64Array, Vt.UInt64Array),
    ("float16", ()): (Types.HalfArray, Vt.HalfArray),
    ("float16", (2,)): (Types.Half2Array, Vt.Vec2hArray),
    ("float16", (3,)): (Types.Half3Array, Vt.Vec3hArray),
    ("float16", (4,)): (Types.Half4Array, Vt.Vec4hArray),
    ("float32", ()): (Types.FloatArray, Vt.FloatArray),
    ("float32", (2,)): (Types.Float2Array, Vt.Vec2fArray),
    ("float32", (3,)): (Types.Float3Array, Vt.Vec3fArray),
    ("float32", (4,)): (Types.Float4Array, Vt.Vec4fArray),
    ("float64", ()): (Types.DoubleArray, Vt.DoubleArray),
    ("float64", (2,)): (Types.Double2Array, Vt.Vec2dArray),
    ("float64", (3,)): (Types.Double3Array, Vt.Vec3dArray),
    ("float64", (4,)): (Types.Double4Array, Vt.Vec4dArray),
    ("float64", (3, 3)): (Types.Matrix3dArray, Vt.Matrix3dArray),
    ("float64", (4, 4)): (Types.Matrix4dArray, Vt.Matrix4dArray),
}

_DIRECTIONS = (Types.Vector3f, Types.Vector3d, Types.Normal3f, Types.Normal3d, Types.Float3, Types.Double3)


def to_usd(values: NDArray) -> tuple[Sdf.ValueTypeName, Any]:
    """USD type and value of an array, one row per element; raises TypeError when there is none."""
    if values.dtype.kind in "USO":
        return Types.StringArray, Vt.StringArray([str(value) for value in values])
    key = (values.dtype.name, values.shape[1:])
    if key not in _TYPES:
        raise TypeError(f"no USD type holds rows of shape {values.shape[1:]} and type {values.dtype}")
    kind, array = _TYPES[key]
    return kind, array.FromNumpy(np.ascontiguousarray(values))


def from_usd(value: Any) -> NDArray:
    """Converts a USD array to numpy."""
    return np.array(list(value)) if isinstance(value, Vt.StringArray | Vt.TokenArray) else np.array(value)


def set_primvar(
    prim: Usd.Prim, name: str, interpolation: str, values: NDArray, kind: Sdf.ValueTypeName | None = None
) -> None:
    """Writes ``primvars:name``; ``kind`` sets a type with a role, such as a colour.

    Rows of numbers that no USD type holds are written one after another, with their length as the ``elementSize``.
    """
    row = 1 if values.ndim != 2 or (values.dtype.name, values.shape[1:]) in _TYPES else values.shape[1]
    own, value = to_usd(values if row == 1 else values.reshape(-1))
    primvar = UsdGeom.PrimvarsAPI(prim).CreatePrimvar(name, kind or own, interpolation)
    primvar.Set(value)
    if row > 1:
        primvar.SetElementSize(row)


def rows(primvar: UsdGeom.Primvar, values: NDArray) -> NDArray:
    """Values of a primvar, one row per element where its ``elementSize`` is more than 1."""
    size = primvar.GetElementSize()
    return values.reshape(-1, size) if size > 1 and values.ndim == 1 and len(values) % size == 0 else values


def read_time(time: Usd.TimeCode, *attributes: Usd.Attribute) -> Usd.TimeCode:
    """Time at which attributes of one prim have values: at rest, the first sample where one has only samples."""
    sampled = (a for a in attributes if time.IsDefault() and a and a.GetNumTimeSamples())
    return Usd.TimeCode.EarliestTime() if any(a.Get(time) is None for a in sampled) else time


def float_primvars(prim: Usd.Prim, time: Usd.TimeCode) -> Iterator[tuple[str, str, NDArray[np.float64]]]:
    """Name, interpolation and values, shape (k,), of every float primvar at a time."""
    for primvar in UsdGeom.PrimvarsAPI(prim).GetPrimvarsWithAuthoredValues():
        kind = primvar.GetTypeName().scalarType
        if kind in (Types.Float, Types.Double, Types.Half):
            yield primvar.GetPrimvarName(), primvar.GetInterpolation(), np.atleast_1d(_flattened(primvar, time))


def vector_primvars(prim: Usd.Prim, time: Usd.TimeCode) -> Iterator[tuple[str, str, NDArray[np.float64]]]:
    """Name, interpolation and values, shape (k, 3), of every vector, normal or float3 primvar at a time."""
    for primvar in UsdGeom.PrimvarsAPI(prim).GetPrimvarsWithAuthoredValues():
        if primvar.GetTypeName().scalarType in _DIRECTIONS:
            yield primvar.GetPrimvarName(), primvar.GetInterpolation(), _flattened(primvar, time).reshape(-1, 3)


def flattened(primvar: UsdGeom.Primvar, time: Usd.TimeCode) -> Any:
    """USD value of a primvar at a time, indices resolved; None without value, and for an index out of range."""
    return primvar.ComputeFlattened(read_time(time, primvar.GetAttr(), primvar.GetIndicesAttr()))


def _flattened(primvar: UsdGeom.Primvar, time: Usd.TimeCode) -> NDArray[np.float64]:
    """Values of a primvar; raises UserError for an index out of range."""
    value = flattened(primvar, time)
    if value is None:
        raise UserError(f"{primvar.GetAttr().GetPath()}: has indices that are not among its values; write it again")
    return np.array(value, np.float64)


def float3(values: NDArray) -> Vt.Vec3fArray:
    """Converts an array of shape (n, 3) to a USD value."""
    return Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(values, np.float32))


def read_points(prim: Usd.Prim, time: Usd.TimeCode, where: str) -> NDArray[np.float64]:
    """Points of a mesh or of curves in local space, shape (n, 3); raises UserError for none or not finite ones."""
    attribute = UsdGeom.PointBased(prim).GetPointsAttr()
    value = attribute.Get(read_time(time, attribute))
    points = triples(value, f"{where}: its points")
    check_points(points, where)
    return points


def triples(value: Any, what: str, dtype: type = np.float64) -> NDArray:
    """Rows of three numbers, shape (n, 3), of a value of USD; empty for None. Raises UserError for another type."""
    rows = np.array(value if value is not None else [], dtype if value is None else None)
    if rows.size and (rows.dtype.kind not in "biuf" or rows.shape[-1] != 3 or rows.ndim > 2):
        raise UserError(f"{what} are no rows of three numbers; export it again")
    return rows.astype(dtype).reshape(-1, 3)


def read_integers(attribute: Usd.Attribute, time: Usd.TimeCode, where: str) -> NDArray[np.int64]:
    """Integers of an attribute at a time, shape (n,); empty for an attribute without value.

    Raises UserError for another type.
    """
    value = attribute.Get(read_time(time, attribute))
    numbers = np.array(value if value is not None else [], np.int64 if value is None else None)
    if numbers.ndim != 1 or (len(numbers) and numbers.dtype.kind not in "iu"):
        raise UserError(f"{where}: {attribute.GetName()} is no list of whole numbers; export it again")
    return numbers.astype(np.int64)


def transformed(points: NDArray[np.float64], prim: Usd.Prim, time: Usd.TimeCode) -> NDArray[np.float64]:
    """Transforms points of a prim to world space, shape (n, 3)."""
    matrix = local_to_world(prim, time)
    return points @ matrix[:3, :3] + matrix[3, :3]


def local_to_world(prim: Usd.Prim, time: Usd.TimeCode) -> NDArray[np.float64]:
    """Local-to-world transform of a prim, for row vectors, shape (4, 4)."""
    return np.array(UsdGeom.XformCache(time).GetLocalToWorldTransform(prim))
