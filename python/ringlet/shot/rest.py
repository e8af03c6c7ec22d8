"""The rest shape of strands: the groom itself, or one with which it hangs as groomed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from ringlet.data.quantities import Quantity
from ringlet.data.settings import Section
from ringlet.shot.variation import Mapped


class Rest(Section):
    """The shape that strands remember."""

    mode: Literal["none", "lofted", "equilibrium"] = Field(
        default="none",
        description="`none`: the groom, which then sags; or what `ringlet loft` made of it: `lofted`, pre-bent as far "
        "as it goes, or `equilibrium`, balanced exactly, what would fall over made stiffer",
    )
    gain: Annotated[Mapped, Quantity("", 0.0, 1.0)] = Field(
        default=Mapped(), description="in `lofted`, the part of the sag to take away, from 0 to 1"
    )
    stiffen: float = Field(
        default=8.0, ge=1.0, le=1e3, description="in `equilibrium`, how many times stiffer a lock may become to stand"
    )
    spring: float = Field(
        default=0.5,
        ge=0.0,
        lt=1.0,
        description="in `equilibrium`, the part of its stiffness that weight must leave a lock, or it is made stiffer",
    )
    iterations: int = Field(default=12, ge=1, le=1000, description="times that the loft is corrected at most")
    tolerance: Annotated[float, Quantity("m", 1e-9, 0.1)] = Field(
        default=2e-5, description="a lock is done when no vertex hangs farther than this from where it should"
    )
    file: Path | None = Field(
        default=None,
        description="the lofted shape; by default beside the shot, as `NAME.rest.usdc` for `NAME.shot.toml`",
    )
