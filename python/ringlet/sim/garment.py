"""Garments: meshes that become cloth in a shot, with their pins, their start and the scale of their rest shape."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.errors import UserError
from ringlet.data.mesh import Clip, Mesh
from ringlet.data.rigid import best_rotation
from ringlet.shot.cloth import ShotCloth
from ringlet.sim.cloth import Cloth
from ringlet.sim.cloth_pins import PinnedVertices
from ringlet.sim.obstacle import Obstacle, refuse_flat

Array = NDArray[np.float64]


@dataclass
class Garment:
    """A mesh that becomes cloth.

    mesh:     its rest shape [m]
    clip:     its animation: where it begins, and the targets of pins to nothing else
    settings: its material and its pins
    file:     the USD file of its mesh
    prim:     its path there
    """

    mesh: Mesh
    clip: Clip
    settings: ShotCloth = field(default_factory=lambda: ShotCloth(mesh="/cloth"))
    file: Path | None = None
    prim: str = "/cloth"

    @property
    def name(self) -> str:
        """Its name in the shot, in statistics and in messages."""
        return self.settings.name or self.prim.rpartition("/")[2]

    @property
    def is_animated(self) -> bool:
        """Whether its file animates it."""
        return len(self.clip.frames) > 1


class SimulatedGarment:
    """A garment in simulation.

    cloth:     its cloth, at the start where it is at the frame ``first``
    pinned_to: the index of the obstacle that carries its held vertices; -1: none
    """

    def __init__(self, garment: Garment, obstacles: Sequence[Obstacle], first: float) -> None:
        self.garment = garment
        settings, mesh = garment.settings, garment.mesh
        begin = start_positions(garment, obstacles, first)
        where = f"shot: cloth '{garment.name}', pin"
        self._pins = [
            PinnedVertices(mesh, garment.clip, pin, f"{where}[{k}]", obstacles, begin, first)
            for k, pin in enumerate(settings.pin)
        ]
        held, attachment = np.zeros(len(begin), bool), np.zeros(len(begin))
        holder = np.full(len(begin), -1)
        for pin in self._pins:
            held[pin.vertices], holder[pin.vertices] = pin.stiffness is None, pin.obstacle
            attachment[pin.vertices] = 0.0 if pin.stiffness is None else pin.stiffness
        self.cloth = Cloth(mesh, settings.material, held, attachment=attachment)
        refuse_flat(mesh, begin, first, "begin where each has one, or mend the animation")
        self.cloth.positions[:] = begin
        self.pinned_to = _most_frequent(holder[held])
        self.cloth.scale_rest(settings.least_scale)  # contact leaves room for the smallest scale
        self._begin = begin

    @property
    def name(self) -> str:
        """The name of its garment."""
        return self.garment.name

    def scale_rest(self, frame: float) -> None:
        """Scales the rest shape as at a frame."""
        self.cloth.scale_rest(self.garment.settings.scale(frame))

    def targets(self, frame: float) -> Array:
        """The targets of its vertices at a frame [m], shape (n, 3); those that are not pinned stay where they began."""
        targets = self._begin.copy()
        for pin in self._pins:
            targets[pin.vertices] = pin.places(frame)
        return targets


def start_positions(garment: Garment, obstacles: Sequence[Obstacle], first: float) -> Array:
    """The positions of a cloth at the first frame [m], shape (n, 3).

    Without animation it has moved rigidly with the obstacles since the rest pose, as the nearest places on them have.
    """
    points = garment.clip.at(first)
    if points.shape != garment.mesh.points.shape:
        raise UserError(
            f"{garment.mesh.name}: has {len(points)} points at frame {first:g}, {len(garment.mesh.points)} in its rest "
            "pose; must not change"
        )
    if garment.is_animated or not obstacles:
        return points.copy()
    return moved_with(points, [(one.mesh.triangles, one.mesh.points, one.at(first)) for one in obstacles])


def moved_with(points: Array, bodies: Sequence[tuple[NDArray[np.int32], Array, Array]]) -> Array:
    """Points moved by the rigid motion that fits the nearest places on bodies best: their triangles, and their points
    before and after [m]."""
    bound = [_core.bind_roots(start, triangles, points) for triangles, start, _ in bodies]
    nearest = np.argmin([distance for _, _, distance in bound], axis=0)
    before, after = np.empty_like(points), np.empty_like(points)
    for k, (triangles, start, end) in enumerate(bodies):
        of = nearest == k
        corners = triangles[bound[k][0][of]]
        for places, at in ((before, start), (after, end)):
            places[of] = np.einsum("nk,nki->ni", bound[k][1][of], at[corners])
    return moved_rigidly(points, before, after)


def moved_rigidly(points: Array, before: Array, after: Array) -> Array:
    """Points moved by the rigid motion that fits places before and after best, shapes (n, 3)."""
    return (points - before.mean(axis=0)) @ best_rotation(before, after) + after.mean(axis=0)


def _most_frequent(holders: NDArray[Any]) -> int:
    """The index of the obstacle that holds most vertices; -1: none does."""
    of = holders[holders >= 0]
    return int(np.bincount(of).argmax()) if len(of) else -1
