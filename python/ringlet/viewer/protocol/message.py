"""The base of all messages, its version, and the types of fields."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import BaseModel, ConfigDict, Field

from ringlet.data import limits

VERSION = 15

Place = list[str | int]  # path of a setting in its file: ["shape", 0, "amount"]; empty for the file
File = Literal["recipe", "shot"]
Point = tuple[float, float, float]
Id = Annotated[int, Field(ge=-limits.ID, le=limits.ID)]
Row = Annotated[int, Field(ge=0, le=1_000_000)]
Gesture = Annotated[int, Field(ge=-limits.ID, le=limits.ID)]
FrameNumber = Annotated[float, Field(ge=-limits.FRAME, le=limits.FRAME)]
Coordinate = Annotated[float, Field(ge=-1e6, le=1e6)]  # [m]
Position = tuple[Coordinate, Coordinate, Coordinate]
EntryId = Annotated[str, Field(pattern=r"^[0-9A-Za-z-]{1,40}$")]
Light = Annotated[str, Field(max_length=256)]  # a rig, or the path of an HDRI in the folder of the project
Side = Literal["a", "b", "c", "d"]  # a look in the picture: the open recipe, and up to three that it is compared with


class Message(BaseModel):
    """Base of all messages; ``kind`` is the type."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)
    arrays: ClassVar[dict[str, str]] = {}


class Arranged(Message):
    """How the looks that are compared are arranged.

    order: sides of the looks, the first on the left
    front: the one that is seen where they are flipped
    wipe:  where the wipe is, as a fraction of the width that panels leave clear
    """

    arrangement: Literal["split", "wipe", "flip", "difference"]
    order: list[Side] = Field(min_length=1, max_length=4)
    front: Side
    wipe: float = Field(ge=0.0, le=1.0)


class Shared(Message):
    """How the leading page looks at the groom.

    camera: position and target [m], six numbers
    focal_length: of the lens, for a picture that is 36 mm high [mm]
    light, color, overlay: their choices on the page; empty for none
    light_turn: angle of the lights about the vertical [degrees]
    file, place: the stage whose settings are shown
    locks:  ids of the chosen locks
    frame:  the frame that is seen; None without a timeline
    looks:  arrangement of the looks that are compared; None for one look
    step:   step at which the take that is compared stands; None where it plays, and without one
    """

    camera: list[Coordinate] = Field(min_length=6, max_length=6)
    focal_length: float = Field(default=85.0, ge=10.0, le=500.0)
    light: Light
    light_turn: float = Field(default=0.0, ge=-360.0, le=360.0)
    color: str = Field(max_length=64)
    overlay: str = Field(max_length=64)
    file: File
    place: Place = Field(max_length=8)
    locks: list[Id] = Field(max_length=10_000)
    frame: FrameNumber | None = None
    looks: Arranged | None = None
    step: Row | None = None
