"""Colliders: the meshes that locks cannot pass through, and how they move."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet import _core
from ringlet.data.errors import UserError
from ringlet.data.mesh import Clip, Mesh
from ringlet.data.settings import Section, did_you_mean
from ringlet.shot.scene import Body, Contact


class Pair(Section):
    """The friction of two materials on each other, in place of what each of them says."""

    between: tuple[str, str] = Field(
        description="`locks`, or the names of colliders and cloths; twice the same name: on itself"
    )
    friction: float = Field(ge=0, le=10, description="Coulomb's μ")


class ShotContact(Contact):
    """How locks touch one another, the colliders and cloth."""

    on: bool = Field(default=True, description="false: everything passes through everything, as without this table")
    pair: tuple[Pair, ...] = Field(
        default=(),
        description="friction of pairs; by default a lock on something has what that says, and two others the "
        "geometric mean of what both say",
    )


class Collider(Section):
    """Meshes that locks cannot pass through. Where several entries name one mesh, the last of them counts."""

    name: str = Field(default="", description="for pins and friction; by default the last part of each mesh's path")
    file: Path | None = Field(
        default=None,
        description="USD file with the animation of the groom's head; by default that head. A relative name counts "
        "from the shot",
    )
    mesh: str | None = Field(
        default=None, description="path of a prim: the meshes at and below it; by default all that are visible"
    )
    animated: bool = Field(default=True, description="false: it stays as it is at the first frame of the shot")
    thickness: float = Field(
        default=5e-4, ge=0, le=0.1, description="[m] how far from the surface contact begins, besides `contact.radius`"
    )
    friction: float = Field(default=0.3, ge=0, le=10, description="Coulomb's μ of a lock on it")


LOCKS = "locks"  # what they are called where friction is told


def with_pairs(friction: NDArray[np.float64], pairs: Sequence[Pair], names: Sequence[str]) -> NDArray[np.float64]:
    """Friction of materials on one another, shape (k, k), with that of some pairs told by name.

    names: of the materials, k of them; several may have one name
    """
    friction = friction.copy()
    for index, pair in enumerate(pairs):
        for place, name in enumerate(pair.between):
            if name not in names:
                raise UserError(
                    f"shot: contact.pair[{index}].between[{place}] is '{name}', which nothing is called"
                    f"{did_you_mean(name, dict.fromkeys(names))}"
                )
        one, other = (np.flatnonzero(np.array(names) == name) for name in pair.between)
        friction[np.ix_(one, other)] = friction[np.ix_(other, one)] = pair.friction
    return friction


@dataclass
class Obstacle:
    """A mesh in the way of locks.

    mesh:     its triangles, and its points in the rest pose [m]
    clip:     how it moves
    settings: its thickness and friction, and whether it moves
    """

    mesh: Mesh
    clip: Clip
    settings: Collider = field(default_factory=Collider)

    @property
    def name(self) -> str:
        """What it is called in the shot."""
        return self.settings.name or self.mesh.name.rpartition("/")[2]

    def starting_at(self, frame: float) -> Obstacle:
        """The same for a shot that begins at ``frame``: what is not animated stays as it is there."""
        if self.settings.animated:
            return self
        return Obstacle(self.mesh, Clip(np.array([frame]), self.clip.at(frame)[None], self.clip.fps), self.settings)

    def at(self, frame: float) -> NDArray[np.float64]:
        """Its points at a frame [m], shape (n, 3); refuses what nothing can touch."""
        points = self.clip.at(frame)
        if points.shape != self.mesh.points.shape:
            raise UserError(
                f"{self.mesh.name}: has {len(points)} points at frame {frame:g}, "
                f"{len(self.mesh.points)} in its rest pose; must not change"
            )
        flat = _core.flat_triangles(np.ascontiguousarray(points, np.float64), self.mesh.triangles)
        if flat.any():
            raise UserError(
                f"{self.mesh.name}: at frame {frame:g} triangle {flat.argmax()} has no area or is not finite "
                f"({flat.sum()} of {len(flat)}); mend the mesh or leave it out of the colliders"
            )
        return points

    def body(self, frame: float) -> Body:
        """The same for a scene that begins at ``frame``."""
        return Body(self.at(frame), self.mesh.triangles, self.settings.thickness, self.settings.friction)

    def is_surface_of(self, scalp: Mesh) -> bool:
        """Whether it is the scalp that locks are rooted in."""
        mine, theirs = self.mesh, scalp
        return (
            np.array_equal(mine.triangles, theirs.triangles)
            and mine.points.shape == theirs.points.shape
            and bool(np.abs(mine.points - theirs.points).max() < 1e-6)
        )
