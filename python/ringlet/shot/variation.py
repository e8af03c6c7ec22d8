"""Variation of the material: from root to tip by a ramp, over the head by a map, and from lock to lock by chance."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from ringlet.data.quantities import Quantity, Ramped
from ringlet.data.settings import Section

# What of the material may vary, and the setting of the material that each is a factor on.
VARIATIONS = {
    "radius": "radius",
    "stretch": "stretch_scale",
    "bend": "bend_scale",
    "twist": "twist_ratio",
    "damping": "damping",
    "drag": "drag",
}


class Mapped(Ramped):
    """A number, or a table ``{ value = …, ramp = [[0, 1], [1, 0.5]], map = "…", vary = …, noise = … }``: the product of
    all of it."""

    value: float = Field(default=1.0, description="the factor where nothing else changes it")
    map: str | None = Field(
        default=None,
        description="a primvar of floats that multiplies it: of the locks, or of the scalp at their roots",
    )


Factor = Annotated[Mapped, Quantity("", 0.0, 1e6)]


class Variation(Section):
    """Factors on the material of the strands, for each vertex of each lock."""

    radius: Factor = Field(default=Mapped(), description="factor on `strands.radius`")
    stretch: Factor = Field(default=Mapped(), description="factor on `strands.stretch_scale`")
    bend: Factor = Field(default=Mapped(), description="factor on `strands.bend_scale`")
    twist: Factor = Field(default=Mapped(), description="factor on `strands.twist_ratio`; the product is at most 1")
    damping: Factor = Field(default=Mapped(), description="factor on `strands.damping`")
    drag: Factor = Field(default=Mapped(), description="factor on `strands.drag`")
    seed: int = Field(default=1, ge=0, le=2**31, description="another seed gives `vary` and `noise` other values")
