"""Meshes and curves of a host, as USD files in its folder."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet import io
from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.errors import UserError
from ringlet.data.hair_scene import CurveSet, HairScene
from ringlet.data.stage import StageSpace
from ringlet.host.requests import WriteCurves, WriteMeshes
from ringlet.io.space import to_metres

Arrays = dict[str, NDArray[Any]]


def write_meshes(request: WriteMeshes, arrays: Arrays) -> dict[str, Any]:
    """Writes the meshes of a request; returns the paths of their prims.

    Arrays of mesh ``k``: ``k/points`` (n, 3), ``k/counts``, ``k/indices``, and where there are any ``k/uv`` (corners,
    2), ``k/map/NAME`` (n,), ``k/region/NAME`` (faces,) and ``k/motion`` (frames, n, 3).
    """
    meshes = [
        io.PolygonMesh(
            one.name,
            _needed(arrays, f"{k}/points"),
            _needed(arrays, f"{k}/counts"),
            _needed(arrays, f"{k}/indices"),
            arrays.get(f"{k}/uv"),
            _named(arrays, f"{k}/map/"),
            _named(arrays, f"{k}/region/"),
            arrays.get(f"{k}/motion"),
            one.subdivided,
        )
        for k, one in enumerate(request.meshes)
    ]
    space = StageSpace(request.meters_per_unit, request.up_axis, request.fps)
    prims = io.write_polygon_meshes(meshes, request.folder / request.file, space, request.first_frame)
    return {"prims": prims}


def write_curves(request: WriteCurves, arrays: Arrays) -> dict[str, Any]:
    """Writes the curves of a request: ``points`` (n, 3), ``counts`` and, for curves with names, ``ids``."""
    counts, points = _needed(arrays, "counts"), _needed(arrays, "points")
    if points.ndim != 2 or points.shape[1] != 3 or counts.ndim != 1:
        raise UserError(f"curves: points have the shape {points.shape}; must be (n, 3), with one list of counts")
    space = StageSpace(request.meters_per_unit, request.up_axis)
    ids = np.asarray(arrays.get("ids", np.arange(len(counts))), np.int64)
    if ids.shape != counts.shape:
        raise UserError(f"curves: there are {len(ids)} ids for {len(counts)} curves; must be as many")
    curves = Curves(to_metres(points.astype(np.float64), space), offsets_from_counts(counts), ids).check("curves")
    io.write_scene(HairScene([CurveSet("curves", curves, guide=True)]), request.folder / request.file, space)
    return {"curves": len(curves)}


def _needed(arrays: Arrays, name: str) -> NDArray[Any]:
    if name not in arrays:
        raise UserError(f"request: array {name} is missing; it must be given")
    return arrays[name]


def _named(arrays: Arrays, prefix: str) -> Arrays:
    return {name.removeprefix(prefix): values for name, values in arrays.items() if name.startswith(prefix)}
