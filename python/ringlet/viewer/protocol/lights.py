"""Light rigs, in the messages of the server."""

from __future__ import annotations

from ringlet.viewer.protocol.message import Message, Point


class Lamp(Message):
    """A round lamp that faces the subject.

    azimuth, elevation: from the camera or the front to the right, and upwards [degrees]
    size:     diameter, in units of its distance
    strength: irradiance of a surface that faces it (linear r, g, b)
    distance: from the subject, in units of that of a portrait camera
    """

    azimuth: float
    elevation: float
    size: float
    strength: Point
    distance: float = 1.0


class Rig(Message):
    """A light rig: its lamps, around the camera or the subject, and the radiance of the surroundings."""

    label: str
    with_camera: bool
    ambient: Point
    lamps: list[Lamp]
