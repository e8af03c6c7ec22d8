"""Curves objects of Blender: written from arrays, and read as arrays."""

from __future__ import annotations

from collections.abc import Mapping

import bpy
import numpy as np
from mathutils import Matrix

from .refused import Refused

# Of attributes, by the shape of a value: the type, and what it is called in there.
KINDS = {
    (): ("FLOAT", "value"),
    (2,): ("FLOAT2", "vector"),
    (3,): ("FLOAT_VECTOR", "vector"),
    (4, 4): ("FLOAT4X4", "value"),
}
MOST_SUBDIVISIONS = 3  # of curves in the viewport
ID_HALVES = ("id_high", "id_low")  # Blender has no attributes of 64-bit integers


def set_curves(data: bpy.types.Curves, arrays: Mapping[str, np.ndarray]) -> None:
    """Gives curves other points and attributes: ``points``, ``counts``, ``ids``, and values of points or curves."""
    counts = arrays["counts"]
    if not np.array_equal(counts, counts_of(data)):
        if len(data.curves):
            data.remove_curves()
        data.add_curves(counts.tolist())
    data.attributes["position"].data.foreach_set("vector", np.ascontiguousarray(arrays["points"], np.float32).ravel())
    if "ids" in arrays:
        ids = arrays["ids"].astype(np.int64)
        for name, half in zip(ID_HALVES, (ids >> 32, ids & 0xFFFFFFFF), strict=True):
            set_attribute(data, name, half.astype(np.uint32).view(np.int32), "CURVE")
    for name, values in arrays.items():
        if name not in ("points", "counts", "ids"):
            rows = "CURVE" if len(values) == len(counts) else "POINT"
            set_attribute(data, "surface_uv_coordinate" if name == "uv" else name, values, rows)
    data.update_tag()


def draw_curls(scene: bpy.types.Scene) -> None:
    """Lets the viewport draw so many points of each curve that curls are seen: by default it draws few, evenly spaced,
    and curls look straight."""
    scene.render.hair_subdiv = MOST_SUBDIVISIONS


def set_attribute(data: bpy.types.Curves, name: str, values: np.ndarray, domain: str) -> None:
    """Writes an attribute; one of another type or domain is replaced."""
    kind, key = ("INT", "value") if values.dtype.kind == "i" else KINDS[values.shape[1:]]
    found = data.attributes.get(name)
    if found is not None and (found.data_type, found.domain) != (kind, domain):
        data.attributes.remove(found)
        found = None
    found = found or data.attributes.new(name, kind, domain)
    found.data.foreach_set(key, np.ascontiguousarray(values).ravel())


def counts_of(data: bpy.types.Curves) -> np.ndarray:
    """Points of each curve, shape (curves,)."""
    counts = np.empty(len(data.curves), np.int32)
    if len(counts):
        data.curves.foreach_get("points_length", counts)
    return counts


def read_curves(thing: bpy.types.Object, matrix: Matrix) -> dict[str, np.ndarray]:
    """Curves transformed by a matrix: ``points`` (n, 3), ``counts`` and ``ids``."""
    data = thing.data
    counts = counts_of(data)
    if not len(counts):
        raise Refused(f"{thing.name}: has no curves; draw some, or take it out of the panel")
    points = np.empty(3 * len(data.points), np.float32)
    data.attributes["position"].data.foreach_get("vector", points)
    placed = np.array(matrix, np.float64)
    moved = points.reshape(-1, 3) @ placed[:3, :3].T + placed[:3, 3]
    return {"points": moved.astype(np.float32), "counts": counts, "ids": _ids(data, len(counts))}


def _ids(data: bpy.types.Curves, count: int) -> np.ndarray:
    """Names of curves; those that were drawn in Blender, and so have none or one of another, get new ones."""
    if not all(name in data.attributes for name in ID_HALVES):
        return np.arange(count, dtype=np.int64)
    high, low = (np.empty(count, np.int32) for _ in ID_HALVES)
    for name, half in zip(ID_HALVES, (high, low), strict=True):
        data.attributes[name].data.foreach_get("value", half)
    ids = (high.astype(np.int64) << 32) | low.view(np.uint32)
    _, first = np.unique(ids, return_index=True)
    doubled = np.setdiff1d(np.arange(count), first)
    ids[doubled] = ids.max(initial=0) + 1 + np.arange(len(doubled))
    return ids
