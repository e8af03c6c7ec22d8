"""Obstacles: the animated meshes that locks cannot pass through."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.errors import UserError
from ringlet.data.mesh import Clip, Mesh
from ringlet.shot.contact import Collider


@dataclass
class Body:
    """A surface with prescribed motion, in contact on both sides.

    points:    positions [m] at the start, shape (n, 3)
    triangles: indices into points, shape (m, 3)
    thickness: [m] how far from the surface contact begins, besides what touches it
    friction:  Coulomb's μ of a lock on it
    """

    points: NDArray[np.floating]
    triangles: NDArray[np.integer]
    thickness: float = 5e-4
    friction: float = 0.3


@dataclass
class Obstacle:
    """A mesh that locks cannot pass through.

    mesh:     its triangles, and its points in the rest pose [m]
    clip:     its animation
    settings: its thickness and friction, and whether it is animated
    """

    mesh: Mesh
    clip: Clip
    settings: Collider = field(default_factory=Collider)

    @property
    def name(self) -> str:
        """Its name in the shot."""
        return self.settings.name or self.mesh.name.rpartition("/")[2]

    def starting_at(self, frame: float) -> Obstacle:
        """The same for a shot that begins at ``frame``; without animation it stays as it is there."""
        if self.settings.animated:
            return self
        return Obstacle(self.mesh, Clip(np.array([frame]), self.clip.at(frame)[None], self.clip.fps), self.settings)

    def at(self, frame: float) -> NDArray[np.float64]:
        """Its points at a frame [m], shape (n, 3); refuses degenerate triangles."""
        points = self.clip.at(frame)
        if points.shape != self.mesh.points.shape:
            raise UserError(
                f"{self.mesh.name}: has {len(points)} points at frame {frame:g}, "
                f"{len(self.mesh.points)} in its rest pose; must not change"
            )
        refuse_flat(self.mesh, points, frame, "mend the mesh or leave it out of the colliders")
        return points

    def body(self, frame: float) -> Body:
        """The body of a scene that begins at ``frame``."""
        return Body(self.at(frame), self.mesh.triangles, self.settings.thickness, self.settings.friction)

    def is_surface_of(self, scalp: Mesh) -> bool:
        """Whether it is the scalp that locks are rooted in, whichever way its triangles are wound."""
        mine, theirs = self.mesh, scalp
        return (
            np.array_equal(np.sort(mine.triangles, axis=1), np.sort(theirs.triangles, axis=1))
            and mine.points.shape == theirs.points.shape
            and bool(np.abs(mine.points - theirs.points).max() < 1e-6)
        )


def refuse_flat(mesh: Mesh, points: NDArray[np.floating], frame: float, remedy: str) -> None:
    """Refuses a mesh with a degenerate triangle at a frame."""
    flat = _core.flat_triangles(np.ascontiguousarray(points, np.float64), mesh.triangles)
    if flat.any():
        raise UserError(
            f"{mesh.name}: at frame {frame:g} triangle {flat.argmax()} has no area or is not finite "
            f"({flat.sum()} of {len(flat)}); {remedy}"
        )
