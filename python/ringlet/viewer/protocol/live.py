"""Messages of live hair: what moves it, and its rods step by step."""

from __future__ import annotations

from typing import ClassVar, Literal

from ringlet.viewer.protocol.message import Message, Point


class GoLive(Message):
    """Lets the displayed groom move live, or puts it at rest."""

    kind: Literal["go_live"] = "go_live"
    on: bool


class Live(Message):
    """Whether hair moves live. fps: steps a second; 0 while the first one is being prepared."""

    kind: Literal["live"] = "live"
    on: bool
    fps: float = 0.0


class Rods(Message):
    """The rods that carry locks in live motion, as groomed.

    key:   changes with the groom
    pivot: about which the head turns on its neck [m]

    ``points`` are their vertices, ``along`` the places of these on a lock, from 0 at its root to 1; ``axis`` is a
    direction across the root of each rod, and ``carrier`` the rod of each lock.
    """

    kind: Literal["rods"] = "rods"
    key: int
    pivot: Point
    arrays: ClassVar[dict[str, str]] = {"points": "f4", "along": "f4", "axis": "f4", "carrier": "u4"}


class LiveStep(Message):
    """A step of live hair: where the vertices of its rods are.

    key:   of the rods
    step:  its number, also of those that were left out so that time goes on
    head:  rigid motion of the head since it was groomed, the rows of a 3 × 4 matrix
    trunk: shift of what is below the neck [m]
    note:  what was cut off; empty for nothing

    ``worn`` are points of what the hair wears, the last of the bodies.
    """

    kind: Literal["live_step"] = "live_step"
    key: int
    step: int
    head: list[float]
    trunk: Point
    note: str = ""
    arrays: ClassVar[dict[str, str]] = {"points": "f4", "worn": "f4"}
