"""Sets the pigments of a recipe to those of a color that was picked in a picture."""

from __future__ import annotations

import tomllib

from ringlet.data.pigment import DEFAULT_COLOR, HAIR_COLORS, linear_color, pigments_of_color
from ringlet.groom import Recipe
from ringlet.viewer.files.open_files import Files

FAR = 0.06  # distance of colors, in steps of lightness from 0 to 1, from which melanin does not have one


def pick(files: Files, color: str) -> str:
    """Sets melanin and redness of the chosen groom so that its hair has a color, as one undo step.

    color: sRGB, ``#rrggbb``

    Returns what was set, and whether melanin has that color.
    """
    recipe = files.chosen_recipe
    melanin, redness, distance = pigments_of_color(linear_color(color), _roughness(recipe))
    table = tomllib.loads(recipe.text or "").get("color", {})
    values = {"melanin": round(melanin, 3), "redness": round(redness, 3)}
    files.set("recipe", [(_place(table, name), value) for name, value in values.items()])
    said = f"{color} is melanin {values['melanin']:g}, redness {values['redness']:g}"
    return said if distance < FAR else f"{said}, the nearest natural color; a dye has {color} itself"


def _roughness(recipe: Recipe) -> float:
    """Azimuthal roughness of the fiber of a recipe, its variation aside."""
    own = recipe.fiber.azimuthal_roughness if recipe.fiber else None
    preset = recipe.color.preset if recipe.color else None
    return own.value if own else HAIR_COLORS[preset or DEFAULT_COLOR].azimuthal_roughness


def _place(table: dict[str, object], name: str) -> list[str | int]:
    """Place of a setting, or of its value where it also has a ramp or a variation."""
    return ["color", name, "value"] if isinstance(table.get(name), dict) else ["color", name]
