"""Framing: the nearest position of a portrait lens from which the subject fits the picture."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import atan, cos, degrees, radians, sin

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError

# Azimuth from the front (+Z) to the subject's left (+X), and elevation of the camera [degrees].
VIEWS: dict[str, tuple[float, float]] = {
    "three_quarter": (34.0, 7.0),
    "front": (0.0, 4.0),
    "side": (90.0, 4.0),
    "back": (180.0, 8.0),
}

# Tangent of half the field of view on the long side: an 85 mm lens on a 36 mm × 24 mm sensor.
LENS = 18.0 / 85.0

UP = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True)
class Camera:
    """A pinhole camera.

    origin:   position [m], shape (3,)
    axes:     right, up and backward directions, the rows of a (3, 3) array
    distance: from the camera to the centre of the subject [m]
    slopes:   half the width and half the height of the picture, at unit distance
    """

    origin: NDArray[np.float64]
    axes: NDArray[np.float64]
    distance: float
    slopes: tuple[float, float]

    @property
    def target(self) -> NDArray[np.float64]:
        """Point at the centre of the picture, at the subject's distance [m], shape (3,)."""
        return self.origin - self.distance * self.axes[2]

    @property
    def fov(self) -> float:
        """Horizontal field of view [degrees]."""
        return 2.0 * degrees(atan(self.slopes[0]))

    def project(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """Projects points (n, 3) to the picture: (0, 0) top left to (1, 1) bottom right; shape (n, 2)."""
        local = (points - self.origin) @ self.axes.T
        projected = local[:, :2] / (-local[:, 2:] * np.array(self.slopes))
        return 0.5 + 0.5 * projected * (1.0, -1.0)


def angles(view: str | tuple[float, float]) -> tuple[float, float]:
    """Azimuth and elevation [degrees] of a view name; returns a pair unchanged. Raises UserError for another name."""
    if not isinstance(view, str):
        return view
    if view not in VIEWS:
        raise UserError(f"picture: there is no view '{view}'; choose one of {', '.join(VIEWS)}")
    return VIEWS[view]


def frame(
    subject: Iterable[NDArray[np.floating]],
    *,
    view: str | tuple[float, float] = "three_quarter",
    aspect: float = 1.0,
    margin: float = 0.06,
    headroom: float = 0.4,
) -> Camera:
    """Nearest camera of a view that sees every point of the subject.

    subject:  arrays of positions [m], each of shape (n, 3)
    view:     a name of ``VIEWS``, or azimuth and elevation [degrees]
    aspect:   width over height of the picture
    margin:   fraction of the width and height that stays free at each edge
    headroom: fraction of the free height above the subject
    """
    azimuth, elevation = (radians(a) for a in angles(view))
    backward = np.array([sin(azimuth) * cos(elevation), sin(elevation), cos(azimuth) * cos(elevation)])
    right = np.array([cos(azimuth), 0.0, -sin(azimuth)])
    axes = np.stack([right, np.cross(backward, right), backward])
    slopes = (LENS * min(aspect, 1.0), LENS / max(aspect, 1.0))
    slope = np.array(slopes) * (1.0 - 2.0 * margin)

    # A point (x, y, z) in camera axes is visible for |x - cx| ≤ slope (d - z), and likewise in y. These are four
    # half-spaces, so the extreme point along each normal determines the smallest distance d and the centre c.
    extent_right = extent_up = extent_left = extent_down = nearest = deepest = -np.inf
    for points in subject:
        x, y, z = axes @ np.asarray(points, np.float64).T
        extent_right = max(extent_right, (x + slope[0] * z).max())
        extent_left = max(extent_left, (-x + slope[0] * z).max())
        extent_up = max(extent_up, (y + slope[1] * z).max())
        extent_down = max(extent_down, (-y + slope[1] * z).max())
        nearest, deepest = max(nearest, z.max()), max(deepest, -z.min())
    distance = max((extent_right + extent_left) / (2.0 * slope[0]), (extent_up + extent_down) / (2.0 * slope[1]))
    lowest, highest = extent_up - slope[1] * distance, slope[1] * distance - extent_down
    centre_x = 0.5 * (extent_right - extent_left)
    centre_y = lowest + headroom * (highest - lowest)
    return Camera(np.array([centre_x, centre_y, distance]) @ axes, axes, distance - 0.5 * (nearest - deepest), slopes)
