"""Mixes two recipes, and states a recipe's settings as its file would: for presets that are taken in part."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from pydantic import BaseModel

from ringlet.data.lengths import UNITS
from ringlet.data.quantities import Quantity, Varied, along
from ringlet.data.settings import FORMAT
from ringlet.groom import Recipe
from ringlet.groom.load import stage_names

Tables = dict[str, Any]
DIGITS = 5  # of numbers that a mix writes


def mix(a: Recipe, b: Recipe, share: float, names: Sequence[str]) -> Recipe:
    """The recipe ``a`` with some tables mixed with those of ``b``.

    share: 0 for the tables of ``a``, 1 for those of ``b``; numbers and ramps are interpolated, operators of one recipe
           alone fade by their ``blend``, and all else changes at 0.5
    names: names of the tables

    Raises ValidationError for a mix that is no valid recipe.
    """
    mixed = {name: _mixed(_table(a, name), _table(b, name), share, name) for name in names}
    known = {name: getattr(a, name) for name in a.model_fields_set if name not in mixed}
    given = {name: value for name, value in mixed.items() if value is not None}
    recipe = Recipe.model_validate({**known, "ringlet": FORMAT, **given}, context={"unit": 1.0})
    recipe._path, recipe._text = a.path, a.text
    return recipe


def _table(recipe: Recipe, name: str) -> Any:
    value = getattr(recipe, name)
    if isinstance(value, list):
        return [one.model_dump(mode="json") for one in value]
    return value.model_dump(mode="json") if isinstance(value, BaseModel) else value


def _mixed(a: Any, b: Any, share: float, name: str) -> Any:
    """A value between two; ``name`` is that of its setting."""
    if a == b:
        return a
    if _is_number(a) and _is_number(b):
        value = (1.0 - share) * a + share * b
        return round(value) if isinstance(a, int) and isinstance(b, int) else value
    if isinstance(a, dict) and isinstance(b, dict):
        if name in ("region", "lock"):
            return {key: _mixed(a.get(key, b.get(key)), b.get(key, a.get(key)), share, "") for key in {**a, **b}}
        if a.keys() == b.keys():
            return {key: _mixed(a[key], b[key], share, key) for key in a}
    if isinstance(a, list) and isinstance(b, list):
        if name == "shape":
            return _mixed_operators(a, b, share)
        if name == "ramp" or (_is_ramp(a) and _is_ramp(b)):
            return _mixed_ramps(a, b, share)
        if len(a) == len(b):
            return [_mixed(one, other, share, "") for one, other in zip(a, b, strict=True)]
    return a if share < 0.5 else b


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_ramp(value: list[Any]) -> bool:
    pairs = [one for one in value if isinstance(one, list) and len(one) == 2 and all(map(_is_number, one))]
    return len(pairs) == len(value) > 0 and all(one[0] < other[0] for one, other in pairwise(pairs))


def _mixed_ramps(a: list[Any], b: list[Any], share: float) -> list[list[float]]:
    places = np.unique(np.concatenate([np.array(a)[:, 0], np.array(b)[:, 0]]))
    factors = (1.0 - share) * along(a, places) + share * along(b, places)
    return np.stack([places, factors], axis=1).tolist()


def _mixed_operators(a: list[Tables], b: list[Tables], share: float) -> list[Tables]:
    """Operators of both recipes, matched by name. Those of ``a`` alone keep their place before the next common one."""
    first, second = (dict(zip(stage_names(shape), shape, strict=True)) for shape in (a, b))
    order = list(second)
    names = list(first)
    for k, name in reversed([*enumerate(names)]):
        if name not in second:
            following = next((order.index(one) for one in names[k + 1 :] if one in order), len(order))
            order.insert(following, name)
    mixed = []
    for name in order:
        if name in first and name in second:
            mixed.append(_mixed(first[name], second[name], share, ""))
        elif name in first:
            mixed += _faded(first[name], 1.0 - share)
        else:
            mixed += _faded(second[name], share)
    return mixed


def _faded(operator: Tables, share: float) -> list[Tables]:
    """A part of an operator: its blend times the part, or the operator from 0.5 on where it has none."""
    if "blend" in operator:
        return [{**operator, "blend": share * operator["blend"]}] if share > 0.0 else []
    return [operator] if share >= 0.5 else []


def stated(model: BaseModel, unit: str) -> Tables:
    """The settings of a table that are not its defaults, in the notation of a recipe with a unit of lengths.

    The preset of a table is left out, and the settings that it fills are stated.
    """
    tables: Tables = {}
    for name, field in type(model).model_fields.items():
        value, default = getattr(model, name), field.get_default(call_default_factory=True)
        if name == "preset" or (value == default and name != "op"):
            continue
        length = any(isinstance(part, Quantity) and part.unit == "m" for part in field.metadata)
        if isinstance(value, Varied):
            tables[name] = _stated_varied(value, default, unit, length=length)
        else:
            tables[name] = False if value is None else _stated(value, unit, length=length)
    return tables


def _stated(value: Any, unit: str, *, length: bool) -> Any:
    if isinstance(value, BaseModel):
        return stated(value, unit)
    if isinstance(value, list | tuple):
        return [_stated(one, unit, length=length) for one in value]
    if isinstance(value, float):
        return _rounded(value / UNITS[unit] if length else value)
    return value


def _stated_varied(value: Varied, default: Any, unit: str, *, length: bool) -> Any:
    """A value that varies, as a number or a table: a setting keeps the variation of its default unless it is stated."""
    table: Tables = {"value": _stated(value.value, unit, length=length)}
    for name, field in type(value).model_fields.items():
        usual = getattr(default, name) if isinstance(default, Varied) else field.get_default()
        one = getattr(value, name)
        if name in ("value", "map") or one == usual:
            continue
        if isinstance(one, dict):
            table[name] = {str(key): _stated(own, unit, length=length) for key, own in one.items()}
        else:
            table[name] = _stated(one, unit, length=name == "noise_wavelength")
    if value.map is not None:
        table["map"] = value.map
    varies = isinstance(default, Varied) and (default.vary or default.noise)  # a number alone takes that away
    return table if len(table) > 1 or varies else table["value"]


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")
