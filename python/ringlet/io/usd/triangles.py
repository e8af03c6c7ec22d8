"""Triangles of a mesh prim, and values of its primvars on them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from ringlet.data.errors import UserError
from ringlet.io.polygons import polygon_places, triangulate
from ringlet.io.usd.refinement import read_polygons, refinement, undrawn
from ringlet.io.usd.stage import Source
from ringlet.io.usd.values import local_to_world, read_points


class Triangles:
    """Triangles of a mesh, or of its refinement where it is a subdivision surface.

    triangles: points of each triangle, shape (m, 3)
    faces:     polygon of the mesh of each triangle, shape (m,)
    places:    parametric coordinates of the corners in these polygons, shape (m, 3, 2)
    counts:    corners per polygon of the mesh; indices: point of each; points: number of its points

    Raises UserError for polygons that do not fit the points, and for a mesh without triangles.
    """

    def __init__(self, source: Source, prim: Usd.Prim, time: Usd.TimeCode) -> None:
        self.where, mesh = source.where(prim), UsdGeom.Mesh(prim)
        points = read_points(prim, time, self.where)
        self.points = len(points)
        self.counts, self.indices = read_polygons(prim, time, self.points, self.where)
        self._refined = refinement(source, prim)
        counts, indices, polygons = self.counts, self.indices, np.arange(len(self.counts))
        if self._refined:
            counts, indices, polygons = self._refined.counts, self._refined.indices, self._refined.faces

        # A mirroring transform reverses the winding, like leftHanded.
        with np.errstate(all="ignore"):  # points under a transform that is no number are refused
            mirrored = np.linalg.det(local_to_world(prim, time)[:3, :3]) < 0
        left_handed = mesh.GetOrientationAttr().Get(time) == UsdGeom.Tokens.leftHanded
        corners, faces = triangulate(self.at_points(points), counts, indices, clockwise=bool(mirrored) != left_handed)
        drawn = ~np.isin(polygons[faces], undrawn(source, prim, time))
        self._corners, self.faces = corners[drawn], polygons[faces[drawn]]
        if len(self.faces) == 0:
            raise UserError(f"{self.where}: has no faces; export it again or choose another mesh")
        self.triangles = indices[self._corners]
        self.places = self.spread(polygon_places(self.counts), UsdGeom.Tokens.faceVarying)

    def spread(self, values: NDArray, interpolation: str) -> NDArray:
        """Values of a primvar at the corners of each triangle, shape (m, 3, …); there must be enough of them."""
        if interpolation == UsdGeom.Tokens.constant:
            return values[np.zeros_like(self.triangles)]
        if interpolation == UsdGeom.Tokens.uniform:
            return values[np.repeat(self.faces[:, None], 3, axis=1)]
        if interpolation == UsdGeom.Tokens.varying and self._refined:
            values, interpolation = values[self.indices], UsdGeom.Tokens.faceVarying
        if interpolation == UsdGeom.Tokens.faceVarying:
            count = len(self.indices)
            return (self._refined.corners @ values[:count] if self._refined else values)[self._corners]
        return self.at_points(values)[self.triangles]

    def at_points(self, values: NDArray) -> NDArray:
        """Values at the points of the mesh as values at those of the triangles, shape (n, …)."""
        return self._refined.points @ values[: self.points] if self._refined else values

    def count(self, interpolation: str) -> int:
        """Number of values that a primvar needs."""
        return {
            UsdGeom.Tokens.constant: 1,
            UsdGeom.Tokens.uniform: len(self.counts),
            UsdGeom.Tokens.faceVarying: len(self.indices),
        }.get(interpolation, self.points)
