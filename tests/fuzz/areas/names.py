"""Names of files, regions and grooms of any characters change nothing, or are refused."""

from __future__ import annotations

import json
from pathlib import Path

import small_example
from commands import run
from judged import SINGLE, same
from numpy.random import Generator
from random_recipe import HELPERS
from ringlet.data.toml import to_toml

import ringlet


def attempt(random: Generator, folder: Path) -> None:
    letters = "aZ9_-. :é漢'\"#%[]{}()&;,=+@!~^$\\"
    name = "".join(random.choice(list(letters), random.integers(1, 12)))
    where = str(random.choice(["file", "folder", "title", "region", "curve"]))
    plain = {"ringlet": 2, "scalp": {"file": "head.usda", "region": "scalp"}, "guides": {"count": 3, "length": 4}}
    named = json.loads(json.dumps(plain))
    here = folder / (name if where == "folder" else "x")
    here.mkdir()
    small_example.write_head(folder / "head.usda")
    head = here / (f"{name}.usda" if where == "file" else "head.usda")
    head.write_bytes((folder / "head.usda").read_bytes())
    named["scalp"]["file"] = head.name
    if where == "title":
        named["name"] = name
    elif where == "curve":
        named["curves"] = {name: HELPERS["curves"]["tail"]}
        named["shape"] = [{"op": "attract", "curve": name}]
        plain |= {"curves": HELPERS["curves"], "shape": [{"op": "attract", "curve": "tail"}]}
    elif where == "region":
        named["scalp"]["region"] = name
    for table, place in ((plain, folder), (named, here)):
        (place / "r.recipe.toml").write_text(to_toml(table))
    wanted = ringlet.build_groom(folder / "r.recipe.toml")
    done = run("groom", here / "r.recipe.toml", "-o", here / "g.usdc")
    assert done.exit_code in (0, 2), f"{where} {name!r}: exit {done.exit_code}: {done.output[-200:]}"
    if done.exit_code == 0:
        read = ringlet.read_groom(here / "g.usdc")
        same(read.locks.points, wanted.locks.points, SINGLE, f"{where} {name!r}")
