"""Bodies in a picture: a mesh posed at one frame, and its material."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh
from ringlet.data.surfaces import material_of


@dataclass
class PosedBody:
    """A mesh at one frame.

    mesh:    triangles, name and colour
    points:  positions at that frame [m], shape (n, 3)
    opacity: from 0 to 1

    Raises UserError for points of another shape than the mesh's, or not finite.
    """

    mesh: Mesh
    points: NDArray[np.floating]
    opacity: float = 1.0

    def __post_init__(self) -> None:
        if self.points.shape != self.mesh.points.shape:
            raise UserError(
                f"{self.mesh.name}: posed points have shape {self.points.shape}; must be {self.mesh.points.shape}"
            )
        if (broken := np.flatnonzero(~np.isfinite(self.points).all(axis=1))).size:
            raise UserError(f"{self.mesh.name}: point {broken[0]} is {self.points[broken[0]]}; must be finite")


# Name of the vertex colours in Mitsuba.
COLORS = "vertex_color"


def material(mesh: Mesh, opacity: float = 1.0) -> dict[str, Any]:
    """Mitsuba material of a mesh, by its name and its display colour."""
    color: dict[str, Any] = {"type": "rgb", "value": [float(np.clip(c, 0.0, 1.0)) for c in mesh.color]}
    if mesh.colors is not None:
        color = {"type": "mesh_attribute", "name": COLORS}
    parameters: dict[str, dict[str, Any]] = {
        # `flatness` and `sheen` approximate subsurface scattering: softer shading, a warm edge
        "skin": {"roughness": 0.48, "specular": 0.4, "flatness": 0.5, "sheen": 0.1, "sheen_tint": 0.8},
        "eye": {"roughness": 0.06, "specular": 0.35},
        "cloth": {"roughness": 0.9, "specular": 0.15, "sheen": 0.5, "sheen_tint": 0.5},
        "matte": {"roughness": 0.8, "specular": 0.2},
    }
    made_of = parameters[material_of(mesh.name)]
    bsdf = {"type": "twosided", "bsdf": {"type": "principled", "base_color": color, **made_of}}
    return bsdf if opacity == 1.0 else {"type": "mask", "opacity": opacity, "bsdf": bsdf}
