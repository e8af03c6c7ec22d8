"""Motion of locks in words that are given instead of their stiffness and damping."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, ValidationInfo, field_validator, model_validator

from ringlet.data.quantities import Quantity, Varied
from ringlet.data.settings import Section, refuse
from ringlet.shot.motion_presets import PRESETS, Preset
from ringlet.shot.variation import Mapped

# The words, and the settings of the material that each is given instead of.
WORDS = {"bounce": "bend_scale", "sag": "bend_scale", "swing": "bend_scale", "settle": "damping"}
STIFFNESS = ("bounce", "sag", "swing")  # words that each say how stiff locks are


class Wanted(Varied):
    """A word that may differ from lock to lock. A number, or a table ``{ value = …, of_hair = true, vary = …, noise =
    …, map = "…", region = { name = … }, lock = { id = … } }``."""

    of_hair: bool = Field(
        default=False,
        description="count the values as factors on what each lock has by its material, weight and air; 0.67 is a "
        "third less",
    )


class WantedMotion(Section):
    """How locks move, at the steps of the shot and without contact, whatever their length, width and type.

    One of bounce, sag and swing is given; the stiffness with which a lock shows it decides the others.
    """

    preset: Preset | None = Field(default=None, description="character of motion; fills what is not given here")
    bounce: Annotated[Wanted | None, Quantity("Hz", 0.05, 200.0)] = Field(
        default=None,
        description="[Hz] frequency of a lock along itself, from root to tip, instead of `strands.bend_scale`; by "
        "default that of the material",
    )
    sag: Annotated[Wanted | None, Quantity("", 1e-3, 10.0)] = Field(
        default=None,
        description="how much longer a lock hangs along its coil than it is groomed, as a fraction, instead of "
        '`strands.bend_scale`; only with `rest.mode = "none"`',
    )
    swing: Annotated[Wanted | None, Quantity("Hz", 0.05, 200.0)] = Field(
        default=None,
        description="[Hz] frequency of the whole lock sideways, instead of `strands.bend_scale`; by default that of "
        "the material",
    )
    settle: Annotated[Wanted | None, Quantity("s", 1e-3, 1e3)] = Field(
        default=None,
        description="[s] time until a bounce has gone to a twentieth, instead of `strands.damping`; by default that "
        "of the material",
    )
    weight: Annotated[Mapped, Quantity("", 0.01, 1e3)] = Field(
        default=Mapped(),
        description="factor on the mass of the locks, which keep their stiffness: wet hair has 1.5 to 2, beads weigh "
        "at the tip",
    )
    air: Annotated[Mapped, Quantity("", 0.0, 1e4)] = Field(
        default=Mapped(),
        description="factor on the air drag of the locks, `strands.drag`: light frizz has 2 to 5",
    )
    seed: int = Field(default=1, ge=0, le=2**31, description="another seed gives `vary` and `noise` other values")

    @model_validator(mode="before")
    @classmethod
    def _with_preset(cls, data: Any) -> Any:
        if not isinstance(data, dict):
            return data
        preset = PRESETS.get(str(data.get("preset")), {})
        if any(data.get(name) is not None for name in STIFFNESS):
            preset = {name: value for name, value in preset.items() if name not in STIFFNESS}
        return {**preset, **data}

    @field_validator("sag", "swing")
    @classmethod
    def _one_decides_the_stiffness(cls, word: Wanted | None, info: ValidationInfo) -> Wanted | None:
        for name in ("bounce", "sag"):
            if word is not None and (other := info.data.get(name)) is not None:
                raise refuse(
                    f"is {word.value:g}, but {name} is {other.value:g}, and both say how stiff locks are; take one of "
                    "them away"
                )
        return word

    @property
    def given(self) -> tuple[str, ...]:
        """The words that are given."""
        return tuple(name for name in WORDS if getattr(self, name) is not None)
