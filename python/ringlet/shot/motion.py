"""Motion of locks in words that are given instead of their stiffness and damping."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from ringlet.data.quantities import Quantity, Varied
from ringlet.data.settings import Section

# The words, and the settings of the material that each is given instead of.
WORDS = {"bounce": "bend_scale", "settle": "damping"}


class WantedMotion(Section):
    """How locks bounce, at the steps of the shot and without contact, whatever their length, width and type."""

    bounce: Annotated[Varied | None, Quantity("Hz", 0.05, 200.0)] = Field(
        default=None,
        description="[Hz] frequency of a lock along itself, from root to tip, instead of `strands.bend_scale`; by "
        "default that of the material",
    )
    settle: Annotated[Varied | None, Quantity("s", 1e-3, 1e3)] = Field(
        default=None,
        description="[s] time until a bounce has gone to a twentieth, instead of `strands.damping`; by default that "
        "of the material",
    )
    seed: int = Field(default=1, ge=0, le=2**31, description="another seed gives `vary` and `noise` other values")
