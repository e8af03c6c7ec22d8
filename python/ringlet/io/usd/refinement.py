"""Subdivision surfaces of a stage: polygons of a mesh, refined to the limit surface that renderers show."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from ringlet.io.polygons import check_polygons
from ringlet.io.subdivision import Cage, Refinement, levels_for, refine
from ringlet.io.usd.stage import Source
from ringlet.io.usd.values import local_to_world, read_integers, read_points, read_time

SHARP = 10.0  # sharpness that USD takes for infinite


def refinement(source: Source, prim: Usd.Prim) -> Refinement | None:
    """Refinement of a mesh; None for polygons, other schemes than Catmull-Clark, and where cages are read."""
    mesh = UsdGeom.Mesh(prim)
    if source.cage or not mesh or mesh.GetSubdivisionSchemeAttr().Get() != UsdGeom.Tokens.catmullClark:
        return None
    path = prim.GetPath()
    if path not in source.refinements:
        source.refinements[path] = _refined(source, mesh)
    return source.refinements[path]


def unrefined(source: Source, prim: Usd.Prim) -> str | None:
    """A sentence for a subdivision surface whose scheme is not known, so that its cage is read."""
    scheme = UsdGeom.Mesh(prim).GetSubdivisionSchemeAttr().Get() if UsdGeom.Mesh(prim) else None
    if source.cage or scheme != UsdGeom.Tokens.loop:
        return None
    return f"{source.where(prim)}: its subdivisionScheme is {scheme}; its cage is read instead of its limit surface"


def read_polygons(
    prim: Usd.Prim, time: Usd.TimeCode, points: int, where: str
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Corners per polygon and the point of each corner; raises UserError where they do not fit the points."""
    mesh = UsdGeom.Mesh(prim)
    counts = read_integers(mesh.GetFaceVertexCountsAttr(), time, where)
    indices = read_integers(mesh.GetFaceVertexIndicesAttr(), time, where)
    check_polygons(counts, indices, points, where)
    return counts, indices


def undrawn(source: Source, prim: Usd.Prim, time: Usd.TimeCode) -> NDArray[np.int64]:
    """Polygons of a mesh that are not drawn: holes, and those at a boundary that is not interpolated."""
    mesh, where = UsdGeom.Mesh(prim), source.where(prim)
    holes = read_integers(mesh.GetHoleIndicesAttr(), time, where)
    if refinement(source, prim) is None or mesh.GetInterpolateBoundaryAttr().Get() != UsdGeom.Tokens.none:
        return holes
    counts, indices = read_polygons(prim, time, len(read_points(prim, time, where)), where)
    at_boundary = np.isin(indices, Cage(counts, indices, int(indices.max()) + 1).boundary)
    return np.union1d(holes, np.repeat(np.arange(len(counts)), counts)[at_boundary])


def _refined(source: Source, mesh: UsdGeom.Mesh) -> Refinement:
    prim, where, rest = mesh.GetPrim(), source.where(mesh.GetPrim()), Usd.TimeCode.Default()
    points = read_points(prim, rest, where)
    counts, indices = read_polygons(prim, rest, len(points), where)
    creases, sharpness = _creases(mesh, where)
    round_ends = mesh.GetInterpolateBoundaryAttr().Get() == UsdGeom.Tokens.edgeOnly
    cage = Cage(counts, indices, len(points), creases, sharpness, _corners(mesh, len(points), where), round_ends)
    place = local_to_world(prim, read_time(rest, mesh.GetPointsAttr()))
    return refine(cage, levels_for(cage, points @ place[:3, :3] * source.space.meters_per_unit))


def _creases(mesh: UsdGeom.Mesh, where: str) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Points of the sharp edges, shape (k, 2), and their sharpness."""
    rest = Usd.TimeCode.Default()
    indices = read_integers(mesh.GetCreaseIndicesAttr(), rest, where)
    lengths = read_integers(mesh.GetCreaseLengthsAttr(), rest, where)
    sharpness = _sharpness(mesh.GetCreaseSharpnessesAttr())
    last = np.cumsum(lengths) - 1  # of each crease, in its points
    edges = np.setdiff1d(np.arange(len(indices)), last)
    if lengths.sum() != len(indices) or len(sharpness) not in (len(lengths), len(edges)):
        return np.empty((0, 2), np.int64), np.empty(0)
    of_edge = sharpness if len(sharpness) == len(edges) else np.repeat(sharpness, lengths - 1)
    return np.stack([indices[edges], indices[edges + 1]], axis=1), of_edge


def _corners(mesh: UsdGeom.Mesh, points: int, where: str) -> NDArray[np.float64]:
    """Sharpness of each point, shape (points,)."""
    corners = np.zeros(points)
    chosen, sharpness = (
        read_integers(mesh.GetCornerIndicesAttr(), Usd.TimeCode.Default(), where),
        _sharpness(mesh.GetCornerSharpnessesAttr()),
    )
    if len(chosen) == len(sharpness) and ((chosen >= 0) & (chosen < points)).all():
        corners[chosen] = sharpness
    return corners


def _sharpness(attribute: Usd.Attribute) -> NDArray[np.float64]:
    values = np.array(attribute.Get(read_time(Usd.TimeCode.Default(), attribute)) or [], np.float64)
    return np.where(values >= SHARP, np.inf, np.maximum(values, 0.0))
