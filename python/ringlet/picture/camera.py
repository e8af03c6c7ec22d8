"""Framing: the nearest position of a lens from which the subject fits the picture."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from math import asin, atan2, cos, degrees, isfinite, radians, sin

import numpy as np
from numpy.typing import NDArray

from ringlet.data import limits
from ringlet.data.camera import Camera
from ringlet.data.errors import UserError
from ringlet.data.picture import PictureSettings

# Azimuth from the front (+Z) to the subject's left (+X), and elevation of the camera [degrees].
VIEWS: dict[str, tuple[float, float]] = {
    "three_quarter": (34.0, 7.0),
    "front": (0.0, 4.0),
    "side": (90.0, 4.0),
    "back": (180.0, 8.0),
}
HIGHEST = 85.0  # largest elevation of a camera: from straight above, no direction is up [degrees]

FOCAL_LENGTH = 85.0  # of a portrait lens [mm]
SENSOR = 36.0  # long side of the sensor [mm]

MIDDLE = 0.1  # half the width of what a camera focuses on, in pictures


def angles(view: str | tuple[float, float]) -> tuple[float, float]:
    """Azimuth and elevation [degrees] of a view: a name of ``VIEWS``, a pair, or a pair as text, such as ``90,4``.

    Raises UserError for another name, and for an elevation of over 85°.
    """
    if isinstance(view, str) and view in VIEWS:
        return VIEWS[view]
    try:
        azimuth, elevation = map(float, view.split(",") if isinstance(view, str) else view)
    except ValueError:
        raise UserError(
            f"picture: there is no view '{view}'; choose one of {', '.join(VIEWS)}, or give two angles, such as 90,4"
        ) from None
    if not (isfinite(azimuth) and abs(azimuth) <= 360.0 and abs(elevation) <= HIGHEST):
        raise UserError(
            f"picture: view is {azimuth:g},{elevation:g}; the azimuth must be at most 360, the elevation {HIGHEST:g}"
        )
    return azimuth, elevation


def axes_of(azimuth: float, elevation: float) -> NDArray[np.float64]:
    """Axes of a camera at an azimuth and an elevation [degrees], as in Camera."""
    azimuth, elevation = radians(azimuth), radians(elevation)
    backward = np.array([sin(azimuth) * cos(elevation), sin(elevation), cos(azimuth) * cos(elevation)])
    right = np.array([cos(azimuth), 0.0, -sin(azimuth)])
    return np.stack([right, np.cross(backward, right), backward])


def angles_towards(direction: NDArray[np.floating]) -> tuple[float, float]:
    """View from a direction, shape (3,): azimuth and elevation [degrees]."""
    x, y, z = np.asarray(direction, np.float64) / max(float(np.linalg.norm(direction)), 1e-300)
    return degrees(atan2(x, z)), float(np.clip(degrees(asin(np.clip(y, -1.0, 1.0))), -HIGHEST, HIGHEST))


def frame(
    subject: Iterable[NDArray[np.floating]],
    *,
    view: str | tuple[float, float] = "three_quarter",
    aspect: float = 1.0,
    margin: float = 0.06,
    headroom: float = 0.4,
    focal_length: float = FOCAL_LENGTH,
) -> Camera:
    """Nearest camera of a view that sees every point of the subject.

    subject:      arrays of positions [m], each of shape (n, 3)
    view:         a name of ``VIEWS``, or azimuth and elevation [degrees]
    aspect:       width over height of the picture
    margin:       fraction of the width and height that stays free at each edge
    headroom:     fraction of the free height above the subject
    focal_length: [mm], of a lens before a sensor of 36 mm on its long side
    """
    axes, lens = axes_of(*angles(view)), 0.5 * SENSOR / focal_length
    slopes = (lens * min(aspect, 1.0), lens / max(aspect, 1.0))
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
    origin = np.array([centre_x, centre_y, distance]) @ axes
    return Camera(origin, axes, distance - 0.5 * (nearest - deepest), slopes, focal_length=1e-3 * focal_length)


def take_position(
    settings: PictureSettings,
    subject: Sequence[NDArray[np.floating]],
    lock: NDArray[np.floating] | None = None,
    given: Camera | None = None,
) -> Camera:
    """The camera of a picture.

    subject: what a portrait frames, arrays of positions [m], each of shape (n, 3)
    lock:    points of the lock that is looked at [m], shape (n, 3); None for a portrait
    given:   a camera of the stage, which is taken as it is, apart from its aperture and its focus

    Raises UserError for a view that there is not.
    """
    width, height = picture_size(settings, given)
    if given is None:
        given = _placed(settings, width / height, subject, lock)
    camera = replace(
        given,
        slopes=(given.slopes[0], given.slopes[0] * height / width),  # square pixels; the width has the aperture
        f_stop=given.f_stop if settings.f_stop is None else settings.f_stop,
        focus=given.focus if settings.focus is None else settings.focus,
    )
    if camera.f_stop and camera.focus is None:
        camera = replace(camera, focus=camera.distance if lock is not None else _nearest_in_the_middle(camera, subject))
    return camera


def picture_size(settings: PictureSettings, given: Camera | None = None) -> tuple[int, int]:
    """Width and height of a picture [pixels]; the proportions are those of a camera of the stage, or else 9 : 10."""
    aspect = given.aspect if given is not None else 0.9
    height = settings.height or round(settings.width / aspect)
    return settings.width, min(max(height, 1), limits.PIXELS)


def _placed(
    settings: PictureSettings,
    aspect: float,
    subject: Sequence[NDArray[np.floating]],
    lock: NDArray[np.floating] | None,
) -> Camera:
    """The camera of a portrait, or of a close-up of a lock."""
    view, aim = settings.view, subject if lock is None else [lock]
    if view is None:
        view = "three_quarter" if lock is None else angles_towards(lock.mean(axis=0) - _centre(subject))
    camera = frame(aim, view=view, aspect=aspect, focal_length=settings.focal_length or FOCAL_LENGTH)
    if settings.distance is None:
        return camera
    return replace(camera, origin=camera.target + settings.distance * camera.axes[2], distance=settings.distance)


def _centre(subject: Sequence[NDArray[np.floating]]) -> NDArray[np.float64]:
    """Middle of the bounding box of a subject [m], shape (3,)."""
    low = np.min([points.min(axis=0) for points in subject], axis=0)
    return 0.5 * (low + np.max([points.max(axis=0) for points in subject], axis=0)).astype(np.float64)


def _nearest_in_the_middle(camera: Camera, subject: Sequence[NDArray[np.floating]]) -> float:
    """Distance of the nearest points in the middle of the picture, or of the subject if there are none [m]."""
    depths = [camera.depths(points) for points in subject]
    before = [depth > 0 for depth in depths]
    middle = [
        depth[seen][(np.abs(camera.project(points[seen]) - 0.5) < MIDDLE).all(axis=1)]
        for points, depth, seen in zip(subject, depths, before, strict=True)
    ]
    near = np.concatenate(middle)
    return float(np.percentile(near, 2.0)) if len(near) else camera.distance
