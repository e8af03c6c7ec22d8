"""Messages of renders in place."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from ringlet.viewer.protocol.message import Coordinate, Light, Message, Row

Pixels = Annotated[int, Field(ge=16, le=4096)]


class Render(Message):
    """Path-traces what is seen, in place of the last render of the page; ``Rendered`` answers, step by step.

    number: of the render, for the answers
    camera: position and target [m], six numbers
    focal_length, light, light_turn: as in ``Shared``
    color:  a hair colour; empty for that of the groom
    """

    kind: Literal["render"] = "render"
    number: Row
    camera: list[Coordinate] = Field(min_length=6, max_length=6)
    width: Pixels
    height: Pixels
    samples: int = Field(default=32, ge=1, le=1024)
    focal_length: float = Field(default=85.0, ge=10.0, le=500.0)
    light: Light = "studio"
    light_turn: float = Field(default=0.0, ge=-360.0, le=360.0)
    color: str = Field(default="", max_length=64)


class StopRender(Message):
    """Cancels the render of the page."""

    kind: Literal["stop_render"] = "stop_render"


class Rendered(Message):
    """A render as it grows, a PNG. samples: per pixel so far, ``of`` so many; it is done with all of them."""

    kind: Literal["rendered"] = "rendered"
    number: int
    samples: int
    of: int
    arrays: ClassVar[dict[str, str]] = {"png": "u1"}
