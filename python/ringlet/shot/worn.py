"""A cloth of a shot in motion: where it begins, what holds it, and how large its rest shape is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh
from ringlet.data.settings import did_you_mean
from ringlet.shot.cloth import Cloth
from ringlet.shot.collider import Obstacle
from ringlet.shot.garment import Garment, Pin

Array = NDArray[np.float64]


class Worn:
    """A garment that is simulated.

    cloth:     in motion, where it is at the frame ``first``
    pinned_to: which obstacle carries its held vertices; -1: none
    """

    def __init__(self, garment: Garment, obstacles: Sequence[Obstacle], first: float) -> None:
        self.garment = garment
        settings, mesh = garment.settings, garment.mesh
        begin = beginning(garment, obstacles, first)
        self._pins = [_Pinned(garment, pin, k, obstacles, begin, first) for k, pin in enumerate(settings.pin)]
        held, attachment = np.zeros(len(begin), bool), np.zeros(len(begin))
        holder = np.full(len(begin), -1)
        for pin in self._pins:
            held[pin.vertices], holder[pin.vertices] = pin.stiffness is None, pin.obstacle
            attachment[pin.vertices] = 0.0 if pin.stiffness is None else pin.stiffness
        self.cloth = Cloth(mesh, settings.material, held, attachment=attachment)
        self.cloth.positions[:] = begin
        self.pinned_to = _most(holder[held])
        self.cloth.scale_rest(settings.least_scale)  # contact within it must leave room for the smallest that it gets
        self._begin = begin

    @property
    def name(self) -> str:
        """What it is called."""
        return self.garment.name

    def draw_together(self, frame: float) -> None:
        """Gives the rest shape the size that it has at a frame."""
        self.cloth.scale_rest(self.garment.settings.scale(frame))

    def targets(self, frame: float) -> Array:
        """Where its vertices belong at a frame [m], shape (n, 3); of those that are not pinned, where they began."""
        targets = self._begin.copy()
        for pin in self._pins:
            targets[pin.vertices] = pin.places(frame)
        return targets


def beginning(garment: Garment, obstacles: Sequence[Obstacle], first: float) -> Array:
    """Where a cloth is at the first frame [m], shape (n, 3).

    Where its file does not move it, it has gone along with what it lies on since the rest pose: as one, as the places
    of the obstacles that were next to its vertices have.
    """
    points = garment.clip.at(first)
    if points.shape != garment.mesh.points.shape:
        raise UserError(
            f"{garment.mesh.name}: has {len(points)} points at frame {first:g}, {len(garment.mesh.points)} in its rest "
            "pose; must not change"
        )
    if garment.is_animated or not obstacles:
        return points.copy()
    ends = [obstacle.at(first) for obstacle in obstacles]
    bound = [_core.bind_roots(obstacle.mesh.points, obstacle.mesh.triangles, points) for obstacle in obstacles]
    nearest = np.argmin([distance for _, _, distance in bound], axis=0)
    before, after = np.empty_like(points), np.empty_like(points)
    for k, (obstacle, end) in enumerate(zip(obstacles, ends, strict=True)):
        of = nearest == k
        corners = obstacle.mesh.triangles[bound[k][0][of]]
        for places, at in ((before, obstacle.mesh.points), (after, end)):
            places[of] = np.einsum("nk,nki->ni", bound[k][1][of], at[corners])
    return carried(points, before, after)


def carried(points: Array, before: Array, after: Array) -> Array:
    """Points moved as one as places have moved, shapes (n, 3): the rigid motion of least squares (Kabsch 1976)."""
    from_centre, to_centre = before.mean(axis=0), after.mean(axis=0)
    left, _, right = np.linalg.svd((before - from_centre).T @ (after - to_centre))
    mirror = np.array([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    return (points - from_centre) @ (left * mirror @ right) + to_centre


@dataclass
class _Binding:
    """Places on a surface that carry what is pinned there, rigidly with the surface about each."""

    obstacle: Obstacle
    triangle: NDArray[np.int32]
    barycentric: Array
    away: Array  # from each place, in its frame

    @classmethod
    def of(cls, points: Array, obstacle: Obstacle, frame: float) -> _Binding:
        surface = obstacle.at(frame)
        triangle, barycentric, _ = _core.bind_roots(surface, obstacle.mesh.triangles, points)
        place, axes = _core.root_frames(surface, obstacle.mesh.triangles, triangle, barycentric)
        return cls(obstacle, triangle, barycentric, np.einsum("nji,nj->ni", axes, points - place))

    def places(self, frame: float) -> Array:
        surface, triangles = self.obstacle.at(frame), self.obstacle.mesh.triangles
        place, axes = _core.root_frames(surface, triangles, self.triangle, self.barycentric)
        return place + np.einsum("nij,nj->ni", axes, self.away)


class _Pinned:
    """The vertices of a pin, how they are pinned and where to.

    stiffness: of their springs [N/m], shape (k,); None: they are held
    obstacle:  which one carries them; -1: none
    """

    def __init__(
        self, garment: Garment, pin: Pin, index: int, obstacles: Sequence[Obstacle], begin: Array, first: float
    ) -> None:
        self._where = f"shot: cloth '{garment.name}', pin[{index}]"
        self._clip = garment.clip
        self.obstacle = -1 if pin.to is None else self._named(pin.to, obstacles)
        mesh, chosen, strength = garment.mesh, np.ones(len(begin), bool), np.ones(len(begin))
        if pin.subset is not None:
            chosen &= _of_subset(mesh, pin.subset, self._where)
        if pin.map is not None:
            strength = _of_map(mesh, pin.map, self._where)
            chosen &= strength > 0
        if pin.within is not None:
            chosen &= self._near(pin, obstacles, begin, first, chosen)
        self.vertices = np.flatnonzero(chosen)
        if not len(self.vertices):
            raise UserError(f"{self._where}: reaches no vertex; choose another subset or map")
        self.stiffness = None if pin.stiffness is None else pin.stiffness * strength[self.vertices]
        self._binding = None if pin.to is None else _Binding.of(begin[self.vertices], obstacles[self.obstacle], first)

    def places(self, frame: float) -> Array:
        """Where the vertices belong at a frame [m], shape (k, 3)."""
        return self._binding.places(frame) if self._binding else self._clip.at(frame)[self.vertices]

    def _named(self, name: str, obstacles: Sequence[Obstacle]) -> int:
        names = [obstacle.name for obstacle in obstacles]
        if name not in names:
            hint = did_you_mean(name, sorted(set(names))) if names else "; there is none"
            raise UserError(f"{self._where}.to is '{name}', which is no collider{hint}")
        return names.index(name)

    def _near(
        self, pin: Pin, obstacles: Sequence[Obstacle], begin: Array, first: float, chosen: NDArray[np.bool_]
    ) -> NDArray[np.bool_]:
        obstacle = obstacles[self.obstacle]
        _, _, distance = _core.bind_roots(obstacle.at(first), obstacle.mesh.triangles, begin)
        assert pin.within is not None  # only then is this asked
        if chosen.any() and distance[chosen].min() > pin.within:
            raise UserError(
                f"{self._where}.within is {pin.within:g} m, but the nearest vertex is {distance[chosen].min():.3g} m "
                f"from '{pin.to}'; raise it, or bring the cloth nearer"
            )
        return distance <= pin.within


def _of_subset(mesh: Mesh, name: str, where: str) -> NDArray[np.bool_]:
    """The vertices of a region of a mesh, shape (n,)."""
    if name not in mesh.regions:
        hint = did_you_mean(name, mesh.regions) if mesh.regions else "; it has none"
        raise UserError(f"{where}.subset is '{name}', which {mesh.name} has not{hint}")
    inside = np.zeros(len(mesh.points), bool)
    inside[mesh.triangles[mesh.regions[name]]] = True
    return inside


def _of_map(mesh: Mesh, name: str, where: str) -> Array:
    """A painted value at each vertex, the largest of the corners that meet there, shape (n,)."""
    if name not in mesh.maps:
        hint = did_you_mean(name, mesh.maps) if mesh.maps else "; paint one as a primvar of floats"
        raise UserError(f"{where}.map is '{name}', which {mesh.name} has not{hint}")
    values = np.zeros(len(mesh.points))
    np.maximum.at(values, mesh.triangles, mesh.maps[name])
    if not np.isfinite(mesh.maps[name]).all():
        raise UserError(f"{where}.map is '{name}', which has a value that is no number on {mesh.name}; paint it again")
    return values


def _most(holders: NDArray[Any]) -> int:
    """The obstacle that holds most vertices; -1: none does."""
    of = holders[holders >= 0]
    return int(np.bincount(of).argmax()) if len(of) else -1
