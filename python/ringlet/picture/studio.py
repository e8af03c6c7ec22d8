"""A photo studio around the subject: lights fixed to the camera, and a backdrop."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, radians, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Light:
    """A round soft box that faces the subject and gives round highlights in the eyes.

    azimuth:   from the camera to its right [degrees]
    elevation: above the camera's height [degrees]
    size:      diameter, in units of the subject's distance from the light
    strength:  irradiance of a surface that faces the box (linear r, g, b)
    attention: part of the light samples that it gets
    """

    azimuth: float
    elevation: float
    size: float
    strength: tuple[float, float, float]
    attention: float = 1.0


LIGHTS = {
    "key": Light(-36.0, 25.0, 0.62, (10.5, 9.0, 7.3)),  # warm and large, below the fringe: models the face
    "fill": Light(64.0, 4.0, 1.0, (1.2, 1.4, 1.7), 0.35),  # cool and dim, from the other side
    "rim_right": Light(142.0, 34.0, 0.7, (9.5, 9.2, 8.8)),  # from behind: outlines every curl of the silhouette
    "rim_left": Light(-128.0, 52.0, 0.7, (9.5, 9.2, 9.2)),
}
AMBIENT, AMBIENT_ATTENTION = (0.22, 0.23, 0.25), 0.15

# Linear colours of the backdrop: behind the subject's shoulders, and at the picture's edge.
BACKDROP_NEAR, BACKDROP_FAR = np.array([0.33, 0.38, 0.40]), np.array([0.05, 0.062, 0.072])


def lights(mi: Any, axes: NDArray[np.float64], distance: float, centre: NDArray[np.float64]) -> dict[str, Any]:
    """Soft boxes as Mitsuba shapes, at ``distance`` from the centre of the subject; ``axes`` as in Camera."""
    shapes: dict[str, Any] = {
        "ambient": {"type": "constant", "radiance": rgb(AMBIENT), "sampling_weight": AMBIENT_ATTENTION}
    }
    for name, light in LIGHTS.items():
        azimuth, elevation = radians(light.azimuth), radians(light.elevation)
        local = np.array([sin(azimuth) * cos(elevation), sin(elevation), cos(azimuth) * cos(elevation)])
        half = 0.5 * light.size * distance
        # Mitsuba's disk has radius 1; one of diameter s at distance 1 sends its radiance times π s²/4 to the subject
        place = mi.ScalarTransform4f().look_at(
            origin=list(centre + distance * (local @ axes)), target=list(centre), up=list(axes[1] + 1e-3 * axes[2])
        ) @ mi.ScalarTransform4f().scale([half, half, 1.0])
        radiance = [s / (0.25 * pi * light.size**2) for s in light.strength]
        emitter = {"type": "area", "radiance": rgb(radiance), "sampling_weight": light.attention}
        shapes[name] = {"type": "disk", "to_world": place, "emitter": emitter}
    return shapes


def backdrop(width: int, height: int) -> NDArray[np.float32]:
    """Backdrop with a pool of light behind the subject, linear colours of shape (height, width, 3)."""
    x = (np.arange(width) + 0.5) / width - 0.5
    y = (np.arange(height) + 0.5) / height - 0.55
    radius = np.hypot(x[None, :], 0.85 * y[:, None] * height / width) / 0.78
    pool = np.exp(-2.2 * radius**2)[:, :, None]
    return (BACKDROP_FAR + (BACKDROP_NEAR - BACKDROP_FAR) * pool).astype(np.float32)


def rgb(values: Any) -> dict[str, Any]:
    """A colour as a Mitsuba spectrum."""
    return {"type": "rgb", "value": [float(v) for v in values]}
