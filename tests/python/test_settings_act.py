"""Every setting of a recipe acts or is refused: for each in the schema, another value gives another groom."""

from __future__ import annotations

import copy
import tomllib
from collections.abc import Iterator
from functools import cache
from typing import Any, get_args

import numpy as np
import pytest
from pydantic import BaseModel
from ringlet.data.digest import digest
from ringlet.data.quantities import Quantity, Ramped, Varied
from ringlet.data.toml import to_toml
from ringlet.groom.mask import Mask
from ringlet.groom.recipe import Recipe
from settings_walk import add, at, kinds, tables
from shapes import ball

from ringlet import Curves, Memory, UserError
from ringlet.groom import make_groom, make_hairs, parse_recipe

BASE = """
ringlet = 2
seed = 3
[scalp]
region = "scalp"
[guides]
count = 8
length = 6
lift = 0.5
[locks]
count = 8
points = 24
[hairs]
per_lock = 4
points = 8
"""
TAIL = "[curves.tail]\npoints = [[0, 9, -1], [0, 6, -11], [0, -4, -12]]\n"
OTHER = "[curves.other]\npoints = [[0, 9, 1], [0, 6, 11]]\n"
ROUND = "[meshes.round]\nmiddle = [0, 0, 0]\nwidth = 22\nheight = 22\ndepth = 22\n"
STRANDS = "[guides]\nlength = 10\n[locks]\ncount = 'none'\npoints = 60\n[locks.sections]\nsize = 30\nstrands = 3\n"
STRANDS += "[hairs]\nper_lock = 2\n"
ROWS = STRANDS.replace("size = 30", "size = 9\npattern = 'rows'").replace("points = 60", "points = 90")
FAMILIES = "[hairs]\nper_lock = 12\npoints = 80\n[hairs.families]\n"
WOVEN = STRANDS + "[[shape]]\nwidth = 2\npitch = 5\n"

# Where each table is, and the smallest recipe besides BASE in which its settings act.
TABLES: dict[str, tuple[str, str]] = {
    "Recipe": ("", ""),
    "ScalpSettings": ("scalp", ""),
    "Edge": ("scalp.edge", "[scalp.edge]\nregion = 'front'\nwidth = 1\n"),
    "HelperCurves": ("curves.tail", TAIL + "[[shape]]\nop = 'attract'\ncurve = 'tail'\n"),
    "Gradient": (
        "gradients.taper",
        TAIL + "[gradients.taper]\ntoward = [0, 1, 0]\nend = 9\n[guides]\nlength = { value = 6, map = 'taper' }\n",
    ),
    "HelperMesh": ("meshes.round", ROUND + "[[shape]]\nop = 'grow_to'\nmesh = 'round'\n"),
    "Grown": ("guides", TAIL),
    "Mirror": ("guides.mirror", "[guides.mirror]\n"),
    "PartLine": ("guides.part_line", TAIL + "[guides.part_line]\n"),
    "Zone": ("guides.zone.0", "[[guides.zone]]\ntoward = [0, 1, 0]\nangle = 90\nlength = 2\n"),
    "Sculpt": ("sculpt.0", "[[sculpt]]\nguide = GUIDE\nlength = 1.5\n"),
    "Locks": ("locks", ""),
    "Sections": ("locks.sections", TAIL + "[locks]\ncount = 'none'\n[locks.sections]\nsize = 6\nstrands = 2\n"),
    "Hairline": ("locks.hairline", "[locks]\ncount = 40\n[locks.hairline]\nwidth = 4\n"),
    "Resample": ("shape.0", "[[shape]]\nop = 'resample'\n[[shape]]\nop = 'scraggle'\n"),
    "Length": ("shape.0", "[[shape]]\nop = 'length'\nfactor = 0.7\n"),
    "Clump": ("shape.0", "[locks]\ncount = 40\n[[shape]]\nop = 'clump'\nsize = 6\n"),
    "Tie": ("shape.0", TAIL + "[[shape]]\nop = 'tie'\ntoward = [0, 1, -0.35]\n"),
    "Flyaways": ("shape.0", "[[shape]]\nop = 'flyaways'\nshare = 0.5\n"),
    "Attract": ("shape.0", TAIL + OTHER + "[[shape]]\nop = 'attract'\ncurve = 'tail'\n"),
    "Cut": ("shape.0", TAIL + ROUND + "[[shape]]\nop = 'cut'\nat = -3\n"),
    "GrowTo": ("shape.0", TAIL + ROUND + "[[shape]]\nop = 'grow_to'\nmesh = 'round'\n"),
    "Braid": ("shape.0", WOVEN + "op = 'braid'\n"),
    "Twist": ("shape.0", WOVEN + "op = 'twist'\n"),
    "Cornrow": ("shape.0", TAIL + ROWS + "[[shape]]\nop = 'cornrow'\nwidth = 2\npitch = 5\nlength = 4\n"),
    "Knot": ("shape.0", STRANDS.replace("60", "150") + "[[shape]]\nop = 'knot'\npitch = 12\n"),
    "Edges": ("shape.0", "[locks]\ncount = 40\n[[shape]]\nop = 'edges'\nwithin = 3\n"),
    "FingerWave": ("shape.0", TAIL + OTHER + "[[shape]]\nop = 'finger_wave'\ncurve = 'tail'\n"),
    "Curl": ("curl", "[curl]\ncurls = 2\n"),
    "PhaseGroups": ("curl.phase_groups", "[curl]\ncurls = 2\n[curl.phase_groups]\nsize = 8\n"),
    "Edit": ("edit.0", "[curl]\ncurls = 2\n[[edit]]\nlock = LOCK\nmove = [{ at = 0.5, by = [0.5, 0.2, 0.1] }]\n"),
    "Move": ("edit.0.move.0", "[[edit]]\nlock = LOCK\nmove = [{ at = 0.5, by = [0.5, 0, 0] }]\n"),
    "Pin": ("pin.0", "[[pin]]\nlength = 2\n"),
    "Collide": ("collide", "[guides]\nlift = 0\n"),
    "HairSettings": ("hairs", "[hairs]\nper_lock = 12\n"),
    "Families": ("hairs.families", FAMILIES),
    "HairCurl": ("hairs.curl", "[curl]\ncurls = 3\n" + FAMILIES + "[hairs.curl]\nslips = 1\n"),
    "HairCoil": ("hairs.coil", FAMILIES + "[hairs.coil]\n"),
    "ColorSettings": ("color", "[color]\n"),
    "Dye": ("color.dye", "[color.dye]\n"),
    "FiberSettings": ("fiber", "[color]\n[fiber]\nflatness = 0.5\n"),
}

# What a setting acts beside: further settings of its table, or tables of the recipe.
BESIDE = {
    "Edge.turn": "\n[guides]\nlift = 0\n",
    "Grown.flow": "whorl = false\n",
    "Grown.spacing": "\n[guides]\ncount = 'none'\nspacing = 4\n",
    "Locks.spacing": "\n[locks]\ncount = 'none'\nspacing = 6\n",
    "Clump.finer": "levels = 3\n",
    "Tie.width": "after = 'ball'\n",
    "Tie.height": "after = 'bun'\n",
    "Tie.windings": "after = 'bun'\n",
    "Tie.each": "\n[locks.sections]\nsize = 6\nstrands = 2\n",
    "Cut.each": "\n[guides]\nlength = 20\ngravity_bend = 5\n[locks.sections]\nsize = 6\nstrands = 2\n",
    "GrowTo.each": "\n[locks.sections]\nsize = 6\nstrands = 2\n",
    "Edges.wavelength": "wave = 60\n",
    "Curl.pitch": "\n[curl]\ncurls = 'none'\npitch = 2\n",
    "Curl.curls_per_cm": "\n[curl]\ncurls = 'none'\ncurls_per_cm = 0.2\n",
    "Curl.phase_wavelength": "phase_coherence = 1\n",
    "Curl.closing": "end = 3\n",
    "Curl.wave_pitch": "wave = 2\n",
    "HairSettings.apart": "blend = 1\n",
    "HairSettings.stray_distance": "stray = 1\n",
    "FiberSettings.seed": "vary_hairs = 0.5\n",
    "Loc.start": "\n[locks.sections]\nsize = 6\nstrands = 2\n",
    "Loc.bud_at": "bud = 1\n",
    "Loc.bud_length": "bud = 1\n",
}
BESIDE |= {f"Tie.{name}": "band = 0.4\n" for name in ("bead", "colors")}
for woven in ("Braid", "Twist", "Cornrow"):
    BESIDE |= {f"{woven}.{name}": "end = 'bead'\n" for name in ("bead", "bead_length", "beads")}
    BESIDE |= {f"{woven}.{name}": "band = '1 mm'\n" for name in ("density", "colors")}

# Other values of settings for which the schema does not say one.
VALUES = {
    "Recipe.seed": [4],
    "Recipe.unit": ["mm"],
    "ScalpSettings.region": ["front"],
    "Grown.density": ["paint"],
    "Grown.direction": ["combed"],
    "Grown.drawn": [["tail"]],
    "Grown.whorl": [False],
    "PartLine.curve": ["tail"],
    "Gradient.curve": ["tail"],
    "HelperCurves.points": [[[0, 9, 0], [3, 14, 1]]],
    "Locks.density": ["paint"],
    "Tie.curve": ["tail"],
    "Attract.curve": ["other"],
    "Cut.line": ["tail"],
    "Cut.mesh": ["round"],
    "GrowTo.line": ["tail"],
    "GrowTo.mesh": ["other"],
    "Cornrow.path": ["tail"],
    "Sculpt.guide": [1],
    "Sculpt.offsets": [[[0, 0, 0], [1, 0, 0]]],
    "Edit.lock": [1],
    "Edit.set": [{"curl.width": "2 cm"}],
    "Edit.curve": [[[0, 0, 0], [1, 0, 3]]],
    "Edit.offsets": [[[0, 0, 0], [1, 0, 0]]],
    "Curl.curls": [3],
    "Curl.pitch": ["3 cm"],
    "ColorSettings.preset": ["blond"],
    "Dye.regrowth": ["2 cm"],
    "Curl.curls_per_cm": [0.3],
    "Dye.color": ["#00ff00"],
    "Edge.region": ["scalp"],
    "Mirror.across": [[-1, 0, 0]],
    "Mirror.offset": ["0.2 mm"],
    "Mirror.seam": ["3 cm"],
    "Mirror.tolerance": [0],
    "Edge.lines": [["tail"]],
    "Locks.apart": [2],
    "Clump.apart": [2],
    "Cut.at": ["-4 cm"],
    "PhaseGroups.apart": [2],
    "Edges.alternate": ["3 cm"],
    "Edges.within": ["9 cm"],
    "FingerWave.curve": ["other"],
    "FingerWave.end": ["3 cm"],
    "Cut.spread": ["3 cm"],
    "GrowTo.least": ["20 cm"],
    "Cornrow.blend": [0.4],
    "Cornrow.off": ["2 cm"],
    "Cornrow.length": ["6 cm"],
    "HairSettings.cover": [0.5],
    "HairSettings.per_lock": [7],
    "Braid.beads": [3],
    "Knot.right_handed": [0],
    "Twist.right_handed": [0],
    "Braid.pattern": ["under"],
    "Sections.part_lines": ["tail"],
    "Sections.pattern": ["grid", "rows", "triangles", "radial"],
    "Twist.beads": [3],
    "Cornrow.beads": [3],
}

# Files and places in them, which the tests of those files change, as they do all of ``Drawn``; a name and a version.
ELSEWHERE = {
    "Recipe": ["ringlet", "name", "extends", "edits", "maps", "grooms"],
    "ScalpSettings": ["unit", "up", "file", "mesh", "surface", "hide"],
    "HelperCurves": ["file", "prim"],
    "HelperMesh": ["file", "mesh"],
    "HairSettings": ["file", "offset"],
}
UNITS = {"m": " m", "/cm2": " /cm2"}


def quantity(annotation: Any, metadata: list[Any]) -> Quantity | None:
    """The quantity of a setting, also of one that may be absent."""
    inner = [one for part in get_args(annotation) for one in getattr(part, "__metadata__", ())]
    return next((one for one in (*metadata, *inner) if isinstance(one, Quantity)), None)


def another(low: float, high: float, now: float | None) -> float:
    """A number within bounds that is not far from another."""
    tries = (1.4 * now, 0.6 * now) if now else ()
    tries = (*tries, 0.3 * high if high <= 1.0 else min(0.5 * high, 2.0), low + 0.1 * (high - low))
    return next(one for one in tries if low <= one <= high and one != now)


def changes(model: type[BaseModel], name: str) -> Iterator[tuple[Any, Any]]:
    """Pairs of values of a setting that are to give different grooms; None: as the base has it."""
    field = model.model_fields[name]
    found, default = kinds(field.annotation), None if field.is_required() else field.get_default()
    bounds = quantity(field.annotation, field.metadata)
    texts = [kind for kind in found if isinstance(kind, str)]
    varied = next((kind for kind in found if isinstance(kind, type) and issubclass(kind, Varied)), None)
    if (given := VALUES.get(f"{model.__name__}.{name}")) is not None:
        yield from ((None, value) for value in given)
    elif bool in found:
        yield None, not default
    elif varied is not None and bounds is not None:
        now = default.value if isinstance(default, Varied) else None
        unit = UNITS.get(bounds.unit)
        value = another(bounds.least, bounds.most, now)
        one = {"value": f"{value!r}{unit}" if unit else value, "vary": 0.0}
        yield None, one["value"]
        yield one, {**one, "vary": 0.6}
        if issubclass(varied, Ramped):
            yield {**one, "ramp": [[0, 1], [1, 1]]}, {**one, "ramp": [[0, 0.6], [0.5, 1], [1, 0.4]]}
    elif Mask in found:
        yield None, {"where": "id < 0"}
        yield None, {"region": "chin"}
        yield None, {"ramp": [[0, 0.2], [1, 0.6]]}
    elif texts:
        yield from ((None, text) for text in texts if text != default)
    elif bounds is not None:
        value, unit = another(bounds.least, bounds.most, default), UNITS.get(bounds.unit)
        yield None, f"{value!r}{unit}" if unit else value
    elif any(isinstance(kind, type) and issubclass(kind, BaseModel) for kind in found):
        return  # a table of its own
    elif name in ("opening", "closing"):
        yield None, [[0, 0.5], [1, 1]]
    elif "tuple[" in str(field.annotation):
        yield None, [0.3, 0.6, -0.5]
    elif int in found:
        yield None, (default or 4) + 2
    elif name == "colors":
        yield None, ["#ff0000"]
    else:
        raise AssertionError(f"{model.__name__}.{name}: say another value in VALUES")


MODELS = {name: model for name, model in tables(Recipe, {}).items() if name != "Drawn"}


@cache
def scalp():
    """A ball whose upper half is the scalp, with painted values and directions."""
    made = ball(rings=10)
    corners = made.points[made.triangles]
    in_front = (corners.mean(axis=1)[:, 2] > 0.0) & (corners.mean(axis=1)[:, 1] > 0.0)
    made.regions["front"] = np.flatnonzero(in_front).astype(np.int32)
    made.regions["chin"] = np.array([len(made.triangles) - 1], np.int32)
    made.maps["paint"] = 0.2 + 0.8 * (corners[:, :, 0] > 0.0)
    made.vectors["combed"] = np.broadcast_to([1.0, 0.2, 0.0], corners.shape).copy()
    return made


MEMORY = Memory()  # stages before the one with the setting are made once


@cache
def outcome(text: str) -> str:
    """A digest of all that a recipe makes: guides, locks, what they wear, pins and hairs."""
    made = make_groom(parse_recipe(text), scalp(), memory=MEMORY)
    hairs = make_hairs(made).curves
    worn = [part for one in made.accessories for part in (one.mesh.points, one.mesh.color)]
    return digest(*(part for curves in (made.guides, made.locks, hairs) for part in contents(curves)), *worn)


def contents(curves: Curves) -> Iterator[Any]:
    yield from (curves.points, curves.offsets, curves.ids)
    for name, values in sorted({**curves.curve, **{f"point {n}": v for n, v in curves.point.items()}}.items()):
        yield from (name, np.asarray(values))


@cache
def ids() -> tuple[int, int]:
    """The ids of a guide and of a lock of the base."""
    made = make_groom(parse_recipe(BASE), scalp())
    return int(made.guides.ids[0]), int(made.locks.ids[0])


def recipe_for(table: str, name: str) -> tuple[dict[str, Any], str]:
    """The tables of a recipe in which a setting acts, and the place of its table."""
    place, text = TABLES.get(table, ("shape.0", f"[[shape]]\nop = '{table.lower()}'\n"))
    data: dict[str, Any] = {}
    add(data, BASE)
    add(data, text.replace("GUIDE", str(ids()[0])).replace("LOCK", str(ids()[1])))
    beside = BESIDE.get(f"{table}.{name}", "")
    if beside.startswith("\n["):
        add(data, beside)
    else:
        at(data, place).update(tomllib.loads(beside))
    return data, place


SETTINGS = [
    f"{table}.{name}"
    for table, model in MODELS.items()
    for name in model.model_fields
    if name not in ("op", *ELSEWHERE.get(table, ())) and any(changes(model, name))
]


@pytest.mark.parametrize("setting", SETTINGS)
def test_every_setting_acts_or_is_refused(setting):
    table, name = setting.split(".")
    base, place = recipe_for(table, name)
    for first, second in changes(MODELS[table], name):
        one, other = copy.deepcopy(base), copy.deepcopy(base)
        if first is not None:
            at(one, place)[name] = first
        at(other, place)[name] = second
        before = outcome(to_toml(one))
        try:
            after = outcome(to_toml(other))
        except UserError as error:
            assert name in str(error)
        else:
            assert after != before, second


def test_the_context_of_each_setting_is_that_of_one_that_is_there():
    known = {f"{table}.{name}" for table, model in MODELS.items() for name in model.model_fields}
    elsewhere = {f"{table}.{name}" for table, names in ELSEWHERE.items() for name in names}
    assert BESIDE.keys() | VALUES.keys() | elsewhere <= known and TABLES.keys() <= MODELS.keys()
