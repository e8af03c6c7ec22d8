"""Messages about maps that are painted and lines that are drawn on the scalp."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import Field

from ringlet.viewer.protocol.message import Gesture, Message, Place, Position


class ShowMap(Message):
    """Requests the map that a setting names, as painted values on the scalp.

    place: of the setting in the recipe, such as ``["guides", "length", "map"]``
    """

    kind: Literal["show_map"] = "show_map"
    place: Place = Field(min_length=1, max_length=8)


class Stroke(Message):
    """Moves a brush.

    at, by:   position of the brush, and its displacement since the last message of this gesture [m]
    radius:   radius of the brush [m]
    mirrored: whether a mirror image of the brush acts on the other side of the head
    falloff:  of the strength towards the radius: smooth, sharp (steep at the centre) or flat (none)
    """

    at: Position
    by: Position
    radius: float = Field(gt=0.0, le=1.0)
    mirrored: bool = False
    strength: float = Field(default=1.0, gt=0.0, le=1.0)
    falloff: Literal["smooth", "sharp", "flat"] = "smooth"
    gesture: Gesture
    resting: bool = True


class Paint(Stroke):
    """Moves a brush over the scalp, which changes the map that a setting names; a setting without one gets a new map.

    tool:     add goes to white (1), remove to black (0) or no direction, smooth to the mean around, comb to the
              direction in which the brush moves
    strength: fraction of the way that one pass of the brush goes at its centre
    """

    kind: Literal["paint"] = "paint"
    place: Place = Field(min_length=1, max_length=8)
    tool: Literal["add", "remove", "smooth", "comb"]


class Draw(Message):
    """Draws the helper curve that a setting names; a setting without one gets a new curve, a list one more.

    place:  of the setting in the recipe, such as ``["guides", "part_line", "curve"]``
    points: of the stroke [m]
    """

    kind: Literal["draw"] = "draw"
    place: Place = Field(min_length=1, max_length=8)
    points: list[Position] = Field(min_length=2, max_length=5000)
    gesture: Gesture


class Painted(Message):
    """A map on the scalp: its value at each point of the mesh of the region, 255 for white.

    map: its name; empty for a setting that names none yet
    directions: those of a map of directions at each point, whose lengths are the values; empty for another map
    """

    kind: Literal["painted"] = "painted"
    map: str
    arrays: ClassVar[dict[str, str]] = {"points": "f4", "triangles": "u4", "values": "u1", "directions": "f4"}
