"""Framing: where a portrait lens must stand so that the subject just fills the picture."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import atan, cos, degrees, radians, sin

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError

# Where the camera stands, seen from the subject: turn from the front (+Z) to its left (+X), and height [degrees].
VIEWS: dict[str, tuple[float, float]] = {
    "three_quarter": (34.0, 7.0),
    "front": (0.0, 4.0),
    "side": (90.0, 4.0),
    "back": (180.0, 8.0),
}

# Half the long side of a 36 mm × 24 mm picture behind an 85 mm lens, as a slope.
LENS = 18.0 / 85.0

UP = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True)
class Camera:
    """A pinhole camera.

    origin:   where it stands [m], shape (3,)
    axes:     its right, up and backward directions, the rows of a (3, 3) array
    distance: from the camera to the middle of the subject [m]
    slopes:   half the width and half the height of the picture, at unit distance
    """

    origin: NDArray[np.float64]
    axes: NDArray[np.float64]
    distance: float
    slopes: tuple[float, float]

    @property
    def target(self) -> NDArray[np.float64]:
        """The point in the middle of the picture, at the subject's distance [m], shape (3,)."""
        return self.origin - self.distance * self.axes[2]

    @property
    def fov(self) -> float:
        """Horizontal opening angle [degrees]."""
        return 2.0 * degrees(atan(self.slopes[0]))

    def project(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """Where points (n, 3) appear: from (0, 0), top left, to (1, 1), bottom right; shape (n, 2)."""
        local = (points - self.origin) @ self.axes.T
        seen = local[:, :2] / (-local[:, 2:] * np.array(self.slopes))
        return 0.5 + 0.5 * seen * (1.0, -1.0)


def angles(view: str | tuple[float, float]) -> tuple[float, float]:
    """Azimuth and elevation [degrees] of a named view; a pair of them passes through."""
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
    """The nearest camera of a view that sees every point of the subject.

    subject:  arrays of positions [m], each of shape (n, 3)
    view:     a name of ``VIEWS``, or azimuth and elevation [degrees]
    aspect:   width over height of the picture
    margin:   part of the width and height kept free at each edge
    headroom: part of the free height that goes above the subject
    """
    azimuth, elevation = (radians(a) for a in angles(view))
    backward = np.array([sin(azimuth) * cos(elevation), sin(elevation), cos(azimuth) * cos(elevation)])
    right = np.array([cos(azimuth), 0.0, -sin(azimuth)])
    axes = np.stack([right, np.cross(backward, right), backward])
    slopes = (LENS * min(aspect, 1.0), LENS / max(aspect, 1.0))
    room = np.array(slopes) * (1.0 - 2.0 * margin)

    # A point (x, y, z) in camera axes is inside when |x - cx| ≤ room (d - z): four planes, so only the farthest point
    # along each plane's normal counts, and the smallest distance d and the centre c follow directly.
    reach_right = reach_up = reach_left = reach_down = nearest = deepest = -np.inf
    for points in subject:
        x, y, z = axes @ np.asarray(points, np.float64).T
        reach_right = max(reach_right, (x + room[0] * z).max())
        reach_left = max(reach_left, (-x + room[0] * z).max())
        reach_up = max(reach_up, (y + room[1] * z).max())
        reach_down = max(reach_down, (-y + room[1] * z).max())
        nearest, deepest = max(nearest, z.max()), max(deepest, -z.min())
    stand = max((reach_right + reach_left) / (2.0 * room[0]), (reach_up + reach_down) / (2.0 * room[1]))
    lowest, highest = reach_up - room[1] * stand, room[1] * stand - reach_down
    centre_x = 0.5 * (reach_right - reach_left)
    centre_y = lowest + headroom * (highest - lowest)
    return Camera(np.array([centre_x, centre_y, stand]) @ axes, axes, stand - 0.5 * (nearest - deepest), slopes)
