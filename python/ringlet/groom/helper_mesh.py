"""Helper meshes: surfaces that operators go by, such as the envelope of an afro."""

from __future__ import annotations

from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from ringlet.data.mesh import Mesh
from ringlet.data.quantities import Quantity, refuse
from ringlet.groom.helpers import Place
from ringlet.groom.source import OF_SPACE, Source

RINGS = 48  # of an ellipsoid, from pole to pole

Size = Annotated[float, Quantity("m", 1e-3, 10.0)]


class HelperMesh(Source):
    """A closed mesh of a file, or an ellipsoid."""

    of_file: ClassVar[tuple[str, ...]] = (*OF_SPACE, "mesh")
    of_shape: ClassVar[tuple[str, ...]] = ("middle", "width", "height", "depth")

    file: str | None = Field(
        default=None, description="USD or OBJ file with the mesh, next to the recipe or with a full path"
    )
    mesh: str | None = Field(default=None, description="prim of the mesh; needed when the file has several")
    middle: Place | None = Field(default=None, description="[x, y, z] of the middle of an ellipsoid, Y up")
    width: Size = Field(default=0.3, description="width of the ellipsoid, along x")
    height: Size = Field(default=0.3, description="height of the ellipsoid, along y")
    depth: Size = Field(default=0.3, description="depth of the ellipsoid, along z")

    @model_validator(mode="after")
    def _one_source(self) -> HelperMesh:
        if (self.middle is None) == (self.file is None):
            raise refuse("needs either a 'file' or the 'middle' of an ellipsoid; give one of them")
        return self

    def inline_mesh(self, name: str) -> Mesh | None:
        """The ellipsoid; None when the mesh is in a file."""
        if self.middle is None:
            return None
        sphere, triangles = _sphere(RINGS)
        size = 0.5 * np.array([self.width, self.height, self.depth])
        return Mesh(f"meshes.{name}", np.array(self.middle) + size * sphere, triangles)


def _sphere(rings: int) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Points (n, 3) and outward triangles (m, 3) of the unit sphere about the origin."""
    around = 2 * rings
    polar = np.linspace(0.0, np.pi, rings + 1)[:, None]
    azimuth = np.linspace(0.0, 2.0 * np.pi, around, endpoint=False)[None]
    x, z = np.sin(polar) * np.sin(azimuth), np.sin(polar) * np.cos(azimuth)
    belts = np.stack([x, np.broadcast_to(np.cos(polar), x.shape), z], axis=-1)[1:-1].reshape(-1, 3)
    points = np.concatenate([[[0.0, 1.0, 0.0]], belts, [[0.0, -1.0, 0.0]]])
    ring = np.arange(rings + 1)[:, None] - 1
    index = np.clip(1 + ring * around + np.arange(around), 0, len(points) - 1)
    index[0], index[-1] = 0, len(points) - 1
    right = np.roll(index, -1, axis=1)
    upper = np.stack([index[1:-1], index[2:], right[1:-1]], axis=-1).reshape(-1, 3)
    lower = np.stack([right[:-2], index[1:-1], right[1:-1]], axis=-1).reshape(-1, 3)
    return points, np.concatenate([upper, lower]).astype(np.int32)
