"""Messages about presets: to list them, to try and to take one, and to keep settings as one."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ringlet.viewer.protocol.message import Gesture, Message

Part = Annotated[float, Field(ge=0.0, le=1.0)]
Name = Annotated[str, Field(max_length=240)]


class ListPresets(Message):
    """Requests the presets, which the page then receives."""

    kind: Literal["list_presets"] = "list_presets"


class Try(Message):
    """Shows the groom with a preset, which leaves no trace in the file or in undo; without a name, as it was.

    part: 0 for the groom as it is, 1 for the preset
    """

    kind: Literal["try"] = "try"
    name: Name = ""
    part: Part = 1.0


class Take(Message):
    """Takes a preset; all messages of a gesture are one undo step, each relative to the state before it."""

    kind: Literal["take"] = "take"
    name: Name
    part: Part = 1.0
    gesture: Gesture
    resting: bool = True


class Keep(Message):
    """Keeps tables of the recipe as a preset of the project. picture: data URL of a JPEG; empty for none"""

    kind: Literal["keep"] = "keep"
    name: str = Field(max_length=120)
    tables: list[str] = Field(max_length=32)
    picture: str = Field(default="", max_length=600_000)


class Preset(Message):
    """A preset. whole: whether it is a look, which replaces all tables; picture: data URL, empty for none"""

    name: str
    title: str
    about: str
    whole: bool
    picture: str


class Presets(Message):
    """The presets of the project, then the looks that come with Ringlet."""

    kind: Literal["presets"] = "presets"
    presets: list[Preset]
