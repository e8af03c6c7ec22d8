"""Light rigs: the studio, a window, the sun, or a picture of the surroundings (HDRI)."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, radians, sin
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError
from ringlet.data.reads import record
from ringlet.data.regular import check_regular
from ringlet.picture.engine import mitsuba
from ringlet.picture.studio import lights, rgb

STUDIO, WINDOW, SUN = "studio", "window", "sun"
RIGS = (STUDIO, WINDOW, SUN)
SUFFIXES = (".exr", ".hdr")

# The window: its size and its distance from the subject, in units of the subject's distance from a portrait camera;
# its azimuth and elevation [degrees]; and the irradiance of a surface that faces it (linear r, g, b).
WINDOW_SIZE, WINDOW_DISTANCE, WINDOW_PLACE = (0.9, 1.2), 1.0, (-62.0, 14.0)
WINDOW_STRENGTH, ROOM = (14.0, 15.0, 16.5), (0.3, 0.28, 0.26)

# The sun: azimuth and elevation [degrees], and the scale that brings the sky of a clear day to the studio's exposure.
SUN_PLACE, SKY_SCALE = (-40.0, 42.0), 8.0

# Mean radiance to which the surroundings are scaled: an HDRI has no unit.
SURROUNDINGS = 0.9


@dataclass(frozen=True)
class Rig:
    """Light around a subject. The studio stands around the camera; the others stand around the subject, front to +Z.

    name:     one of ``RIGS``, or an .exr or .hdr file
    turn:     angle about the vertical [degrees], counter-clockwise from above
    axes:     of the camera, the rows of a (3, 3) array
    centre:   of the subject [m], shape (3,)
    distance: of a portrait camera from the subject [m]
    only:     the one light that is on, by its name; all for None
    """

    name: str
    turn: float
    axes: NDArray[np.float64]
    centre: NDArray[np.float64]
    distance: float
    only: str | None = None

    @property
    def lights(self) -> list[str]:
        """Names of the lights."""
        return list(self._all(mitsuba(), np.zeros(3), 1.0))

    def emitters(self, mi: Any, origin: NDArray[np.float64], scale: float) -> dict[str, Any]:
        """Mitsuba emitters and shapes that are on; ``origin`` [m] and ``scale`` take positions to the scene."""
        found = self._all(mi, origin, scale)
        return found if self.only is None else {self.only: found[self.only]}

    def _all(self, mi: Any, origin: NDArray[np.float64], scale: float) -> dict[str, Any]:
        centre, distance = (self.centre - origin) * scale, self.distance * scale
        if self.name == STUDIO:
            return lights(mi, self.axes @ about_the_vertical(-self.turn), distance, centre)
        if self.name == WINDOW:
            return _window(mi, centre, distance, self.turn)
        if self.name == SUN:
            return _sun(mi, self.turn)
        return _surroundings(mi, Path(self.name), self.turn)


def check_rig(name: str) -> None:
    """Raises UserError for a rig that there is not, and for an HDRI that is no file."""
    if name in RIGS:
        return
    path = Path(name)
    if path.suffix.lower() not in SUFFIXES:
        raise UserError(
            f"picture: there is no light '{name}'; choose one of {', '.join(RIGS)}, or an .exr or .hdr file"
        )
    if not path.is_file():
        raise UserError(f"{path}: there is no such file; check the name")
    check_regular(path, "give an .exr or .hdr file")


def about_the_vertical(degrees: float) -> NDArray[np.float64]:
    """Rotation about +Y, counter-clockwise from above, as a matrix for columns, shape (3, 3)."""
    c, s = cos(radians(degrees)), sin(radians(degrees))
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def _direction(azimuth: float, elevation: float) -> NDArray[np.float64]:
    """Direction at an azimuth from +Z to +X and an elevation [degrees], shape (3,)."""
    a, e = radians(azimuth), radians(elevation)
    return np.array([sin(a) * cos(e), sin(e), cos(a) * cos(e)])


def _window(mi: Any, centre: NDArray[np.float64], distance: float, turn: float) -> dict[str, Any]:
    """One large, cool light from the side, in a room that reflects a little of it."""
    place = centre + WINDOW_DISTANCE * distance * _direction(WINDOW_PLACE[0] + turn, WINDOW_PLACE[1])
    half = [0.5 * side * distance for side in WINDOW_SIZE]
    solid_angle = WINDOW_SIZE[0] * WINDOW_SIZE[1] / WINDOW_DISTANCE**2
    shape = {
        "type": "rectangle",
        "to_world": mi.ScalarTransform4f().look_at(origin=list(place), target=list(centre), up=[0, 1, 0])
        @ mi.ScalarTransform4f().scale([half[0], half[1], 1.0]),
        "emitter": {"type": "area", "radiance": rgb([s / solid_angle for s in WINDOW_STRENGTH])},
    }
    return {"room": {"type": "constant", "radiance": rgb(ROOM)}, "window": shape}


def _sun(mi: Any, turn: float) -> dict[str, Any]:
    """The sun and a clear sky over the ground, after Hosek and Wilkie 2012."""
    sky = {
        "type": "sunsky",
        "sun_direction": list(_direction(SUN_PLACE[0] + turn, SUN_PLACE[1])),
        "turbidity": 3.0,
        "sun_scale": SKY_SCALE,
        "sky_scale": SKY_SCALE,
        "to_world": mi.ScalarTransform4f().rotate([1, 0, 0], -90.0),  # from Z up
    }
    return {"sky": sky}


def read_surroundings(path: Path) -> NDArray[np.float32]:
    """Radiance of an HDRI in latitude and longitude, at the exposure of the other rigs.

    Linear r, g, b, shape (height, width, 3); the middle of the picture is in front of the subject, at +Z.

    Raises UserError for a file that is no such picture.
    """
    mi = mitsuba()
    check_rig(str(path))
    record(path)
    try:
        bitmap = mi.Bitmap(str(path)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, srgb_gamma=False)
    except Exception as error:
        raise UserError(f"{path}: cannot be read as a picture ({error}); give an .exr or .hdr file") from None
    pixels = np.array(bitmap, np.float64)
    if not np.isfinite(pixels).all() or pixels.min() < 0.0 or pixels.max() <= 0.0:
        raise UserError(f"{path}: has light that is negative or no number, or none at all; export it again")
    rows = np.sin(np.pi * (np.arange(len(pixels)) + 0.5) / len(pixels))[:, None]  # a row near a pole is a small circle
    mean = (rows * (pixels @ (0.2126, 0.7152, 0.0722))).mean() / rows.mean()
    return (SURROUNDINGS / mean * pixels).astype(np.float32)


def _surroundings(mi: Any, path: Path, turn: float) -> dict[str, Any]:
    """An HDRI around the subject."""
    return {
        "surroundings": {
            "type": "envmap",
            "bitmap": mi.Bitmap(read_surroundings(path)),
            "to_world": mi.ScalarTransform4f().rotate([0, 1, 0], turn),
        }
    }
