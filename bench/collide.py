"""Benchmark of the repair: intersections of tight curls with the skin and each other, before and after."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from ringlet import Clock, build_groom, check_groom, read_groom, read_recipe

HEAD = Path(__file__).parents[1] / "examples" / "child" / "head.usdc"

RECIPE = """
ringlet = 2
seed = 3
[scalp]
file = '{head}'
mesh = {mesh}
region = "{region}"
[guides]
count = 300
length = {{ value = {length}, vary = 0.1 }}
lift = {lift}
gravity_bend = {gravity_bend}
[locks]
count = {locks}
points = {points}
[[shape]]
op = "clump"
size = 2
[curl]
preset = "{preset}"
[collide]
margin = "{margin} mm"
"""


def run(
    locks: int = 2000,
    points: int = 160,
    preset: str = "4A",
    length: float = 9.0,
    lift: float = 0.7,
    gravity_bend: float = 0.8,
    margin: float = 1.0,
    head: str = "",
    region: str = "scalp",
    crown: float = 0.0,
    picture: str = "",
) -> dict[str, Any]:
    """Grooms a head, checks the groom, repairs it and checks it again.

    length:  length of the guides [cm]; ``lift`` and ``gravity_bend`` as in a recipe
    margin:  margin of the recipe's collide stage [mm]
    head:    USD or OBJ file instead of the example's; hair grows on its ``region``
    crown:   height of the hair region below the top, for an OBJ file without regions [m]; on the face half of it
    picture: path of pictures of the places, without ``-found.png`` and ``-left.png``
    """
    clock = Clock()
    with tempfile.TemporaryDirectory() as folder:
        source = Path(head).resolve() if head else HEAD
        if crown:
            source, region = with_crown(source, crown, Path(folder)), "crown"
        path, fixed = Path(folder) / "hair.recipe.toml", Path(folder) / "fixed.usdc"
        values = {
            "length": length,
            "lift": lift,
            "gravity_bend": gravity_bend,
            "locks": locks,
            "points": points,
            "preset": preset,
        }
        mesh = '""' if head else '"/child/skin"'
        text = RECIPE.format(head=source.as_posix(), mesh=mesh, region=region, margin=margin, **values)
        path.write_text(text.replace('mesh = ""\n', ""))
        with clock("groom"):
            groom = build_groom(read_recipe(path))
        with clock("check"):
            before = check_groom(groom, picture=f"{picture}-found.png" if picture else None)
        with clock("repair"):
            after = check_groom(groom, fixed=fixed, picture=f"{picture}-left.png" if picture else None)
        lengths = read_groom(fixed).locks.lengths() / groom.locks.lengths()
    return clock.result(
        "collide",
        {**values, "margin": margin, "head": head, "region": region, "crown": crown},
        per="repair",
        warm_up=0,
        check_wall_ms=clock.wall["check"][0],
        **{
            when: {k: {n: of[n] for n in ("places", "locks", "depth")} for k, of in found.items()}
            for when, found in (("found", before["found"]), ("left", after["left"]))
        },
        repair=after["repair"],
        length_kept=[float(np.min(lengths)), float(np.max(lengths))],
    )


def with_crown(source: Path, height: float, folder: Path) -> Path:
    """Writes a copy of an OBJ file in which the faces of the upper head are the group ``crown``; returns its path."""
    lines = source.read_text().splitlines()
    points = np.array([line.split()[1:4] for line in lines if line.startswith("v ")], float)
    top, front, half = points[:, 1].max(), points[:, 2].max() - 0.5 * np.ptp(points[:, 2]), height / 2.0
    plain, crown = [], []
    for line in lines:
        if not line.startswith("f "):
            if line[:2] in ("v ", "vt"):
                plain.append(line)
            continue
        middle = points[[int(word.split("/")[0]) - 1 for word in line.split()[1:]]].mean(axis=0)
        on_face = middle[2] > front and middle[1] < top - half
        (crown if middle[1] > top - height and not on_face else plain).append(line)
    result = folder / "head.obj"
    result.write_text("\n".join([*plain, "g crown", *crown]) + "\n")
    return result
