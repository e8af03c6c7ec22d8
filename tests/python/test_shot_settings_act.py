"""Every setting of a shot acts or is refused: for each in the schema, another value gives another motion."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
import pytest
from cloth_scene import sheet
from floor_scene import floor, groom, still
from pydantic import BaseModel
from ringlet.data.digest import digest
from ringlet.data.mesh import Clip
from ringlet.data.quantities import Varied
from ringlet.data.toml import to_toml
from ringlet.shot import Shot, parse_shot
from ringlet.shot.rest import Rest
from ringlet.sim import Garment, Obstacle, simulate
from ringlet.sim.core import step_settings
from settings_walk import add, at, kinds, tables

from ringlet import UserError
from ringlet.rest import solve_rest_shape

BASE = """
ringlet = 2
groom = "groom.usdc"
frames = [1, 3]
preroll = 0
[strands]
bend_scale = 0.2
[solver]
newton = 3
extra = 0
"""
CONTACT = "[contact]\nradius = 2e-3\n[[collider]]\nname = 'floor'\n"
CLOTH = CONTACT + "[[cloth]]\nname = 'sheet'\nmesh = '/sheet'\n"
PINNED = CLOTH + "[[cloth.pin]]\nsubset = 'front'\n"

TABLES = {
    "Shot": ("", ""),
    "Material": ("strands", ""),
    "WantedMotion": ("motion", ""),
    "Variation": ("variation", ""),
    "Rest": ("rest", ""),
    "Solver": ("solver", ""),
    "Forces": ("forces", ""),
    "ShotContact": ("contact", CONTACT),
    "Pair": ("contact.pair.0", CONTACT + "[[contact.pair]]\nbetween = ['locks', 'floor']\nfriction = 0.9\n"),
    "Collider": ("collider.0", CONTACT),
    "ShotCloth": ("cloth.0", CLOTH),
    "ClothMaterial": ("cloth.0.material", CLOTH),
    "Pin": ("cloth.0.pin.0", PINNED),
}
BESIDE = {
    "WantedMotion.seed": "[solver]\nsubsteps = 8\n[motion]\nsettle = { value = 0.2, vary = 0.5 }\n",
    "Variation.seed": "[variation]\nbend = { vary = 0.5 }\n",
    "Material.limit_twist": "[variation]\ntwist = 2\n",
    "Rest.gain": "[rest]\nmode = 'lofted'\n",
    "Rest.stiffen": "[rest]\nmode = 'equilibrium'\n",
    "Rest.spring": "[rest]\nmode = 'equilibrium'\n",
    "Rest.iterations": "[rest]\nmode = 'lofted'\n",
    "Rest.tolerance": "[rest]\nmode = 'lofted'\n",
    "Solver.accuracy": CONTACT,
    "Solver.safeguards": "[solver]\ncontinuation = 'history'\n",
    "Pin.within": CLOTH + "[[cloth.pin]]\nto = 'floor'\n",
}
VALUES = {
    "Shot.frames": [[2, 4]],
    "Material.limit_twist": [False],
    "Forces.gravity": [[0, -3, 1]],
    "Forces.wind": [[3, 0, 0]],
    "Solver.safeguards": [["straight_fade"]],
    "ShotContact.pair": [[{"between": ["locks", "floor"], "friction": 0.9}]],
    "Pair.between": [["locks", "locks"]],
    "ShotCloth.shrink": [0.8],
    "ShotCloth.pin": [[{"subset": "front"}]],
    "Pin.to": ["floor"],
    "Pin.subset": ["none"],
    "Pin.map": ["stiff"],
    "Rest.iterations": [1],
    "Rest.tolerance": [0.1],
    "Pin.within": [0.01],
    "Rest.stiffen": [1.0],
    "Rest.spring": [0.95],
}
# Names for messages, and files: the tests of files change them.
ELSEWHERE = {
    "Shot": ["ringlet", "name", "groom"],
    "Rest": ["file"],
    "Collider": ["name", "file", "mesh"],
    "ShotCloth": ["name", "file", "mesh"],
}
MODELS = tables(Shot, {})


def coils():
    """Three coils over a floor, the middle one of which has a radius of its own."""
    made = groom(apart=0.002)
    s = np.tile(np.linspace(0.0, 1.0, int(made.locks.counts[0])), len(made.locks))[:, None]
    turn = 2.0 * np.pi * 3.0 * s
    around = np.concatenate([0.0 * s, np.sin(turn), np.cos(turn)], axis=1)
    made.locks.points = made.locks.points + 4e-3 * np.minimum(8.0 * s, 1.0) * around
    made.locks.curve["strand_radius"] = np.array([0.0, 4e-3, 0.0], np.float32)
    return made


@cache
def outcome(text: str) -> str:
    """A digest of the motion of a shot, of its rest shape, and of what the core is given to do in a step,
    and of the motion that it may miss."""
    shot, made = parse_shot(text), coils()
    parts: list[Any] = []
    if shot.rest.mode != "none":
        loft = solve_rest_shape(shot, made)
        parts += [str(shot.rest.mode), *(np.asarray(x) for x in vars(loft).values() if isinstance(x, np.ndarray))]
    obstacles = [Obstacle(floor(), moving(floor(), (0.01, 0.0, 0.0)), collider) for collider in shot.collider]
    garments = [Garment(sheet(cells=4), still(sheet(cells=4)), cloth, None, "/sheet") for cloth in shot.cloth]
    at_rest = shot.model_copy(update={"rest": Rest()})
    head = moving(made.scalp, (0.0, 0.01, 0.02))
    found = simulate(at_rest, made, head, obstacles=obstacles, garments=garments)
    step = step_settings(shot.solver, 0.01, shot.forces.gravity, shot.forces.wind)
    given = {name: str(getattr(step, name)) for name in dir(step) if not name.startswith("_") and name != "safeguards"}
    given |= {name: getattr(step.safeguards, name) for name in dir(step.safeguards) if not name.startswith("_")}
    tolerated = [frame["contact"]["motion_tolerated"] for frame in found.statistics if "contact" in frame]
    parts += [found.points, given, tolerated, *(cloth.points for cloth in found.cloths)]
    return digest(*parts)


def moving(mesh, by):
    """A mesh that moves by so much in eight frames [m]."""
    return Clip(np.array([1.0, 9.0]), np.array([mesh.points, mesh.points + by]), 24.0)


def changes(model: type[BaseModel], name: str) -> Iterator[tuple[Any, Any]]:
    """Pairs of values of a setting that are to give different motions; None: as the base has it."""
    field = model.model_fields[name]
    found, default = kinds(field.annotation), None if field.is_required() else field.get_default()
    texts = [kind for kind in found if isinstance(kind, str)]
    if (given := VALUES.get(f"{model.__name__}.{name}")) is not None:
        yield from ((None, value) for value in given)
    elif bool in found:
        yield None, not default
    elif any(isinstance(kind, type) and issubclass(kind, Varied) for kind in found):
        yield None, 0.6
        yield None, {"vary": 0.6}
        yield None, {"ramp": [[0, 0.5], [1, 1]]}
    elif any(isinstance(kind, type) and issubclass(kind, BaseModel) for kind in found):
        return  # a table of its own
    elif texts:
        yield from ((None, text) for text in texts if text != default)
    elif float in found:
        yield None, 0.7 * default if default else 0.1
    elif int in found:
        yield None, (default or 1) + 2
    else:
        raise AssertionError(f"{model.__name__}.{name}: say another value in VALUES")


def settings_that_do_nothing(table: str) -> list[str]:
    """Settings of a table of which another value changes nothing and is not refused."""
    place, text = TABLES[table]
    idle = []
    for name in MODELS[table].model_fields:
        if name in ELSEWHERE.get(table, ()):
            continue
        base: dict[str, Any] = {}
        add(base, BASE)
        add(base, text)
        add(base, BESIDE.get(f"{table}.{name}", ""))
        for _, second in changes(MODELS[table], name):
            other = copy.deepcopy(base)
            at(other, place)[name] = second
            try:
                acts = outcome(to_toml(other)) != outcome(to_toml(base))
            except UserError as error:
                acts = name in str(error)
            if not acts:
                idle.append(f"{name} = {second}")
    return idle


@pytest.mark.parametrize("table", MODELS)
def test_every_setting_acts_or_is_refused(table):
    assert not settings_that_do_nothing(table)
