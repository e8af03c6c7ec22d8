"""Bodies in a picture: a mesh as it stands at one frame, and what it is made of."""

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
    opacity: from 0 to 1; below 1, what is behind it is seen through it
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


# Where Mitsuba finds the colours of vertices.
COLORS = "vertex_color"

# What a mesh is made of is guessed from the last part of its name; the first pattern that matches wins.
_MADE_OF = (
    ("matte", r"brow|lash|mouth|nostril"),
    ("eye", r"eye|white|iris|pupil|cornea|sclera|teeth"),
    ("cloth", r"shirt|cloth|tee|dress|jacket|sweater|hood|scarf|collar"),
    ("skin", r"skin|head|face|body|scalp|neck|ear|bust|child"),
)


def made_of(mesh: Mesh) -> str:
    """What a mesh is made of, guessed from its name: skin, eye, cloth or matte."""
    name = re.split(r"[/\s]", mesh.name.lower())[-1]
    return next((kind for kind, pattern in _MADE_OF if re.search(pattern, name)), "matte")


def material(mesh: Mesh, opacity: float = 1.0) -> dict[str, Any]:
    """The Mitsuba material of a mesh, coloured by its display colour and guessed from its name."""
    color: dict[str, Any] = {"type": "rgb", "value": [float(np.clip(c, 0.0, 1.0)) for c in mesh.color]}
    if mesh.colors is not None:
        color = {"type": "mesh_attribute", "name": COLORS}
    look: dict[str, dict[str, Any]] = {
        # `flatness` and `sheen` stand in for light that wanders under the skin: softer shading, a warm edge
        "skin": {"roughness": 0.48, "specular": 0.4, "flatness": 0.5, "sheen": 0.1, "sheen_tint": 0.8},
        "eye": {"roughness": 0.06, "specular": 0.35},
        "cloth": {"roughness": 0.9, "specular": 0.15, "sheen": 0.5, "sheen_tint": 0.5},
        "matte": {"roughness": 0.8, "specular": 0.2},
    }
    made = {"type": "twosided", "bsdf": {"type": "principled", "base_color": color, **look[made_of(mesh)]}}
    return made if opacity == 1.0 else {"type": "mask", "opacity": opacity, "bsdf": made}
