"""Bodies in a picture: a mesh posed at one frame, and its material."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh


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

# The material is guessed from the last component of the mesh's name; the first matching pattern decides.
_MADE_OF = (
    ("matte", r"brow|lash|mouth|nostril"),
    ("eye", r"eye|white|iris|pupil|cornea|sclera|teeth"),
    ("cloth", r"shirt|cloth|tee|dress|jacket|sweater|hood|scarf|collar"),
    ("skin", r"skin|head|face|body|scalp|neck|ear|bust|child"),
)


def material_of(mesh: Mesh) -> str:
    """Material of a mesh, guessed from its name: skin, eye, cloth or matte."""
    name = re.split(r"[/\s]", mesh.name.lower())[-1]
    return next((kind for kind, pattern in _MADE_OF if re.search(pattern, name)), "matte")


def material(mesh: Mesh, opacity: float = 1.0) -> dict[str, Any]:
    """Mitsuba material of a mesh: kind guessed from its name, base colour from its display colour."""
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
    bsdf = {"type": "twosided", "bsdf": {"type": "principled", "base_color": color, **parameters[material_of(mesh)]}}
    return bsdf if opacity == 1.0 else {"type": "mask", "opacity": opacity, "bsdf": bsdf}
