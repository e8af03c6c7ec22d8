"""Messages of the server with what the picture shows: bodies, grooms, their measurements, and frames."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

from ringlet.viewer.protocol.message import Message, Point, Side


class Subject(Message):
    """Bounds of the skin that hair is to grow on [m]: known before the groom, so that the picture shows them first."""

    kind: Literal["subject"] = "subject"
    low: Point
    high: Point


class Body(Message):
    """A mesh of the scene, the one of ``index`` among ``of``, which come one after another and are shown together.

    made_of: its material: skin, eye, cloth or matte
    """

    kind: Literal["body"] = "body"
    index: int
    of: int
    name: str
    made_of: str
    color: Point
    arrays: ClassVar[dict[str, str]] = {"points": "f4", "triangles": "u4", "colors": "f4"}


class Locks(Message):
    """Positions of the locks. side: a, or another for a groom to compare with.

    ``axis`` (locks, 3) is the reference direction of each lock; ``marked`` is 1 for isolated locks. ``window`` is the
    number of points in a turn of each lock's coil; empty where hairs only follow their lock.
    """

    kind: Literal["locks"] = "locks"
    side: Side
    draft: bool
    arrays: ClassVar[dict[str, str]] = {
        "points": "f4",
        "offsets": "i4",
        "ids": "f8",
        "axis": "f4",
        "marked": "u1",
        "window": "i4",
    }


class Guides(Message):
    """Positions of the guides; ``changed`` is 1 for sculpted ones, ``frozen`` for those that brushes leave."""

    kind: Literal["guides"] = "guides"
    middle: Point
    arrays: ClassVar[dict[str, str]] = {"points": "f4", "offsets": "i4", "changed": "u1", "frozen": "u1"}


class Names(Message):
    """Valid names in settings: regions, maps and directions of the scalp, and helper curves."""

    kind: Literal["names"] = "names"
    regions: list[str]
    maps: list[str]
    vectors: list[str]
    curves: list[str]


class Hairs(Message):
    """Hairs relative to their locks; see ``src/ringlet/groom/hairs.h`` for the formula.

    Any prefix is as large a part of each lock. ``profile``, ``hold``, ``pace``, ``blend`` and ``thinning`` are
    functions along the hairs of each groom, one groom after another; ``group`` is the groom of a hair. ``frizz`` has
    ``knots`` × 2 numbers a hair; ``root`` is the offset from the lock's root to the hair's. The diameter is ``width``
    of the hair times ``thinning``. The arrays from ``slip`` on are those of the curl of hairs; empty where these only
    follow their lock.
    """

    kind: Literal["hairs"] = "hairs"
    side: Side
    count: int
    points: int
    knots: int
    arrays: ClassVar[dict[str, str]] = {
        "lock": "u4",
        "group": "u1",
        "offset": "f4",
        "tip": "f4",
        "join": "f4",
        "flat": "f4",
        "taper": "f4",
        "other": "i4",
        "share": "f4",
        "frizz": "f4",
        "root": "f4",
        "profile": "f4",
        "hold": "f4",
        "pace": "f4",
        "blend": "f4",
        "width": "f4",
        "thinning": "f4",
        **dict.fromkeys(("slip", "escape", "relax", "family", "coil", "phase"), "f4"),
        **dict.fromkeys(("escaping", "relaxing", "tight", "opening"), "f4"),
    }


class Colors(Message):
    """Colours of the hairs, in the order of ``Hairs``; none where the groom has no colour.

    ``reflectance`` holds red, green and blue of each of the ``stations`` of each hair, evenly spaced from root to tip:
    the fourth root of the linear reflectance (``ringlet.data.pigment``), times 255. tilt: of the cuticle [degrees].
    """

    kind: Literal["colors"] = "colors"
    side: Side
    stations: int
    roughness: float
    azimuthal_roughness: float
    tilt: float
    arrays: ClassVar[dict[str, str]] = {"reflectance": "u1"}


class Numbers(Message):
    """Statistics of the groom. revision: of the displayed recipe; times: times of the computed stages [ms]."""

    kind: Literal["numbers"] = "numbers"
    revision: int
    locks: int
    hairs: int
    groom_ms: float
    times: dict[str, float]
    draft: bool


class Measured(Message):
    """Measurements of a groom that is not a draft. inside: number of lock points in the head.

    ``depth`` and ``pin`` are overlays: a byte for each point of the locks, 255 for the end of the scale; empty for
    none.
    """

    kind: Literal["measured"] = "measured"
    inside: int
    arrays: ClassVar[dict[str, str]] = {"depth": "u1", "pin": "u1"}


class Frame(Message):
    """A frame of the shot or of a cache. layer: ``shot``, or ``against`` for the cache to compare with.

    ``drawn`` lists hairs, in the order of ``Hairs``, that are pulled towards their lock to stay out of bodies. ``left``
    is the fraction of their offset that remains at each of their points, 255 for all of it. ``stretch``, ``contact``,
    ``depth`` and ``curl`` are overlays (see ``Measured``); an unknown one is empty.
    """

    kind: Literal["frame"] = "frame"
    layer: Literal["shot", "against"]
    frame: float
    statistics: dict[str, Any]
    arrays: ClassVar[dict[str, str]] = {
        "points": "f4",
        "axis": "f4",
        "root": "f4",
        "drawn": "u4",
        "left": "u1",
        "bodies": "f4",
        "stretch": "u1",
        "contact": "u1",
        "depth": "u1",
        "curl": "u1",
    }
