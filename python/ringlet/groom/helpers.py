"""Helper curves: curves that guide operators without being hair, such as part lines and ties."""

from __future__ import annotations

from typing import Annotated, ClassVar

import numpy as np
from pydantic import BeforeValidator, Field, ValidationInfo, model_validator

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, refuse
from ringlet.groom.source import OF_SPACE, Source

FAR = Quantity("m", -1000.0, 1000.0)  # of a coordinate


def _to_metres(place: object, info: ValidationInfo) -> object:
    """Converts three lengths to metres; a plain number is in the unit of the recipe."""
    unit = (info.context or {}).get("unit", 1.0)
    return [FAR.number(x, unit) for x in place] if isinstance(place, list | tuple) else place


Coordinate = Annotated[float, Field(ge=FAR.least, le=FAR.most)]
Place = Annotated[tuple[Coordinate, Coordinate, Coordinate], BeforeValidator(_to_metres)]


Name = Annotated[str, Field(min_length=1)]
Names = Name | Annotated[list[Name], Field(min_length=1)]  # of helper curves, whose curves are taken together


class HelperCurves(Source):
    """Curves that guide operators: points given here, or curves of a file."""

    of_file: ClassVar[tuple[str, ...]] = (*OF_SPACE, "prim")
    of_shape: ClassVar[tuple[str, ...]] = ("points",)

    points: list[Place] | None = Field(default=None, description="[x, y, z] of the points of a curve, Y up")
    file: str | None = Field(
        default=None, description="USD, OBJ or .hair file with the curves, next to the recipe or with a full path"
    )
    prim: str | None = Field(default=None, description="prim of the curves; needed when the file has several")

    @model_validator(mode="after")
    def _one_source(self) -> HelperCurves:
        if (self.points is None) == (self.file is None):
            raise refuse("needs either 'points' or a 'file'; give one of them")
        if self.points is not None and len(self.points) < 2:
            raise refuse(f"has {len(self.points)} point(s); give at least 2")
        return self

    def inline_curve(self) -> Curves | None:
        """The curve of the inline points; None when the curves are in a file."""
        return None if self.points is None else Curves.from_list([np.array(self.points)])
