"""Quantities of recipes: lengths with units, values that vary from lock to lock, ramps; readable errors."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Annotated, Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray
from pydantic import (
    AfterValidator,
    BaseModel,
    Field,
    FiniteFloat,
    ValidationError,
    ValidationInfo,
    WithJsonSchema,
    model_validator,
)
from pydantic_core import PydanticCustomError, core_schema

from ringlet.data import explain as messages
from ringlet.data import settings
from ringlet.data.errors import UserError
from ringlet.data.explain import Location, shown
from ringlet.data.lengths import UNITS, measure
from ringlet.data.random import Random
from ringlet.data.settings import refuse

MAX_FACTOR = 1e6  # of a ramp
LengthUnit = Literal["m", "dm", "cm", "mm", "in"]
PER_CM2 = "/cm2"  # unit of a density


class Section(settings.Section):
    """A table of the recipe. A value that is given without its variation or ramp keeps those of the default."""

    @model_validator(mode="before")
    @classmethod
    def _with_defaults(cls, data: Any) -> Any:
        if isinstance(data, dict):
            own, data = _stated_defaults(cls), dict(data)
            for name, default in cls.defaults(data).items():
                if name not in data:  # a default of the class is read already
                    data[name] = cls.model_fields[name].default if default is own.get(name) else default
                elif isinstance(default, dict) and not isinstance(given := data[name], BaseModel):
                    data[name] = {**default, **(given if isinstance(given, dict) else {"value": given})}
        return data

    @classmethod
    def defaults(cls, data: dict[str, Any]) -> dict[str, Any]:
        """The values of settings that ``data`` lacks, as a recipe states them."""
        return dict(_stated_defaults(cls))


@cache
def _stated_defaults(section: type[Section]) -> dict[str, dict[str, Any]]:
    """The default tables of varied settings, as a recipe states them."""
    varied = {name: field for name, field in section.model_fields.items() if isinstance(field.default, Varied)}
    return {name: _as_stated(field.default, field.metadata) for name, field in varied.items()}


def _as_stated(value: Varied, metadata: list[Any]) -> dict[str, Any]:
    said = value.model_dump(exclude_unset=True)
    if any(isinstance(part, Quantity) and part.unit == "m" for part in metadata):
        said["value"] = f"{said['value']!r} m"
    return said


@dataclass(frozen=True)
class Quantity:
    """The unit and bounds of a setting. Unit ``m``: a number counts in the recipe's unit, a text carries its own, as in
    ``"5 mm"``. Unit ``/cm2``: a number, or a text with that unit.

    product: whether the bounds also count for the value times its ramp; not where an operator bounds or normalises that
    """

    unit: str
    least: float
    most: float
    product: bool = True

    @staticmethod
    def of(owner: BaseModel, name: str) -> Quantity:
        """The quantity of a setting of a model."""
        return next(part for part in type(owner).model_fields[name].metadata if isinstance(part, Quantity))

    @property
    def is_part(self) -> bool:
        """Whether values are parts of a whole, up to 1."""
        return not self.unit and self.most <= 1.0

    @property
    def suffix(self) -> str:
        """The unit after a number, in messages."""
        return f" {self.unit}" if self.unit else ""

    def number(self, value: Any, unit: float) -> float:
        """``value`` in SI, within the bounds."""
        number = self._measure(value) if isinstance(value, str) else value
        if isinstance(number, bool) or not isinstance(number, int | float):
            example = {
                "m": f' or a length such as "5 mm", in {", ".join(UNITS)}',
                PER_CM2: ' or a density such as "120 /cm2"',
            }
            raise refuse(f"is {shown(value)}; must be a number" + example.get(self.unit, ""))
        try:
            number = float(number) * (unit if self.unit == "m" and not isinstance(value, str) else 1.0)
        except OverflowError:  # a whole number that no float holds
            number = math.inf if number > 0 else -math.inf
        said = f"{number:.6g}{self.suffix}" if math.isfinite(number) else shown(value)
        if math.isnan(number):
            raise refuse("is nan; must be finite")
        if number < self.least:
            raise refuse(f"is {said}; must be at least {self.least:.6g}{self.suffix}")
        if number > self.most:
            raise refuse(f"is {said}; must be at most {self.most:.6g}{self.suffix}")
        return number

    def _measure(self, text: str) -> float | None:
        """A length such as ``5 mm``, in metres, or a density such as ``120 /cm2``; None for other text."""
        units = {"m": UNITS, PER_CM2: {PER_CM2: 1.0}}.get(self.unit, {})
        return measure(text, units)

    def clipped(self, values: NDArray, peak: float = 1.0) -> NDArray[np.float64]:
        """Values within the bounds, also times the peak of a ramp; same shape."""
        return np.clip(values, self.least, self.most / max(peak, 1.0))

    def exceeded(self, values: NDArray) -> NDArray[np.bool_]:
        """Mask of values beyond the bounds on their size, but for rounding; same shape."""
        largest = max(self.most, -self.least)
        return ~(np.abs(values) <= (1.0 + 1e-9) * largest)

    def _read(self, value: Any, table: bool, info: ValidationInfo) -> Any:
        unit = (info.context or {}).get("unit", 1.0)
        if value is None or isinstance(value, BaseModel):
            return value
        if table and isinstance(value, dict):
            read = {**value, "value": self.number(value["value"], unit)} if "value" in value else {**value}
            for kind in ("region", "lock"):
                if isinstance(given := value.get(kind), dict):
                    read[kind] = {name: self._of(kind, name, number, unit) for name, number in given.items()}
            return read
        number = self.number(value, unit)
        return {"value": number} if table else number

    def _of(self, kind: str, name: str, value: Any, unit: float) -> float:
        """The value for one region or lock."""
        try:
            return self.number(value, unit)
        except PydanticCustomError as error:
            raise refuse(f"for {kind} '{name}' {error.message()}") from None

    def __get_pydantic_core_schema__(
        self, source: Any, handler: Callable[[Any], core_schema.CoreSchema]
    ) -> core_schema.CoreSchema:
        table = any(isinstance(kind, type) and issubclass(kind, Section) for kind in (source, *get_args(source)))
        read = core_schema.with_info_before_validator_function(
            lambda value, info: self._read(value, table, info), handler(source)
        )
        return core_schema.no_info_after_validator_function(self._check_ramp, read)

    def _check_ramp(self, setting: Any) -> Any:
        if isinstance(setting, Ramped) and self.product:
            peak = setting.peak
            for value in (setting.value, *setting.region.values(), *setting.lock.values()):
                if self.exceeded(np.array(value * peak)):
                    raise refuse(
                        f"is {value:.6g}{self.suffix} times {peak:.6g} of its ramp; must be at most "
                        f"{self.most:.6g}{self.suffix}"
                    )
        return setting

    def __get_pydantic_json_schema__(self, schema: core_schema.CoreSchema, handler: Callable) -> dict[str, Any]:
        number = {"type": "number", "minimum": self.least, "maximum": self.most}
        choices = [number, {"type": "string"}] if self.unit in ("m", PER_CM2) else [number]
        inner = handler(schema)
        tables = [part for part in inner.get("anyOf", [inner]) if "$ref" in part or part.get("type") == "null"]
        return {"anyOf": choices + tables, "unit": self.unit}


class Varied(Section):
    """A value that may differ from lock to lock. In a recipe: a number, or a table
    ``{ value = …, vary = …, noise = …, map = "…", region = { name = … }, lock = { id = … } }``."""

    value: float = Field(description="the value where nothing below changes it")
    vary: float = Field(
        default=0.0, ge=0.0, le=1.0, description="random change per lock, relative to the value: 0.2 is ±20 %"
    )
    noise: float = Field(default=0.0, ge=0.0, le=1.0, description="smooth change over the scalp, relative to the value")
    noise_wavelength: Annotated[float, Quantity("m", 1e-4, 10.0)] = Field(
        default=0.03, description="distance over which the noise changes"
    )
    map: str | None = Field(
        default=None,
        description="painted values that multiply it: of the locks, or of the scalp at their roots (a primvar of "
        "floats, or a texture of `[maps]`)",
    )
    region: dict[str, float] = Field(default={}, description="the value in named regions of the scalp")
    lock: dict[int, float] = Field(default={}, description="the value of single locks, by their id")

    @property
    def peak(self) -> float:
        """The largest factor on the value along a lock."""
        return 1.0

    @property
    def by_chance(self) -> bool:
        """Whether chance or noise change the value."""
        return self.vary > 0.0 or self.noise > 0.0

    def factors(self, random: Random, ids: NDArray, places: NDArray) -> NDArray[np.float64]:
        """The factors of chance and noise on the value, shape (len(ids),)."""
        factor = np.ones(len(ids))
        if self.vary > 0.0:
            factor += self.vary * (2.0 * random.uniform(ids) - 1.0)
        if self.noise > 0.0:
            factor += self.noise * random.field(places, self.noise_wavelength)
        return np.maximum(factor, 0.05)  # variations that add up never change the sign of a value


def _in_order(ramp: list[tuple[float, float]]) -> list[tuple[float, float]]:
    places = [at for at, _ in ramp]
    if not ramp:
        raise refuse("is empty; give at least one [place, factor]")
    if min(places) < 0.0 or max(places) > 1.0:
        outside = min(places) if min(places) < 0.0 else max(places)
        raise refuse(f"has a place at {outside}; must be between 0 (root) and 1 (tip)")
    if any(b <= a for a, b in pairwise(places)):
        raise refuse(f"has places {places}; must ascend")
    if any(factor < 0.0 for _, factor in ramp):
        raise refuse(f"has a factor of {min(f for _, f in ramp)}; must be at least 0")
    if (most := max(factor for _, factor in ramp)) > MAX_FACTOR:
        raise refuse(f"has a factor of {most:g}; must be at most {MAX_FACTOR:g}")
    return ramp


Ramp = Annotated[
    list[
        tuple[
            Annotated[FiniteFloat, WithJsonSchema({"type": "number", "minimum": 0, "maximum": 1})],
            Annotated[FiniteFloat, WithJsonSchema({"type": "number", "minimum": 0, "maximum": MAX_FACTOR})],
        ]
    ],
    AfterValidator(_in_order),
]


def along(ramp: list[tuple[float, float]], u: NDArray) -> NDArray[np.float64]:
    """A ramp's factor at places ``u`` from root (0) to tip (1): smooth, no overshoot (Fritsch and Carlson 1980)."""
    at, factor = np.array(ramp).T
    if len(at) == 1:
        return np.full(np.shape(u), factor[0])
    u, width = np.clip(u, at[0], at[-1]), np.diff(at)
    slope = np.diff(factor) / width
    tangent = _tangents(width, slope)
    excess = (tangent[:-1] + tangent[1:] - 2 * slope) / width
    piece = np.minimum(np.searchsorted(at, u, side="right") - 1, len(width) - 1)
    x = u - at[piece]
    linear = factor[piece] + tangent[piece] * x
    cubic = linear + ((slope - tangent[:-1]) / width - excess)[piece] * (x * x) + (excess / width)[piece] * (x * x * x)
    return np.clip(cubic, factor.min(), factor.max())


def _tangents(width: NDArray[np.float64], slope: NDArray[np.float64]) -> NDArray[np.float64]:
    """Slopes at the places of a ramp, from those of the pieces between them.

    Inside it is their harmonic mean, 0 at a peak or a valley (Fritsch and Butland 1984). At the ends it is that of a
    parabola, unless it overshoots (Moler 2004).
    """
    if len(slope) == 1:
        return np.repeat(slope, 2)
    before, after = 2 * width[1:] + width[:-1], width[1:] + 2 * width[:-1]
    rises = np.sign(slope)
    with np.errstate(divide="ignore", invalid="ignore"):
        inner = 1.0 / ((before / slope[:-1] + after / slope[1:]) / (before + after))
    inner[(rises[1:] != rises[:-1]) | (rises[1:] == 0.0)] = 0.0
    return np.concatenate([[_end_tangent(width[:2], slope[:2])], inner, [_end_tangent(width[:-3:-1], slope[:-3:-1])]])


def _end_tangent(width: NDArray[np.float64], slope: NDArray[np.float64]) -> float:
    """The slope at an end of a ramp, from its first two pieces as seen from there."""
    tangent = ((2 * width[0] + width[1]) * slope[0] - width[0] * slope[1]) / (width[0] + width[1])
    if np.sign(tangent) != np.sign(slope[0]):
        return 0.0
    if np.sign(slope[0]) != np.sign(slope[1]) and abs(tangent) > 3.0 * abs(slope[0]):
        return 3.0 * slope[0]
    return tangent


class Ramped(Varied):
    """A varied value with a ramp from root to tip: ``{ value = …, ramp = [[0, 1], [1, 0.5]] }`` multiplies it by 1 at
    the root and by 0.5 at the tip, smoothly between and without overshoot."""

    ramp: Ramp = Field(default=[(0.0, 1.0), (1.0, 1.0)], description="[place, factor] from root (0) to tip (1)")

    @property
    def peak(self) -> float:
        """The largest factor on the value along a lock."""
        return max(factor for _, factor in self.ramp)

    def along(self, u: NDArray) -> NDArray[np.float64]:
        """The ramp's factor at places ``u`` between root (0) and tip (1)."""
        return along(self.ramp, u)


def explain(error: ValidationError, where: str, data: Any) -> UserError:
    """The first mistake in a recipe, in one line: file, setting, value, remedy. data: the recipe's tables"""
    return messages.explain(error, where, data, _setting)


def _setting(place: Location) -> str:
    """A setting's name as it stands in the recipe: ``curl.width``, ``shape[0].amplitude``."""
    return messages.setting_name(place).removesuffix(".value")
