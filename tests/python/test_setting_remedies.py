"""The advice of messages about settings is followed: for each setting in the schema of recipes and shots.

A bound that a message states is accepted, and so is the name that it means.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Callable, Iterator
from typing import Any

import pytest
import test_settings_act as recipes
import test_shot_settings_act as shots
from pydantic import BaseModel
from ringlet.data.quantities import Varied
from ringlet.data.toml import to_toml
from ringlet.shot import parse_shot
from settings_walk import add, at, kinds

from ringlet import UserError
from ringlet.groom import parse_recipe

FAR = 10**15
IDS = ("guide", "lock")  # any number may be one
BOUND = re.compile(r"must be (at least|at most|more than|less than) (\S+)( m| /cm2)?\b")


def of_shot(table: str, name: str) -> tuple[dict[str, Any], str]:
    place, text = shots.TABLES[table]
    data: dict[str, Any] = {}
    for one in (shots.BASE, text, shots.BESIDE.get(f"{table}.{name}", "")):
        add(data, one)
    return data, place


TABLES = [(f"recipe {table}", table, recipes.MODELS, recipes.recipe_for, parse_recipe) for table in recipes.MODELS]
TABLES += [(f"shot {table}", table, shots.MODELS, of_shot, parse_shot) for table in shots.TABLES]
Read = Callable[[str], Any]


def refusal(read: Read, data: dict[str, Any]) -> str:
    """The message about a text; empty where it is accepted."""
    try:
        read(to_toml(data))
    except UserError as error:
        assert "\n" not in str(error)
        return str(error)
    return ""


def numbers(model: type[BaseModel]) -> Iterator[str]:
    """The settings of a table that are numbers."""
    for name, field in model.model_fields.items():
        found = kinds(field.annotation)
        varied = any(isinstance(kind, type) and issubclass(kind, Varied) for kind in found)
        many = re.search(r"(tuple|dict)\[", str(field.annotation))
        if (varied or int in found or float in found) and not many and name != "ringlet":
            yield name


every_table = pytest.mark.parametrize(
    ("table", "models", "base", "read"), [one[1:] for one in TABLES], ids=[one[0] for one in TABLES]
)


@every_table
def test_the_bound_that_a_message_states_is_accepted(table, models, base, read):
    for name in numbers(models[table]):
        data, place = base(table, name)
        stated = False
        for value in (FAR, -FAR):
            at(data, place)[name] = value
            message = refusal(read, data)
            if bound := BOUND.search(message):
                stated = True
                at(data, place)[name] = within(*bound.groups())
                again = refusal(read, data)
                assert not re.search(rf"{name} is .*; must be", again), (message, again)
        assert stated or name in IDS, name


def within(which: str, number: str, unit: str | None) -> int | float | str:
    """A value that a message allows: the bound, or one beside it."""
    if unit:
        return number + unit
    value = float(number) + {"more than": 1e-3, "less than": -1e-3}.get(which, 0.0)
    return int(value) if value.is_integer() else value


@every_table
def test_the_name_that_a_message_means_is_accepted(table, models, base, read):
    for name in models[table].model_fields:
        data, place = base(table, name)
        wrong = copy.deepcopy(data)
        at(wrong, place)[f"{name[:-2]}{name[-1]}{name[-2]}x"] = 1
        message = refusal(read, wrong)
        meant = re.search(r"is not a setting; did you mean '(\w+)'\?$", message)
        if meant is None:  # a short name is like none
            assert len(name) < 5 and re.search(rf"there are: .*\b{name}\b", message), message
            continue
        assert meant[1] in models[table].model_fields, message
        at(data, place).setdefault(meant[1], 1)
        assert "is not a setting" not in refusal(read, data)
