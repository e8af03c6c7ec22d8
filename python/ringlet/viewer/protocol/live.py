"""Messages of live hair: what moves it, and its rods step by step."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from ringlet.viewer.protocol.message import EntryId, Message, Point, Position, Side

Angle = Annotated[float, Field(ge=-10.0, le=10.0)]  # [rad]


class GoLive(Message):
    """Lets the displayed groom move live, or puts it at rest."""

    kind: Literal["go_live"] = "go_live"
    on: bool


class HoldHead(Message):
    """A hand holds the head of live hair, or lets go.

    turn: rotation vector from where it was groomed [rad]; None to let go
    shift: of all of the body [m]
    """

    kind: Literal["hold_head"] = "hold_head"
    turn: tuple[Angle, Angle, Angle] | None
    shift: Position = (0.0, 0.0, 0.0)


class TouchHair(Message):
    """A hand touches live hair, or lets go.

    does:   what it does; None to let go
    at:     where it is [m]
    radius: of a comb, or of the palm [m]
    """

    kind: Literal["touch_hair"] = "touch_hair"
    does: Literal["pull", "comb", "pat"] | None
    at: Position = (0.0, 0.0, 0.0)
    radius: float = Field(default=0.04, gt=0.0, le=0.5)


class MoveHead(Message):
    """Plays a motion of the head of live hair; ``walk`` and ``clip``, that of the shot, stop where they play."""

    kind: Literal["move_head"] = "move_head"
    motion: Literal["nod", "turn", "shake", "hop", "walk", "clip"]


class Blow(Message):
    """Lets wind blow from a side of the head, or ends it."""

    kind: Literal["blow"] = "blow"
    side: Literal["", "left", "right", "front", "back"]


class Live(Message):
    """Whether hair moves live.

    fps:   steps a second; 0 while the first one is being prepared
    goes_on: motions that play until they are stopped
    wind:  side that it blows from; empty for none
    contact: where the stiffness that contact adds is from; empty while that is not known
    """

    kind: Literal["live"] = "live"
    on: bool
    fps: float = 0.0
    goes_on: list[str] = Field(default_factory=list)
    wind: str = ""
    contact: str = ""


class Rods(Message):
    """The rods that carry locks in live motion, as groomed.

    side:  of their groom: ``a``, or another for one that is compared
    key:   changes with the groom
    pivot: about which the head turns on its neck [m]

    ``points`` are their vertices, and ``along`` the places of these on a lock, from 0 at its root to 1. ``axis`` is a
    direction across the root of each rod, and ``rise`` its length by that of its lock. ``ids`` are those of the locks,
    and ``carrier`` the rod of each.
    """

    kind: Literal["rods"] = "rods"
    side: Side = "a"
    key: int
    pivot: Point
    arrays: ClassVar[dict[str, str]] = {
        "points": "f4",
        "along": "f4",
        "axis": "f4",
        "rise": "f4",
        "ids": "f8",
        "carrier": "u4",
    }


class LiveStep(Message):
    """A step of live hair: where the vertices of its rods are.

    side:  of the rods
    key:   of the rods
    step:  its number, also of those that were left out so that time goes on
    head:  rigid motion of the head since it was groomed, the rows of a 3 × 4 matrix
    trunk: shift of what is below the neck [m]
    note:  what was cut off; empty for nothing

    ``worn`` are points of what the hair wears, the last of the bodies.
    """

    kind: Literal["live_step"] = "live_step"
    side: Side = "a"
    key: int
    step: int
    head: list[float]
    trunk: Point
    note: str = ""
    arrays: ClassVar[dict[str, str]] = {"points": "f4", "worn": "f4"}


class LiveTake(Message):
    """A take of live hair that is compared, which pages play; see ``ringlet.viewer.show.live_take``.

    id:    of its snapshot
    fps:   steps a second
    first: frame of the open shot at which it begins; None for a take of another motion
    pivot: about which the head turns on its neck [m]
    unit:  length of a part, in which ``moved`` and ``worn`` are [m]

    ``points``, ``along``, ``axis``, ``rise``, ``ids`` and ``carrier`` are as in ``Rods``. Of each of the ``steps``, by
    their numbers, ``heads`` has 12 numbers and ``trunks`` 3, as in ``LiveStep``. ``moved`` is the way of each vertex
    from where it was groomed, ``worn`` the points of what hair wears, both in the frame of the head.
    """

    kind: Literal["live_take"] = "live_take"
    side: Side
    id: EntryId
    fps: float
    first: int | None
    pivot: Point
    unit: float
    arrays: ClassVar[dict[str, str]] = {
        **dict.fromkeys(("points", "along", "axis", "rise"), "f4"),
        "ids": "f8",
        "carrier": "u4",
        "steps": "i4",
        **dict.fromkeys(("heads", "trunks"), "f4"),
        **dict.fromkeys(("moved", "worn"), "i2"),
    }
