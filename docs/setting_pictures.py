"""Draws what settings do: hair with the default on the left, and with another value on the right.

Each setting that is a number, a choice or a switch is tried in a small groom: curls, hairs and braids on hanging locks,
all else on a dome. Settings of the material are tried on hanging curls whose roots move to the side. A setting that
changes nothing there, or needs more than its own table, has no picture.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import tomlkit
from numpy.typing import NDArray
from pydantic import ValidationError
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.groom.recipe import Recipe as GroomRecipe
from ringlet.sim.strands import Strands

from ringlet import Material, Memory, Mesh
from ringlet.groom import make_groom, make_hairs, parse_recipe, read_recipe

RADIUS = 0.06  # of the dome [m]
SIZE, SPACE = (110, 110), 6  # of a panel, between panels [pixels]
LEAST = 1.5  # the largest move of a point that counts as a change [pixels]
POINTS = 60  # of a curve that are drawn, at most
Recipe = dict[str, Any]
Lines = list[NDArray[np.floating]]


@dataclass(frozen=True)
class View:
    """How curves are drawn in a panel.

    origin: of space in the panel [pixels]
    scale:  [pixels per metre] along both axes
    dome:   whether hair grows on a dome, of which the near side is drawn; else it hangs from a sheet
    ball:   whether skin goes on below the dome
    axes:   of space that go to the right and down or up; the third is the depth
    width:  of the sheet [m]
    curves: that are drawn, at most
    """

    origin: tuple[float, float]
    scale: tuple[float, float]
    dome: bool = False
    ball: bool = False
    axes: tuple[int, int] = (0, 1)
    width: float = 0.08
    curves: int = 120


DOME_VIEW = View((55.0, 75.0), (550.0, -550.0), dome=True)
ROW_VIEW = View((55.0, 6.0), (1150.0, 1150.0))  # of locks that hang in a row
CLOSE_VIEW = View((55.0, 4.0), (1700.0, 1700.0), width=0.02)  # of one braid
TOP_VIEW = View((55.0, 55.0), (850.0, 850.0), dome=True, axes=(0, 2), curves=1800)
BORDER_VIEW = View((55.0, 75.0), (550.0, -550.0), dome=True, ball=True, curves=260)
DOME: Recipe = {
    "ringlet": 2,
    "unit": "m",
    "guides": {"count": 24, "length": 0.05, "lift": 0.6, "gravity_bend": 0.8},
    "locks": {"count": 60, "points": 90},
}
HANGING: Recipe = {
    "ringlet": 2,
    "unit": "m",
    "guides": {"count": 12, "length": 0.08, "lift": 1, "gravity_bend": 0, "whorl": False},
    "locks": {"count": 5, "points": 160},
    "curl": {"width": 0.008, "pitch": 0.011},
}
BRAID: Recipe = {
    "ringlet": 2,
    "unit": "m",
    "guides": {"count": 12, "length": 0.065, "lift": 1, "gravity_bend": 0, "whorl": False},
    "locks": {"points": 200, "sections": {"pattern": "grid", "size": 0.3, "strands": 3}},
}
STUBBLE: Recipe = {
    "ringlet": 2,
    "unit": "m",
    "guides": {"count": 60, "length": 0.0015, "lift": 1, "gravity_bend": 0},
    "locks": {"count": 1800, "points": 4, "shape_points": 4, "sections": {"gap": 0.004}},
}
ON_BALL: Recipe = DOME | {"scalp": {"region": "scalp"}}
SHORT: Recipe = ON_BALL | {
    "guides": {"count": 40, "length": 0.006, "lift": 0.8, "gravity_bend": 0},
    "locks": {"count": 700, "points": 40},
}
Stage = tuple[tuple[str, ...], Recipe, View]
STAGES: dict[str, Stage] = {  # by the table of a stage: its place in a recipe, and the groom to try it in
    "Grown": (("guides",), DOME, DOME_VIEW),
    "Locks": (("locks",), DOME, DOME_VIEW),
    "Curl": (("curl",), HANGING, ROW_VIEW),
    "HairSettings": (("hairs",), HANGING | {"hairs": {"per_lock": 12, "points": 160}}, ROW_VIEW),
    "Sections": (("locks", "sections"), STUBBLE, TOP_VIEW),
    "Hairline": (("locks", "hairline"), ON_BALL | {"locks": DOME["locks"] | {"count": 500}}, BORDER_VIEW),
}
WAVY = [{"op": "noise", "magnitude": 0.02, "wavelength": 0.02}]


def in_sections(strands: int, **settings: Any) -> Recipe:
    """A dome with sections."""
    return DOME | {"locks": {"points": 300, "sections": {"size": 0.035, "strands": strands, **settings}}}


def one_strand() -> Recipe:
    """A lock alone in its section."""
    return BRAID | {"locks": {"points": 80, "sections": {"pattern": "grid", "size": 0.3, "strands": 1}}}


GROOMS: dict[str, tuple[Recipe, View]] = {  # what an operator needs
    "smooth": (DOME | {"shape": WAVY}, DOME_VIEW),
    "straighten": (DOME | {"shape": WAVY}, DOME_VIEW),
    "braid": (BRAID, CLOSE_VIEW),
    "twist": (BRAID, CLOSE_VIEW),
    "knot": (in_sections(2), DOME_VIEW),
    "cornrow": (in_sections(3, pattern="rows"), DOME_VIEW),
    "loc": (one_strand() | {"hairs": {"per_lock": 40, "points": 80}}, CLOSE_VIEW),
    "tie": (DOME | {"locks": DOME["locks"] | {"count": 100}}, DOME_VIEW),
    "edges": (SHORT, BORDER_VIEW),
    "finger_wave": (DOME | {"curves": {"line": {"points": [[-0.2, 0.09, 0], [0.2, 0.09, 0]]}}}, DOME_VIEW),
}
GIVEN: dict[str, Recipe] = {  # what an operator is shown with
    "tie": {"toward": [0, 1, 0.4]},
    "edges": {"within": 0.012},
    "finger_wave": {"curve": "line"},
    "braid": {"tail": 0.008},
    "twist": {"tail": 0.008},
}
NOT_DRAWN = {"op", "mask", "name", "blend", "seed"}
FPS, SETTLED, MOVED, SPEED = 24, 30, 6, 0.25  # steps in which curls settle, and in which roots move [1/s, -, -, m/s]


@dataclass(frozen=True)
class Try:
    """A setting with another value: its table and name, both values in words, the grooms with them, and the view."""

    table: str
    name: str
    words: tuple[str, str]
    before: Recipe
    after: Recipe
    view: View


def write_setting_pictures(schemas: dict[str, dict[str, Any]], folder: Path) -> dict[tuple[str, str], str]:
    """Writes the pictures that are not there yet; returns their names by table and setting.

    schemas: of recipes and shots, whose ``$defs`` are the tables
    """
    folder.mkdir(exist_ok=True, parents=True)
    made: dict[tuple[str, str], str] = {}
    memory = Memory()
    known: dict[tuple[str, View], Lines | None] = {}

    def curves(recipe: Recipe, view: View) -> Lines | None:
        text = tomlkit.dumps(recipe)
        if (text, view) not in known:
            known[text, view] = drawn(text, view, memory, hairs="hairs" in recipe)
        return known[text, view]

    def add(
        table: str, name: str, before: Lines | None, after: Lines | None, words: tuple[str, str], view: View
    ) -> None:
        if before is None or after is None or not differ(before, after):
            return
        made[table, name] = f"{table}_{name}.svg".lower()
        text = picture(before, after, words, view)
        path = folder / made[table, name]
        if not path.exists() or path.read_text() != text:
            with replacing(path) as aside:
                aside.write_text(text)

    for one in tries(schemas["recipe"]):
        add(one.table, one.name, curves(one.before, one.view), curves(one.after, one.view), one.words, one.view)
    usual = moved(Material())
    for name, about in schemas["shot"]["$defs"]["Material"]["properties"].items():
        for words, value in other_value(about):
            try:
                other = moved(Material.model_validate({name: value}))
            except ValidationError:  # beyond a bound that depends on another setting
                continue
            add("Material", name, usual, other, (in_words(about["default"], ""), words), ROW_VIEW)
    return made


def tries(schema: dict[str, Any]) -> Iterator[Try]:
    """Every setting of the stages and operators of a recipe with another value."""
    for table, definition in schema["$defs"].items():
        properties = definition.get("properties", {})
        op = properties.get("op", {}).get("const")
        for name, about in properties.items():
            for words, value in other_value(about) if name not in NOT_DRAWN else ():
                if table in STAGES:
                    place, groom, view = STAGES[table]
                    now = at(groom, place).get(name)
                    was = "default" if now is None else in_words(now, about.get("unit", ""))
                    before, after = with_table(groom, place, {}), with_table(groom, place, {name: value})
                    yield Try(table, name, (was, words), before, after, view)
                elif op:
                    groom, view = GROOMS.get(op, (DOME, DOME_VIEW))
                    ahead, own = groom.get("shape", []), {"op": op} | GIVEN.get(op, {})
                    one, other = [*ahead, own], [*ahead, own | {name: value}]
                    was = in_words(own[name], about.get("unit", "")) if name in own else "default"
                    yield Try(table, name, (was, words), groom | {"shape": one}, groom | {"shape": other}, view)


def at(recipe: Recipe, place: tuple[str, ...]) -> Recipe:
    """The table of a recipe at a place; empty without."""
    for key in place:
        recipe = recipe.get(key, {})
    return recipe


def with_table(recipe: Recipe, place: tuple[str, ...], settings: Recipe) -> Recipe:
    """A recipe with settings in its table at a place."""
    key, *inner = place
    own = recipe.get(key, {})
    return recipe | {key: with_table(own, tuple(inner), settings) if inner else own | settings}


def other_value(about: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    """A value that is not the default, in words and as in a recipe; none for what is no number, choice or switch."""
    default, unit = about.get("default"), about.get("unit", "")
    default = default["value"] if isinstance(default, dict) and "value" in default else default
    if isinstance(default, bool):
        yield in_words(not default, unit), not default
    elif about.get("enum"):
        other = next(value for value in reversed(about["enum"]) if value != default)
        yield f"{other}", other
    elif isinstance(default, int | float):
        number = next((kind for kind in about.get("anyOf", [about]) if kind.get("type") in ("number", "integer")), None)
        if number is None:
            return
        most = number.get("maximum", number.get("exclusiveMaximum", np.inf))
        step = {"m": 0.01, "deg": 40.0}.get(unit, 0.6 if most <= 1.0 else 2.0)
        value = min(2.5 * default if default > 0 else step, most)
        value = 0.3 * default if value == default else value
        if number["type"] == "integer":
            value = round(value)
        yield in_words(value, unit), value


def in_words(value: Any, unit: str) -> str:
    """A value with its unit."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return str(value).lower()
    if unit == "m":
        return f"{value:.3g} m" if value >= 1.0 else f"{1e3 * value:.3g} mm"
    return f"{value:.3g}°" if unit == "deg" else f"{value:.3g}"


def drawn(text: str, view: View, memory: Memory, *, hairs: bool) -> Lines | None:
    """Curves of a recipe, back to front, each of shape (n, 2) in a panel [pixels]; None for one that is refused."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "setting.recipe.toml"
        path.write_text(text)
        try:
            mesh = dome(whole=view.ball) if view.dome else ceiling(view.width)
            groom = make_groom(read_recipe(path), mesh, memory=memory)
            curves = make_hairs(groom).curves if hairs else groom.locks
        except (UserError, ValueError, KeyError):
            return None
    return in_panel(curves, view)


def in_panel(curves: Curves, view: View) -> Lines:
    """Curves [m] in a panel [pixels], back to front; of a dome those in front."""
    every = [curves.points[first:last] for first, last in zip(curves.offsets, curves.offsets[1:], strict=False)]
    depth = 3 - sum(view.axes)
    if view.dome:
        every = [curve for curve in every if curve[0, depth] > 0.2 * RADIUS]
    every.sort(key=lambda curve: curve[0, depth])
    shown = every[:: -(-len(every) // view.curves)]
    return [np.array(view.origin) + curve[:, view.axes] * view.scale for curve in shown]


def moved(material: Material) -> Lines:
    """Curls of a material that have settled under their weight, and whose roots then move to the side."""
    groom = make_groom(hanging(), ceiling(ROW_VIEW.width))
    strands, roots = Strands(groom.locks, material), groom.locks.points.copy()
    for step in range(SETTLED + MOVED):
        roots[:, 0] += SPEED / FPS if step >= SETTLED else 0.0
        strands.step(roots, 1.0 / FPS, gravity=(0.0, 9.81, 0.0))  # the ceiling is drawn upside down
    points = strands.positions - (MOVED * SPEED / FPS, 0.0, 0.0)
    return in_panel(groom.locks.with_points(points), ROW_VIEW)


@cache
def hanging() -> GroomRecipe:
    return parse_recipe(tomlkit.dumps(HANGING | {"locks": {"count": 5, "points": 90}}))


@cache
def ceiling(width: float) -> Mesh:
    """A narrow sheet, drawn upside down, that locks hang from in a row."""
    x, z = 0.5 * width, 0.002
    corners = np.array([[-x, 0, -z], [-x, 0, z], [x, 0, z], [x, 0, -z]])
    return Mesh("ceiling", corners, np.array([[0, 1, 2], [0, 2, 3]], np.int32))


@cache
def dome(*, whole: bool) -> Mesh:
    """The upper half of a sphere about the origin, or nearly all of one, whose upper half is the region ``scalp``."""
    rings, sides = (15 if whole else 8), 24
    polar = (np.arange(1, rings + 1) * np.pi / 16)[:, None]
    around = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)[None]
    shape = np.broadcast(polar, around).shape
    across, up = np.sin(polar), np.broadcast_to(np.cos(polar), shape)
    ring = np.stack([across * np.sin(around), up, across * np.cos(around)], axis=-1).reshape(-1, 3)
    points = RADIUS * np.concatenate([[[0.0, 1.0, 0.0]], ring])
    k = np.arange(sides, dtype=np.int32)
    faces = [np.stack([0 * k, 1 + k, 1 + (k + 1) % sides], axis=1)]
    for row in range(rings - 1):
        a, b = 1 + row * sides + k, 1 + row * sides + (k + 1) % sides
        faces += [np.stack([a, a + sides, b + sides], axis=1), np.stack([a, b + sides, b], axis=1)]
    scalp = np.arange((2 * 8 - 1) * sides, dtype=np.int32)
    return Mesh("dome", points, np.concatenate(faces), regions={"scalp": scalp})


def differ(before: Lines, after: Lines) -> bool:
    """Whether the drawn curves are visibly others."""
    if [curve.shape for curve in before] != [curve.shape for curve in after]:
        return True
    return any(np.abs(a - b).max() > LEAST for a, b in zip(before, after, strict=True))


def picture(before: Lines, after: Lines, words: tuple[str, str], view: View) -> str:
    """An SVG of both, side by side, with the values under them."""
    width, height = SIZE
    whole = 2 * width + SPACE, height + 16
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {whole[0]} {whole[1]}" width="{whole[0]}" '
        f'height="{whole[1]}" font-family="sans-serif" font-size="11" text-anchor="middle">'
        f"{panel(before, 0, words[0], view)}{panel(after, width + SPACE, words[1], view)}</svg>\n"
    )


def panel(curves: Lines, left: int, words: str, view: View) -> str:
    """One side of a picture."""
    width, height = SIZE
    lines = []
    for number, curve in enumerate(curves):
        kept = np.unique(np.linspace(0, len(curve) - 1, max(POINTS, len(curve) // 2)).round().astype(int))
        places = " ".join(f"{left + x:.1f},{y:.1f}" for x, y in curve[kept].tolist())
        lines.append(f'<polyline points="{places}" stroke="hsl(25 40% {30 + 25 * number // len(curves)}%)"/>')
    clip = f'<clipPath id="p{left}"><rect x="{left}" y="0" width="{width}" height="{height}"/></clipPath>'
    hair = f'<g fill="none" stroke-width="0.9" stroke-linejoin="round">{"".join(lines)}</g>'
    x, y = left + view.origin[0], view.origin[1]
    head = f'<circle cx="{x}" cy="{y}" r="{view.scale[0] * RADIUS:.0f}" fill="#e8e0d8"/>' if view.dome else ""
    back = f'<rect x="{left}" width="{width}" height="{height}" fill="#faf8f6"/>'
    return (
        f'{clip}{back}<g clip-path="url(#p{left})">{head}{hair}</g>'
        f'<text x="{left + 0.5 * width}" y="{height + 12}" fill="#6d6863">{words}</text>'
    )
