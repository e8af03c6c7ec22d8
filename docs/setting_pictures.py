"""Draws what settings of recipes do: hair with the default on the left, and with another value on the right.

Each setting that is a number, a choice or a switch is tried in a small groom: curls and hairs on hanging locks, all
else on a dome. One that changes nothing there, or needs more than its own table, has no picture.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import tomlkit
from numpy.typing import NDArray
from ringlet.data.errors import UserError
from ringlet.data.files import replacing

from ringlet import Mesh
from ringlet.groom import make_groom, make_hairs, read_recipe

RADIUS = 0.06  # of the dome [m]
SIZE, CENTRE, SPACE = (110, 110), (55.0, 75.0), 6  # of a panel, of the dome in it, between panels [pixels]
SCALE = 550.0  # of the dome [pixels per metre]
LEAST = 1.5  # the largest move of a point that counts as a change [pixels]
POINTS, CURVES = 60, 120  # that are drawn, at most
Recipe = dict[str, Any]
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
STAGES: dict[str, tuple[str, Recipe]] = {  # by the table of a stage: its name in a recipe, and the groom to try it in
    "Grown": ("guides", DOME),
    "Locks": ("locks", DOME),
    "Curl": ("curl", HANGING),
    "HairSettings": ("hairs", HANGING | {"hairs": {"per_lock": 12, "points": 160}}),
}
WAVY = [{"op": "noise", "magnitude": 0.02, "wavelength": 0.02}]
SECTIONS = {"locks": DOME["locks"] | {"sections": {"size": 0.03}}}
BEFORE: dict[str, Recipe] = {  # what an operator needs
    "smooth": {"shape": WAVY},
    "straighten": {"shape": WAVY},
    **dict.fromkeys(("braid", "twist", "loc", "knot", "tie"), SECTIONS),
}
NOT_DRAWN = {"op", "mask", "name", "blend", "seed"}


@dataclass(frozen=True)
class Try:
    """A setting with another value: its table and name, both values in words, and the grooms with them."""

    table: str
    name: str
    words: tuple[str, str]
    before: Recipe
    after: Recipe


def write_setting_pictures(schema: dict[str, Any], folder: Path) -> dict[tuple[str, str], str]:
    """Writes the pictures that are not there yet; returns their names by table and setting.

    schema: of recipes, whose ``$defs`` are the tables
    """
    folder.mkdir(exist_ok=True, parents=True)
    made: dict[tuple[str, str], str] = {}
    known: dict[str, list[NDArray[np.floating]] | None] = {}

    def curves(recipe: Recipe) -> list[NDArray[np.floating]] | None:
        text = tomlkit.dumps(recipe)
        if text not in known:
            known[text] = drawn(text, hanging="curl" in recipe, hairs="hairs" in recipe)
        return known[text]

    for one in tries(schema):
        before, after = curves(one.before), curves(one.after)
        if before is None or after is None or not differ(before, after):
            continue
        name = f"{one.table}_{one.name}.svg".lower()
        text = picture(before, after, one.words, on_dome="curl" not in one.before)
        path = folder / name
        if not path.exists() or path.read_text() != text:
            with replacing(path) as aside:
                aside.write_text(text)
        made[one.table, one.name] = name
    return made


def tries(schema: dict[str, Any]) -> Iterator[Try]:
    """Every setting of the stages and operators with another value."""
    for table, definition in schema["$defs"].items():
        properties = definition.get("properties", {})
        op = properties.get("op", {}).get("const")
        for name, about in properties.items():
            for words, value in other_value(about) if name not in NOT_DRAWN else ():
                if table in STAGES:
                    stage, before = STAGES[table]
                    now = before[stage].get(name)
                    was = "default" if now is None else in_words(now, about.get("unit", ""))
                    yield Try(table, name, (was, words), before, before | {stage: before[stage] | {name: value}})
                elif op:
                    groom = DOME | BEFORE.get(op, {})
                    ahead = groom.get("shape", [])
                    one, other = [*ahead, {"op": op}], [*ahead, {"op": op, name: value}]
                    yield Try(table, name, ("default", words), groom | {"shape": one}, groom | {"shape": other})


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


def drawn(text: str, *, hanging: bool, hairs: bool) -> list[NDArray[np.floating]] | None:
    """Curves of a recipe, back to front, each of shape (n, 2) in a panel [pixels]; None for one that is refused."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "setting.recipe.toml"
        path.write_text(text)
        try:
            groom = make_groom(read_recipe(path), ceiling() if hanging else dome())
            curves = make_hairs(groom).curves if hairs else groom.locks
        except (UserError, ValueError, KeyError):
            return None
    every = [curves.points[first:last] for first, last in zip(curves.offsets, curves.offsets[1:], strict=False)]
    if not hanging:
        every = [curve for curve in every if curve[0, 2] > 0.2 * RADIUS]
    every.sort(key=lambda curve: curve[0, 2])
    middle, scale = ((0.5 * SIZE[0], 6.0), (1150.0, 1150.0)) if hanging else (CENTRE, (SCALE, -SCALE))
    return [np.array(middle) + curve[:, :2] * scale for curve in every[:: -(-len(every) // CURVES)]]


def ceiling() -> Mesh:
    """A narrow sheet, drawn upside down, that locks hang from in a row."""
    corners = np.array([[-0.04, 0, -0.002], [-0.04, 0, 0.002], [0.04, 0, 0.002], [0.04, 0, -0.002]])
    return Mesh("ceiling", corners, np.array([[0, 1, 2], [0, 2, 3]], np.int32))


def dome() -> Mesh:
    """The upper half of a sphere about the origin."""
    rings, sides = 8, 24
    polar = np.linspace(0.0, 0.5 * np.pi, rings + 1)[1:, None]
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
    return Mesh("dome", points, np.concatenate(faces))


def differ(before: list[NDArray[np.floating]], after: list[NDArray[np.floating]]) -> bool:
    """Whether the drawn curves are visibly others."""
    if [curve.shape for curve in before] != [curve.shape for curve in after]:
        return True
    return any(np.abs(a - b).max() > LEAST for a, b in zip(before, after, strict=True))


def picture(
    before: list[NDArray[np.floating]], after: list[NDArray[np.floating]], words: tuple[str, str], on_dome: bool
) -> str:
    """An SVG of both, side by side, with the values under them."""
    width, height = SIZE
    whole = 2 * width + SPACE, height + 16
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {whole[0]} {whole[1]}" width="{whole[0]}" '
        f'height="{whole[1]}" font-family="sans-serif" font-size="11" text-anchor="middle">'
        f"{panel(before, 0, words[0], on_dome)}{panel(after, width + SPACE, words[1], on_dome)}</svg>\n"
    )


def panel(curves: list[NDArray[np.floating]], left: int, words: str, on_dome: bool) -> str:
    """One side of a picture."""
    width, height = SIZE
    lines = []
    for number, curve in enumerate(curves):
        kept = np.unique(np.linspace(0, len(curve) - 1, max(POINTS, len(curve) // 2)).round().astype(int))
        places = " ".join(f"{left + x:.1f},{y:.1f}" for x, y in curve[kept])
        lines.append(f'<polyline points="{places}" stroke="hsl(25 40% {30 + 25 * number // len(curves)}%)"/>')
    clip = f'<clipPath id="p{left}"><rect x="{left}" y="0" width="{width}" height="{height}"/></clipPath>'
    hair = f'<g fill="none" stroke-width="0.9" stroke-linejoin="round">{"".join(lines)}</g>'
    x, y = left + CENTRE[0], CENTRE[1]
    head = f'<circle cx="{x}" cy="{y}" r="{SCALE * RADIUS:.0f}" fill="#e8e0d8"/>' if on_dome else ""
    back = f'<rect x="{left}" width="{width}" height="{height}" fill="#faf8f6"/>'
    return (
        f'{clip}{back}<g clip-path="url(#p{left})">{head}{hair}</g>'
        f'<text x="{left + 0.5 * width}" y="{height + 12}" fill="#6d6863">{words}</text>'
    )
