"""Two settings at their greatest are done in bounded work, or refused."""

from __future__ import annotations

from pathlib import Path

from judged import check_curves, grown
from numpy.random import Generator
from random_recipe import Settings


def attempt(random: Generator, folder: Path) -> None:
    settings = Settings(random, "recipe")
    defs = settings.schema["$defs"]
    found = [
        (name, key, bound["maximum"] if random.random() < 0.5 else bound.get("minimum", 0.0), node.get("unit", ""))
        for name in ("Clump", "PhaseGroups", "Locks", "Grown", "Curl", "HairSettings", "Braid", "Twist", "Knot", "Loc")
        for key, node in defs.get(name, {"properties": {}})["properties"].items()
        for bound in node.get("anyOf", [node])
        if "maximum" in bound and key not in ("count", "points", "shape_points", "per_lock", "density", "seed")
    ]
    table = settings.recipe(0)
    table["locks"]["sections"] = {"pattern": "grid", "size": "60 mm", "strands": 2}
    for place in random.permutation(len(found))[:2]:
        name, key, value, unit = found[place]
        where = {"Locks": "locks", "Grown": "guides", "Curl": "curl", "HairSettings": "hairs"}.get(name)
        value = settings.in_text(value, unit)
        if where:
            table[where] = table.get(where, {"curls": 1.0} if where == "curl" else {}) | {key: value}
        elif name == "PhaseGroups":
            table["curl"] = {"curls": 2.0, "phase_groups": {key: value}}
        else:
            table["shape"] = [*table["shape"], {"op": name.lower(), key: value}]
    if "spacing" in table["locks"]:
        del table["locks"]["count"]
    groom = grown(table)
    check_curves(groom.locks, groom.scalp, "locks")
