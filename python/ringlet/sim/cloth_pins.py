"""Pins of a cloth: their vertices, stiffness and targets at each frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.errors import UserError
from ringlet.data.mesh import Clip, Mesh
from ringlet.data.settings import did_you_mean
from ringlet.shot.cloth import Pin
from ringlet.sim.obstacle import Obstacle

Array = NDArray[np.float64]


@dataclass
class _Binding:
    """Points bound to a surface, each carried rigidly with the frame of its nearest place."""

    obstacle: Obstacle
    triangle: NDArray[np.int32]
    barycentric: Array
    offset: Array  # from each place, in its frame

    @classmethod
    def of(cls, points: Array, obstacle: Obstacle, frame: float) -> _Binding:
        surface = obstacle.at(frame)
        triangle, barycentric, _ = _core.bind_roots(surface, obstacle.mesh.triangles, points)
        place, axes = _core.root_frames(surface, obstacle.mesh.triangles, triangle, barycentric)
        return cls(obstacle, triangle, barycentric, np.einsum("nji,nj->ni", axes, points - place))

    def places(self, frame: float) -> Array:
        surface, triangles = self.obstacle.at(frame), self.obstacle.mesh.triangles
        place, axes = _core.root_frames(surface, triangles, self.triangle, self.barycentric)
        return place + np.einsum("nij,nj->ni", axes, self.offset)


class PinnedVertices:
    """The vertices of a pin, and what holds them.

    stiffness: of their springs [N/m], shape (k,); None: they are held
    obstacle:  the index of the one that carries them; -1: none
    """

    def __init__(
        self, mesh: Mesh, clip: Clip, pin: Pin, where: str, obstacles: Sequence[Obstacle], begin: Array, first: float
    ) -> None:
        self._where, self._clip = where, clip
        self.obstacle = -1 if pin.to is None else self._named(pin.to, obstacles)
        chosen, strength = np.ones(len(begin), bool), np.ones(len(begin))
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
        """The targets of the vertices at a frame [m], shape (k, 3)."""
        return self._binding.places(frame) if self._binding else self._clip.at(frame)[self.vertices]

    def _named(self, name: str, obstacles: Sequence[Obstacle]) -> int:
        names = [obstacle.name for obstacle in obstacles]
        if name not in names:
            hint = did_you_mean(name, sorted(set(names))) if names else "; there is none"
            raise UserError(f"{self._where}.to is '{name}', which is no collider{hint}")
        if names.count(name) > 1:
            raise UserError(
                f"{self._where}.to is '{name}', which is the name of {names.count(name)} colliders; give the one that "
                "is meant a [[collider]] of its own, with `mesh` and another `name`"
            )
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
        raise UserError(f"{where}.subset is '{name}', which {mesh.name} does not have{hint}")
    inside = np.zeros(len(mesh.points), bool)
    inside[mesh.triangles[mesh.regions[name]]] = True
    return inside


def _of_map(mesh: Mesh, name: str, where: str) -> Array:
    """A painted value at each vertex, the largest of the corners that meet there, shape (n,)."""
    if name not in mesh.maps:
        hint = did_you_mean(name, mesh.maps) if mesh.maps else "; paint one as a primvar of floats"
        raise UserError(f"{where}.map is '{name}', which {mesh.name} does not have{hint}")
    values = np.zeros(len(mesh.points))
    np.maximum.at(values, mesh.triangles, mesh.maps[name])
    if not np.isfinite(mesh.maps[name]).all():
        raise UserError(f"{where}.map is '{name}', which has a value that is no number on {mesh.name}; paint it again")
    return values
