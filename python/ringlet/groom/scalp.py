"""The scalp: checks of the mesh, sampling of roots, and frames at the roots."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data import limits
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh
from ringlet.data.painted import painted
from ringlet.data.random import Random
from ringlet.deform.orientation import facing_inside, outward, turned

IDS_PER_TRIANGLE = 1_000_000  # id of a grown curve: triangle · 1 000 000 + number in the triangle

FEWEST_PROBES = 50_000  # samples that look for the painted triangles of a texture
MAX_DENSITY_RATIO = 20  # largest ratio of the peak to the mean of a painted density
THINNING_FACTOR, THINNING_STEPS = 0.8, 24


Samples = tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.float64]]  # ids, triangles and barycentrics


class Scalp:
    """A mesh in its rest pose and the region of it that carries roots.

    colliders: surfaces that hair stays out of besides the mesh
    """

    def __init__(self, mesh: Mesh, region: str | None, colliders: Sequence[Mesh] = ()) -> None:
        self.mesh, self.colliders = mesh, colliders
        self._framed: tuple[tuple[NDArray, NDArray], NDArray[np.float64]] | None = None
        self.points, self.triangles = _contiguous(mesh)
        _check_mesh(mesh)
        try:
            self.region = np.ascontiguousarray(np.sort(mesh.region(region)), np.int32)
        except KeyError as error:
            remedy = "" if mesh.regions else "; leave it out, and paint guides.density and locks.density"
            raise UserError(f"scalp.region: {error.args[0]}{remedy}") from None
        self.where = f"{mesh.name} region '{region}'" if region else mesh.name
        _check_region(self)

    @cached_property
    def solid(self) -> _core.Solid:
        """The mesh as a solid for distance queries."""
        return _core.Solid(self.points, turned(self.triangles, self.facing_inside))

    @cached_property
    def facing_inside(self) -> NDArray[np.bool_]:
        """Mask of the triangles of the mesh that face its inside."""
        return facing_inside(self.points, self.triangles)

    @cached_property
    def bodies(self) -> list[_core.Solid]:
        """The mesh and its colliders as solids."""
        colliders = (
            _core.Solid(_contiguous(body)[0], outward(body.points, body.triangles, self.points))
            for body in self.colliders
        )
        return [self.solid, *colliders]

    @cached_property
    def areas(self) -> NDArray[np.float64]:
        """Area of each triangle of the region [m²]."""
        return _areas(self.points, self.triangles[self.region])

    @property
    def area(self) -> float:
        """Area of the region [m²]."""
        return float(self.areas.sum())

    @cached_property
    def box(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lowest and highest corner of the region's bounding box [m], shape (3,) each."""
        places = self.points[np.unique(self.triangles[self.region])]
        return places.min(axis=0), places.max(axis=0)

    @property
    def middle(self) -> NDArray[np.float64]:
        """Centre of the region's bounding box [m]; near the centre of the skull for the scalp of a head."""
        return 0.5 * (self.box[0] + self.box[1])

    @property
    def width(self) -> float:
        """The largest extent of the region along an axis [m]."""
        return float((self.box[1] - self.box[0]).max())

    def sample(self, count: int, seed: int, density: str | None = None, what: str = "density") -> Samples:
        """Blue-noise samples of the region, uniform or after a painted density.

        Returns ids (count,), triangles (count,) and barycentrics (count, 3). Samples are chosen from candidates that
        are fixed per triangle. Ids and most samples therefore stay when the count or the region changes.

        density: name of the painted map
        what:    name of the setting that names the map, for messages
        """
        if density is None:
            ids, triangle, barycentric = self._candidates(count, seed, self.region)
            selected = _core.thin_out(self.positions(triangle, barycentric), self.area, count)
        else:
            ids, triangle, barycentric, selected = self._by_density(count, seed, density, what)
        return ids[selected], triangle[selected], barycentric[selected]

    def _candidates(
        self, count: int, seed: int, region: NDArray[np.int32]
    ) -> tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.float64]]:
        """Random candidates on triangles, several times ``count``: ids, triangles and barycentrics.

        Raises UserError when a triangle is too large for the count.
        """
        random, areas = Random(seed, "candidates"), _areas(self.points, self.triangles[region])
        density = 2.0 ** np.ceil(
            np.log2((5 * count + 30) / areas.sum())
        )  # in powers of 2: a few more samples use the same candidates
        each = np.floor(areas * density + random.uniform(region, IDS_PER_TRIANGLE)).astype(np.int64)
        if each.max() >= IDS_PER_TRIANGLE:
            raise UserError(f"{self.where}: {count} curves do not fit on its triangles; subdivide the mesh")
        first = np.repeat(np.cumsum(each) - each, each)
        ids = np.repeat(region.astype(np.int64), each) * IDS_PER_TRIANGLE + (np.arange(each.sum()) - first)
        triangle = np.repeat(region, each)
        root, v = np.sqrt(random.uniform(ids, 0)), random.uniform(ids, 1)
        return ids, triangle, np.stack([1.0 - root, root * (1.0 - v), root * v], axis=1)

    def _by_density(
        self, count: int, seed: int, name: str, what: str
    ) -> tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.float64], NDArray[np.int32]]:
        """Candidates, and the indices of ``count`` of them after the painted density.

        Where little of the region is painted, candidates are on its painted triangles alone.
        """
        found = self._thinned(count, seed, name, what, self.region)
        if len(found[3]) < count:
            found = self._thinned(count, seed, name, what, self._painted_triangles(count, seed, name, what))
        if len(found[3]) < count:
            raise UserError(
                f"{what} '{name}' is painted on too little of {self.where}: {len(found[3])} of {count} curves fit; "
                "paint more of it, subdivide the mesh there, or lower the count"
            )
        return found

    def _painted_triangles(self, count: int, seed: int, name: str, what: str) -> NDArray[np.int32]:
        """Triangles of the region that a map is not 0 on, as far as samples tell."""
        if (corners := self.mesh.maps.get(name)) is not None and name not in self.mesh.textures:
            return self.region[(corners[self.region] > 0.0).any(axis=1)]
        _, triangle, barycentric = self._candidates(max(20 * count, FEWEST_PROBES), seed, self.region)
        return np.unique(triangle[self._painted(name, triangle, barycentric, what) > 0.0])

    def _thinned(
        self, count: int, seed: int, name: str, what: str, region: NDArray[np.int32]
    ) -> tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.float64], NDArray[np.int32]]:
        """Candidates on triangles, and the indices of at most ``count`` of them after the painted density.

        Uniform samples are thinned in steps and stay uniform. The rank of a sample is the fraction of samples left when
        it is removed. A density of one half selects the samples whose rank is below one half.
        """
        none = np.empty(0, np.int64), np.empty(0, np.int32), np.empty((0, 3)), np.empty(0, np.int32)
        if len(region) == 0:
            raise UserError(f"{what} '{name}' is 0 all over {self.where}; paint where hair is to grow")
        area = float(_areas(self.points, self.triangles[region]).sum())
        _, triangle, barycentric = self._candidates(count, seed, region)
        share = self._painted(name, triangle, barycentric, what)
        if not share.any():
            return none
        needed = 1.1 * count * min(share.max() / share.mean(), MAX_DENSITY_RATIO)
        # Rounded to a power of the factor, so that similar counts share their ranks.
        most = int(THINNING_FACTOR ** -np.ceil(np.log(needed) / -np.log(THINNING_FACTOR)))
        ids, triangle, barycentric = self._candidates(most, seed, region)
        places = self.positions(triangle, barycentric)
        selected = _core.thin_out(places, area, most)
        rank, left = np.ones(len(ids)), selected
        for step in range(1, THINNING_STEPS + 1):
            left = left[_core.thin_out(places[left], area, max(1, round(most * THINNING_FACTOR**step)))]
            rank[left] = THINNING_FACTOR**step
        rank *= THINNING_FACTOR ** Random(seed, "rank").uniform(ids)  # random within a step
        density = self._painted(name, triangle, barycentric, what)[selected]
        with np.errstate(divide="ignore"):
            order = np.argsort(rank[selected] / density, kind="stable")
        chosen = order[:count][density[order[:count]] > 0.0]
        return ids, triangle, barycentric, np.sort(selected[chosen])

    def grows(self, places: NDArray, density: str | None, what: str) -> NDArray[np.bool_]:
        """Whether a painted density is over 0 at places (n, 3) [m] of the region, shape (n,); everywhere for None."""
        return np.ones(len(places), np.bool_) if density is None else self.painted_at(places, density, what) > 0.0

    def painted_at(self, places: NDArray, name: str, what: str) -> NDArray[np.float64]:
        """Values of a painted map at places (n, 3) [m] of the region, shape (n,)."""
        flat = np.ascontiguousarray(places, np.float64)
        triangle, barycentric, _ = _core.bind_roots(self.points, self.triangles, flat, self.region)
        return self._painted(name, triangle, barycentric, what)

    def _painted(self, name: str, triangle: NDArray, barycentric: NDArray, what: str) -> NDArray[np.float64]:
        """Values of a painted map at samples, shape (n,)."""
        count = len(triangle)
        bound = {"root_triangle": triangle, "root_barycentric": barycentric}
        places = Curves(np.zeros((count, 3)), np.arange(count + 1, dtype=np.int32), np.arange(count), bound)
        return painted(name, places, self.mesh, what)

    def attributes(self, roots: NDArray[np.float64]) -> dict[str, NDArray[np.float32]]:
        """Attributes of curves with these roots (n, 3) [m], which masks and values can use; none for an area."""
        return {}

    def count_for_spacing(self, spacing: float, what: str) -> int:
        """Number of uniform samples of the region at a mean spacing [m]; raises UserError for too many.

        what: setting that gives the spacing, for the message
        """
        count = 0.75 * self.area / (0.5 * np.sqrt(3.0) * spacing**2)  # 0.75 of the densest packing
        if count > limits.SAMPLES_OF_SCALP:
            raise UserError(
                f"{what} puts {count:.3g} samples on {self.where}, {spacing:.3g} m apart; must be at most "
                f"{limits.SAMPLES_OF_SCALP:,}: make it larger"
            )
        return max(1, round(count))

    def positions(self, triangle: NDArray, barycentric: NDArray, points: NDArray | None = None) -> NDArray[np.float64]:
        """Positions of barycentric coordinates [m], shape (k, 3), in the rest pose or on given mesh points."""
        corners = (self.points if points is None else points)[self.triangles[triangle]]
        return np.einsum("kc,kcx->kx", barycentric, corners)

    def nearest(self, places: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Closest points of the mesh to places (n, 3) [m], and the normals of the frames there, shape (n, 3) each."""
        flat = np.ascontiguousarray(places, np.float64)
        triangle, barycentric, _ = _core.bind_roots(self.points, self.triangles, flat)
        foot, frames = _core.root_frames(self.points, self.triangles, triangle, barycentric)
        return foot, frames[:, :, 2]

    def frames(self, curves: Curves) -> NDArray[np.float64]:
        """Frames at the roots of bound curves, shape (count, 3, 3); columns tangent, bitangent, normal.

        Those of the last roots are kept: one stage after the other asks for them.
        """
        roots = curves.curve["root_triangle"], curves.curve["root_barycentric"]
        if self._framed is None or any(a is not b for a, b in zip(self._framed[0], roots, strict=True)):
            self._framed = roots, _core.root_frames(self.points, self.triangles, *roots)[1]
        return self._framed[1]

    def bind(self, curves: Curves, tolerance: float, what: str) -> Curves:
        """Binds curves to the region: adds ``root_triangle`` and ``root_barycentric``.

        Raises UserError for roots farther than ``tolerance`` [m] from the scalp.
        """
        triangle, barycentric, distance = _core.bind_roots(
            self.points, self.triangles, np.ascontiguousarray(curves.roots, np.float64), self.region
        )
        if distance.max() > tolerance:
            worst, off = int(distance.argmax()), int((distance > tolerance).sum())
            raise UserError(
                f"{what}: {off} of {len(curves)} roots are not on the scalp ({self.where}); that of curve "
                f"{curves.ids[worst]} is {distance[worst]:.4g} m away, at most {tolerance:.4g} m is allowed; "
                f"{self._remedy(curves)}"
            )
        bound = {"root_triangle": triangle, "root_barycentric": barycentric}
        return Curves(curves.points, curves.offsets, curves.ids, {**curves.curve, **bound}, curves.point)

    def _remedy(self, curves: Curves) -> str:
        """Remedy for roots off the scalp: the unit, when the size ratio is a power of ten."""
        body = np.ptp(self.points, axis=0).max()
        ratio = np.ptp(curves.points, axis=0).max() / body
        for factor in (1000.0, 100.0, 10.0, 0.1, 0.01, 0.001):
            if len(curves) > 1 and 0.5 < ratio / factor < 2.0:
                return f"the guides are about {factor:g} times the head's size: check metersPerUnit of both files"
        return "move the guides onto the scalp, or raise guides.tolerance"


def _contiguous(mesh: Mesh) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Points (n, 3) and triangles (m, 3) of the core's types."""
    return np.ascontiguousarray(mesh.points, np.float64), np.ascontiguousarray(mesh.triangles, np.int32)


def axes(curves: Curves, frames: NDArray) -> NDArray[np.float64]:
    """Reference directions of curves: unit vectors orthogonal to the first edge, shape (count, 3).

    The x axis is parallel-transported from y to the root's normal, and from there to the first edge. The result varies
    smoothly between neighbours, is independent of the triangulation, and is continuous while an edge moves.
    """
    normal = frames[:, :, 2]
    edge = curves.points[curves.offsets[:-1] + 1] - curves.roots
    edge = edge / np.maximum(np.linalg.norm(edge, axis=1, keepdims=True), 1e-12)
    return np.ascontiguousarray(_transported(tangents(normal), normal, edge))


def tangents(normals: NDArray) -> NDArray[np.float64]:
    """Unit tangents for normals (n, 3): the x axis, parallel-transported from y to the normal; shape (n, 3)."""
    return _transported(np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), normals)


def _transported(vectors: NDArray, start: NDArray, end: NDArray) -> NDArray[np.float64]:
    """Rotates vectors orthogonal to the unit vectors ``start`` by the smallest rotation from ``start`` to ``end``."""
    factor = np.sum(vectors * end, axis=1) / np.maximum(1.0 + np.sum(start * end, axis=1), 1e-9)
    return vectors - factor[:, None] * (start + end)


def _areas(points: NDArray, triangles: NDArray) -> NDArray[np.float64]:
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def _check_mesh(mesh: Mesh) -> None:
    if len(mesh.points) == 0 or len(mesh.triangles) == 0:
        raise UserError(f"{mesh.name}: the mesh is empty; choose another prim")
    if not (finite := np.isfinite(mesh.points).all(axis=1)).all():
        raise UserError(f"{mesh.name}: point {np.flatnonzero(~finite)[0]} is not finite; repair the mesh")
    if mesh.triangles.min() < 0 or mesh.triangles.max() >= len(mesh.points):
        raise UserError(
            f"{mesh.name}: a face names point {mesh.triangles.max()}, but there are {len(mesh.points)}; repair the mesh"
        )


def _check_region(scalp: Scalp) -> None:
    if len(scalp.region) == 0:
        raise UserError(f"{scalp.where}: the scalp has no faces; choose the faces that carry hair")
    size = np.ptp(scalp.points, axis=0).max()
    if (flat := np.flatnonzero(scalp.areas <= 1e-14 * size**2)).size:
        raise UserError(
            f"{scalp.where}: {flat.size} triangle(s) have no area, the first is {scalp.region[flat[0]]}; clean the mesh"
        )
    corners = scalp.triangles[scalp.region].astype(np.int64)
    start, end = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]).T
    edges = np.sort(np.minimum(start, end) * len(scalp.points) + np.maximum(start, end))
    uses = np.diff(np.flatnonzero(np.concatenate([[True], edges[1:] != edges[:-1], [True]])))
    if uses.max() > 2:
        raise UserError(
            f"{scalp.where}: an edge is shared by {uses.max()} triangles; must be at most 2: split the surface there"
        )
    sides = np.sort(start * len(scalp.points) + end)
    if (sides[1:] == sides[:-1]).any():
        raise UserError(f"{scalp.where}: neighbouring faces have opposite orientations; make their normals agree")
    if count := int(scalp.facing_inside[scalp.region].sum()):
        raise UserError(
            f"{scalp.where}: {count} of {len(scalp.region)} triangles face the inside of the mesh, where their hair "
            "would grow; turn the normals outwards"
        )
