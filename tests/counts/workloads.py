"""Small workloads whose cost is counted. Each prepares, yields, and then does what is counted.

``python workloads.py SHIM`` runs them under callgrind, which counts between two requests of the shim. All share one
process, whose imports take a third of the time there.
"""

from __future__ import annotations

import ctypes
import sys
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "bench"))

import cloth
import strands
import twirl
from groom import recipe_text

from ringlet import (
    Groom,
    Memory,
    Solver,
    build_groom,
    build_hairs,
    read_groom,
    read_recipe,
    read_shot,
    simulate,
    swing_nest,
    write_groom,
)

FOLDER = Path(tempfile.mkdtemp())
SHOT = "frames = [18, 19]\npreroll = 0\n[contact]\non = true\nradius = 4e-4\n"
LOCKS, POINTS, HAIRS = 40, 30, 800


def recipe(width: float = 9.0):
    """A recipe of few locks on the example head, with this width of a curl [mm]."""
    path = FOLDER / "counted.recipe.toml"
    path.write_text(recipe_text(20, LOCKS, POINTS, HAIRS, width))
    return read_recipe(path)


@cache
def groom() -> Groom:
    """The groom of the recipe, made once."""
    return build_groom(recipe())


def coils_without_contact() -> Iterator[None]:
    """Coils that swing from a root frame."""
    yield
    strands.run(strands=16, vertices=40, steps=4)


def wisps_without_contact() -> Iterator[None]:
    """Wisps on a sphere, far from where Newton's method is quadratic."""
    yield
    twirl.run(strands=16, steps=4)


def wisps_in_contact() -> Iterator[None]:
    """The same in contact with each other and the sphere."""
    yield
    twirl.run(strands=16, contacts="on", steps=3)


def nod() -> Iterator[None]:
    """A frame of the example head with hair in contact."""
    made = groom()
    path = FOLDER / "counted.shot.toml"
    path.write_text("ringlet = 2\ngroom = 'counted.recipe.toml'\n" + SHOT)
    yield
    simulate(read_shot(path), made)


def nest() -> Iterator[None]:
    """Seven coils in one another that swing."""
    yield
    swing_nest(1, Solver(newton=1))


def sheet() -> Iterator[None]:
    """A sheet that swings from two corners."""
    yield
    cloth.run(side=16, steps=4)


def sheet_on_a_sphere() -> Iterator[None]:
    """A sheet that falls on a sphere."""
    yield
    cloth.run(side=16, steps=4, contacts="on")


def cold_groom() -> Iterator[None]:
    """Recipe to hairs, with nothing remembered."""
    build_hairs(groom())  # loads what is loaded once
    yield
    build_hairs(build_groom(recipe()))


def slider() -> Iterator[None]:
    """Recipe to hairs after a change of the width of curls."""
    memory = Memory()

    def evaluated(width: float) -> None:
        build_hairs(build_groom(recipe(width), memory=memory), memory=memory)

    evaluated(8.0)
    evaluated(9.0)
    yield
    evaluated(10.0)


def warp_of_hairs() -> Iterator[None]:
    """Hairs after their locks have moved."""
    made = groom()
    hair = build_hairs(made)
    yield
    hair.deformed(np.asarray(made.locks.points) + 1e-3, made.scalp.points)


def groom_on_disk() -> Iterator[None]:
    """Writes a groom and reads it."""
    write_groom(groom(), FOLDER / "first.usdc")
    yield
    write_groom(groom(), FOLDER / "counted.usdc")
    read_groom(FOLDER / "counted.usdc")


IN_THE_CORE = (
    coils_without_contact,
    wisps_without_contact,
    wisps_in_contact,
    nod,
    nest,
    sheet,
    sheet_on_a_sphere,
    cold_groom,
    slider,
    warp_of_hairs,
)
IN_PYTHON = (nod, cold_groom, slider, groom_on_disk)

if __name__ == "__main__":
    shim = ctypes.CDLL(sys.argv[1])
    for workload in IN_THE_CORE:
        running = workload()
        next(running)
        shim.begin()
        next(running, None)
        shim.end(workload.__name__.encode())
