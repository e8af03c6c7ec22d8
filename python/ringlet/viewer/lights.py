"""The light rigs of pictures, as the live picture draws them: four round lamps at most, and even surroundings."""

from __future__ import annotations

from math import pi

from ringlet.picture import rigs, studio
from ringlet.viewer.protocol import Lamp, Rig

# The sun and the sky of ``rigs``, measured with white plates in Mitsuba. The strength is the irradiance of a plate that
# faces the sun; the radiance of an even sky is the mean irradiance of six plates along the axes, over π.
SUN_SIZE, SUN_STRENGTH, SKY = 0.0093, (11.63, 9.50, 6.90), (0.281, 0.420, 0.637)
FAR = 100.0  # distance of the sun: its light is the same everywhere


def live_rigs() -> dict[str, Rig]:
    """The rigs by the names that pictures have for them."""
    boxes = [
        Lamp(azimuth=one.azimuth, elevation=one.elevation, size=one.size, strength=one.strength)
        for one in studio.LIGHTS.values()
    ]
    window = Lamp(
        azimuth=rigs.WINDOW_PLACE[0],
        elevation=rigs.WINDOW_PLACE[1],
        size=2.0 * (rigs.WINDOW_SIZE[0] * rigs.WINDOW_SIZE[1] / pi) ** 0.5 / rigs.WINDOW_DISTANCE,  # as large a disk
        strength=rigs.WINDOW_STRENGTH,
        distance=rigs.WINDOW_DISTANCE,
    )
    sun = Lamp(
        azimuth=rigs.SUN_PLACE[0], elevation=rigs.SUN_PLACE[1], size=SUN_SIZE, strength=SUN_STRENGTH, distance=FAR
    )
    return {
        rigs.STUDIO: Rig(label="Studio", with_camera=True, ambient=studio.AMBIENT, lamps=boxes),
        rigs.WINDOW: Rig(label="Window", with_camera=False, ambient=rigs.ROOM, lamps=[window]),
        rigs.SUN: Rig(label="Sun", with_camera=False, ambient=SKY, lamps=[sun]),
    }
