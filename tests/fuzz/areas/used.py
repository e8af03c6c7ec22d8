"""A setting that is changed changes the locks or the hairs, or is refused.

Where it changes nothing, there may be nothing to change. A spread of tips may be beyond the reach of all locks, a share
of 0.4 % be one of 70 hairs, a place among the hairs of a lock be that of a single one. So the setting must act in an
ample recipe. That one has more locks and hairs, no other numbers, and the same modes. It has what the setting acts
beside (tests/python/test_settings_act.py). A setting that does not act there either is a finding.
"""

from __future__ import annotations

import json
import tomllib
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
from judged import grown
from numpy.random import Generator
from random_recipe import NAMES, Settings
from settings_walk import merge
from test_settings_act import BESIDE, TABLES

import ringlet
from ringlet.groom import make_hairs

Table = dict[str, Any]
PLACES = {"Curl": "curl", "HairSettings": "hairs", "Grown": "guides", "Locks": "locks"}
AMPLE = {
    "guides": {"count": 12, "length": "60 mm"},
    "locks": {"count": 150, "points": 40},
    "hairs": {"per_lock": 6},
    "curl": {"curls": 2.0},
}
VALUES = 5  # of a setting that are tried in the ample recipe


def attempt(random: Generator, folder: Path) -> None:
    settings = Settings(random, "recipe")
    defs = settings.schema["$defs"]
    name = str(random.choice([*settings.operators, *PLACES, "Hairline"]))
    recipe = settings.recipe(0)
    properties = defs[name]["properties"]
    op = properties.get("op", {}).get("const")
    own: Table = settings.table(name, 0.3, op=op) if op else {}
    key = str(random.choice([key for key in properties if key not in ("op", "seed")]))
    wanted = settings.value(key, properties[key])
    if wanted is None:
        return
    before, after = _with(recipe, name, own), _with(recipe, name, own | {key: wanted})
    found = [grown(one) for one in (before, after)]
    if op and np.array_equal(grown(recipe).locks.points, found[0].locks.points):
        return  # the operator does nothing there
    default = properties[key].get("default")
    zero = isinstance(default, dict) and default.get("value") == 0.0 == wanted
    if wanted == default or before == after or zero or _differ(*found):
        return
    values = [wanted, *(settings.value(key, properties[key]) for _ in range(VALUES))]
    assert any(_acts(before, name, key, value) for value in values), f"UNUSED {name}.{key} = {wanted}"


def _with(recipe: Table, name: str, given: Table) -> Table:
    """A recipe with further settings of a table."""
    made = _copy(recipe)
    if name == "Hairline":
        made["locks"]["hairline"] = given
    elif name in PLACES:
        place = PLACES[name]
        made[place] = made.get(place, {"curls": 2.0} if place == "curl" else {}) | given
    else:
        made["shape"] = [given]
    return made


def _differ(one: ringlet.Groom, other: ringlet.Groom) -> bool:
    """Whether two grooms have other locks or hairs."""
    if not np.array_equal(one.locks.points, other.locks.points):
        return True
    hairs, others = (make_hairs(groom).curves for groom in (one, other))
    return not (
        np.array_equal(hairs.points, others.points) and np.array_equal(hairs.point["width"], others.point["width"])
    )


def _acts(recipe: Table, name: str, key: str, value: Any) -> bool:
    """Whether a value of a setting changes the ample recipe."""
    beside = tomllib.loads(TABLES.get(name, ("", ""))[1])
    own = _modes(recipe["shape"][0]) if recipe["shape"] else _modes(recipe["locks"].get("hairline", {}))
    needed = beside.pop("shape", [{}])[0]
    beside |= {part: given for part, given in needed.items() if part not in NAMES or NAMES.keys().isdisjoint(own)}
    beside |= tomllib.loads(BESIDE.get(f"{name}.{key}", ""))
    ample = {place: _modes(given) if place in AMPLE else given for place, given in _copy(recipe).items()}
    for place, given in AMPLE.items():
        if place != "curl" or place in recipe:
            ample[place] = ample.get(place, {}) | given
    for part, given in beside.items():
        if isinstance(given, dict):
            merge(ample, {part: given})
        else:
            own[part] = given
    if name in PLACES:
        own = {part: given for part, given in own.items() if part in beside}
    with suppress(ringlet.UserError):
        pair = [grown(_with(ample, name, given)) for given in (own, own | {key: value})]
        return _differ(*pair)
    return False


def _copy(table: Table) -> Table:
    return json.loads(json.dumps(table))


def _modes(table: Table) -> Table:
    """The settings of a table that are words or choices, which say how the others are read."""
    return {
        key: value
        for key, value in table.items()
        if isinstance(value, bool) or (isinstance(value, str) and value[0].isalpha()) or key == "sections"
    }
