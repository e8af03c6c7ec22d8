"""The rest shape of strands: the groom itself, or one with which it hangs as groomed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from ringlet.data.quantities import Quantity
from ringlet.data.settings import Section
from ringlet.shot.variation import Mapped


class Rest(Section):
    """The rest shape of strands."""

    mode: Literal["none", "lofted", "equilibrium"] = Field(
        default="none",
        description="`none`: the groom, which then sags; or a shape made by `ringlet loft`: `lofted`, pre-bent as "
        "far as that goes, or `equilibrium`, balanced exactly, where locks that would fall over are "
        "stiffened",
    )
    gain: Annotated[Mapped, Quantity("", 0.0, 1.0)] = Field(
        default=Mapped(), description="in `lofted`, the fraction of the sag to remove, from 0 to 1"
    )
    stiffen: float = Field(
        default=8.0,
        ge=1.0,
        le=1e3,
        description="in `equilibrium`, the largest factor by which a lock is stiffened to stand",
    )
    spring: float = Field(
        default=0.5,
        ge=0.0,
        lt=1.0,
        description="in `equilibrium`, the fraction of its stiffness that a lock must keep under its weight; one "
        "that keeps less is stiffened",
    )
    iterations: int = Field(default=12, ge=1, le=1000, description="largest number of corrections of a loft")
    tolerance: Annotated[float, Quantity("m", 1e-9, 0.1)] = Field(
        default=2e-5, description="a lock is done when no vertex hangs further than this from its place in the groom"
    )
    file: Path | None = Field(
        default=None,
        description="file of the rest shape; by default next to the shot, `NAME.rest.usdc` for `NAME.shot.toml`",
    )
