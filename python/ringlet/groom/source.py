"""Where meshes and curves of a recipe come from: a file, read with its settings, or a shape that is given in place."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar, Literal, Self

from pydantic import Field, model_validator

from ringlet.data.lengths import UNITS
from ringlet.data.quantities import LengthUnit, Section, refuse
from ringlet.data.stage import StageSpace

STORING = (".usd", ".usda", ".usdc", ".usdz")  # formats that store their unit and up axis
OF_SPACE = ("unit", "up")


class Source(Section):
    """Unit and up axis of another file than USD, which stores its own."""

    of_file: ClassVar[tuple[str, ...]] = OF_SPACE  # settings that say how a file is read
    of_shape: ClassVar[tuple[str, ...]] = ()  # settings of the shape that is given in place of a file

    unit: LengthUnit | None = Field(
        default=None, description="unit of a file of another format than USD; m when absent"
    )
    up: Literal["Y", "Z"] | None = Field(default=None, description="axis that is up in such a file; Y when absent")

    @model_validator(mode="after")
    def _settings_fit_source(self) -> Self:
        file: str | None = getattr(self, "file", None)
        unused = self.of_shape if file is not None else self.of_file if self.of_shape else ()
        if file is not None and Path(file).suffix.lower() in STORING:
            unused = (*unused, *OF_SPACE)
        if given := [name for name in unused if getattr(self, name) != type(self).model_fields[name].default]:
            if file is None:
                lengths = ', and write lengths as "5 cm"' if given[0] == "unit" else ""
                raise refuse(f"has '{given[0]}', but no file that it is for; take it out{lengths}")
            reason = "stores its own" if given[0] in OF_SPACE else "has that of its own"
            raise refuse(f"has '{given[0]}', but {Path(file).name} {reason}; take it out")
        return self

    @property
    def space(self) -> StageSpace:
        """The coordinate space of such a file."""
        return StageSpace(UNITS[self.unit or "m"], self.up or "Y")
