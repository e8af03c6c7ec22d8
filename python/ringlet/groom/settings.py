"""What recipe sections are made of: lengths with units, values that vary from lock to lock, ramps; readable errors."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any, get_args

import numpy as np
from numpy.typing import NDArray
from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    FiniteFloat,
    ValidationError,
    ValidationInfo,
    model_validator,
)
from pydantic_core import PydanticCustomError, core_schema
from scipy.interpolate import PchipInterpolator

from ringlet.errors import UserError
from ringlet.groom.random import Random

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254}


def refuse(message: str) -> PydanticCustomError:
    """An error whose message follows the setting's name, e.g. ``is -1; must be at least 0``."""
    return PydanticCustomError("ringlet", "{message}", {"message": message})


class Section(BaseModel):
    """A table of the recipe. Unknown settings are refused with the nearest name that exists; a value that is given
    without its variation or ramp keeps those of the default."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    @model_validator(mode="before")
    @classmethod
    def _only_known_settings(cls, data: Any) -> Any:
        if isinstance(data, dict):
            for key in data:
                if key not in cls.model_fields:
                    raise PydanticCustomError(
                        "unknown", "{key}{hint}", {"key": key, "hint": did_you_mean(key, cls.model_fields)}
                    )
            for name, default in cls.defaults(data).items():
                if name in data:
                    given = data[name]
                    if isinstance(default, dict) and not isinstance(given, BaseModel):
                        data = {**data, name: {**default, **(given if isinstance(given, dict) else {"value": given})}}
                else:
                    data = {**data, name: default}
        return data

    @classmethod
    def defaults(cls, data: dict[str, Any]) -> dict[str, Any]:
        """What holds where ``data`` says nothing, as a recipe would say it."""
        varied = {name: field for name, field in cls.model_fields.items() if isinstance(field.default, Varied)}
        return {name: _as_said(field.default, field.metadata) for name, field in varied.items()}


def did_you_mean(name: str, valid: Any) -> str:
    """``; did you mean 'width'?`` or, with nothing near, ``; there are: …``."""
    near = difflib.get_close_matches(name, list(valid), n=1, cutoff=0.5)
    return f"; did you mean '{near[0]}'?" if near else f"; there are: {', '.join(valid)}"


def _as_said(value: Varied, metadata: list[Any]) -> dict[str, Any]:
    said = value.model_dump(exclude_unset=True)
    if any(isinstance(part, Quantity) and part.unit == "m" for part in metadata):
        said["value"] = f"{said['value']!r} m"
    return said


@dataclass(frozen=True)
class Quantity:
    """The unit and bounds of a setting. Unit ``m``: a number counts in the recipe's unit, a text carries its own, as in
    ``"5 mm"``."""

    unit: str = ""
    least: float = -np.inf
    most: float = np.inf

    def number(self, value: Any, unit: float) -> float:
        """``value`` in SI, within the bounds."""
        if isinstance(value, str):
            match = re.fullmatch(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*([a-z]+)\s*", value)
            if self.unit != "m" or not match or match[2] not in UNITS:
                raise refuse(
                    f"is '{value}'; must be a number" + (' or a length such as "5 mm"' if self.unit == "m" else "")
                )
            try:
                value = float(match[1]) * UNITS[match[2]]
            except ValueError:
                raise refuse(f"is '{value}'; must be a length such as \"5 mm\"") from None
        elif isinstance(value, bool) or not isinstance(value, int | float) or abs(value) > 1e300:
            raise refuse(f"is {value!r}; must be a number")
        elif self.unit == "m":
            value = value * unit
        value = float(value)
        suffix = f" {self.unit}" if self.unit else ""
        if not np.isfinite(value):
            raise refuse(f"is {value}; must be finite")
        if value < self.least:
            raise refuse(f"is {value:.6g}{suffix}; must be at least {self.least:.6g}{suffix}")
        if value > self.most:
            raise refuse(f"is {value:.6g}{suffix}; must be at most {self.most:.6g}{suffix}")
        return value

    def _read(self, value: Any, table: bool, info: ValidationInfo) -> Any:
        unit = (info.context or {}).get("unit", 1.0)
        if value is None or isinstance(value, BaseModel):
            return value
        if table and isinstance(value, dict):
            return {**value, "value": self.number(value["value"], unit)} if "value" in value else value
        number = self.number(value, unit)
        return {"value": number} if table else number

    def __get_pydantic_core_schema__(
        self, source: Any, handler: Callable[[Any], core_schema.CoreSchema]
    ) -> core_schema.CoreSchema:
        table = any(isinstance(kind, type) and issubclass(kind, Section) for kind in (source, *get_args(source)))
        return core_schema.with_info_before_validator_function(
            lambda value, info: self._read(value, table, info), handler(source)
        )

    def __get_pydantic_json_schema__(self, schema: core_schema.CoreSchema, handler: Callable) -> dict[str, Any]:
        bounds = {"minimum": self.least, "maximum": self.most}
        number = {"type": "number", **{name: bound for name, bound in bounds.items() if np.isfinite(bound)}}
        choices = [number, {"type": "string"}] if self.unit == "m" else [number]
        inner = handler(schema)
        tables = [part for part in inner.get("anyOf", [inner]) if "$ref" in part or part.get("type") == "null"]
        return {"anyOf": choices + tables, "unit": self.unit}


class Varied(Section):
    """A value that may differ from lock to lock. In a recipe: a number, or a table
    ``{ value = …, vary = …, noise = …, noise_size = … }``."""

    value: float
    vary: float = Field(
        default=0.0, ge=0.0, le=1.0, description="random change per lock, as a part of the value: 0.2 is ±20 %"
    )
    noise: float = Field(
        default=0.0, ge=0.0, le=1.0, description="smooth change over the scalp, as a part of the value"
    )
    noise_size: Annotated[float, Quantity("m", 1e-4, 10.0)] = Field(
        default=0.03, description="distance over which the noise changes"
    )

    def per_curve(self, random: Random, ids: NDArray, places: NDArray) -> NDArray[np.float64]:
        """The value for each curve, shape (len(ids),); ``places``: roots [m], shape (len(ids), 3)."""
        factor = np.ones(len(ids))
        if self.vary > 0.0:
            factor += self.vary * (2.0 * random.uniform(ids) - 1.0)
        if self.noise > 0.0:
            factor += self.noise * random.field(places, self.noise_size)
        return self.value * np.maximum(factor, 0.05)  # variations that add up never turn a value around


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
    return ramp


Ramp = Annotated[list[tuple[FiniteFloat, FiniteFloat]], AfterValidator(_in_order)]


def along(ramp: list[tuple[float, float]], u: NDArray) -> NDArray[np.float64]:
    """A ramp's factor at places ``u`` from root (0) to tip (1): smooth, no overshoot (Fritsch and Carlson 1980)."""
    at, factor = np.array(ramp).T
    if len(at) == 1:
        return np.full(np.shape(u), factor[0])
    return PchipInterpolator(at, factor)(np.clip(u, at[0], at[-1]))


class Ramped(Varied):
    """A varied value with a ramp from root to tip: ``{ value = …, ramp = [[0, 1], [1, 0.5]] }`` multiplies it by 1 at
    the root and by 0.5 at the tip, smoothly between and without overshoot."""

    ramp: Ramp = Field(default=[(0.0, 1.0), (1.0, 1.0)], description="[place, factor] from root (0) to tip (1)")

    def along(self, u: NDArray) -> NDArray[np.float64]:
        """The ramp's factor at places ``u`` between root (0) and tip (1)."""
        return along(self.ramp, u)


def explain(error: ValidationError, where: str) -> UserError:
    """The first mistake that a model found, in one line: file, setting, value, remedy."""
    first = error.errors()[0]
    name, kind, context, given = _setting(first["loc"]), first["type"], first.get("ctx", {}), first["input"]
    at_least = {
        "greater_than_equal": ("at least", "ge"),
        "less_than_equal": ("at most", "le"),
        "greater_than": ("more than", "gt"),
    }
    if kind == "unknown":
        message = f"{name}.{context['key']} is not a setting{context['hint']}".removeprefix(".")
    elif kind == "ringlet":
        message = f"{name} {context['message']}"
    elif kind == "missing":
        message = f"{name} is missing; it must be given"
    elif kind in at_least:
        word, key = at_least[kind]
        message = f"{name} is {given!r}; must be {word} {context[key]}"
    elif kind == "literal_error":
        message = f"{name} is {given!r}; must be {context['expected']}"
    elif kind == "union_tag_invalid":
        valid = [tag.strip(" '") for tag in context["expected_tags"].split(",")]
        message = f"{name}.op is '{context['tag']}'{did_you_mean(context['tag'], valid)}"
    elif kind == "union_tag_not_found":
        message = f"{name} has no 'op'; say which operator it is"
    elif kind in ("model_type", "model_attributes_type", "dict_type"):
        message = f"{name} is {given!r}; must be a table of settings"
    elif kind.startswith(("int_", "float_")):
        message = f"{name} is {given!r}; must be a {'whole ' if kind.startswith('int') else ''}number"
    else:
        message = f"{name} is {given!r}; {first['msg'][0].lower()}{first['msg'][1:]}"
    return UserError(f"{where}: {message}")


def _setting(loc: tuple[int | str, ...]) -> str:
    """A setting's name as it stands in the recipe: ``curl.width``, ``shape[0].amplitude``."""
    name = ""
    for depth, part in enumerate(loc):
        if isinstance(part, int):
            name += f"[{part}]"
        elif depth != _KIND_AT.get(str(loc[0])):
            name += f".{part}"
    return name.removeprefix(".").removesuffix(".value")


_KIND_AT = {"guides": 1, "shape": 2}  # where pydantic puts in the kind of a union, which no recipe says
