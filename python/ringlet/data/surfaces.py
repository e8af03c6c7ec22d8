"""What a surface is made of, and its colour where it has none, guessed from its name."""

from __future__ import annotations

import re

Color = tuple[float, float, float]

# The last component of a name decides, by the first pattern that matches: material, linear colour, names.
_SURFACES: tuple[tuple[str, Color, str], ...] = (
    ("matte", (0.03, 0.017, 0.012), r"brow|lash"),
    ("matte", (0.2, 0.05, 0.04), r"mouth|nostril|gum|tongue"),
    ("eye", (0.08, 0.03, 0.013), r"iris"),
    ("eye", (0.004, 0.004, 0.004), r"pupil"),
    ("eye", (0.75, 0.73, 0.69), r"eye|white|cornea|sclera|teeth"),
    ("cloth", (0.3, 0.3, 0.32), r"shirt|cloth|tee|dress|jacket|sweater|hood|scarf|collar"),
    ("skin", (0.3, 0.14, 0.08), r"skin|head|face|body|scalp|neck|ear|bust|child"),
)
UNCOLORED: Color = 0.5, 0.5, 0.5
_OTHER = "matte", UNCOLORED


def material_of(name: str) -> str:
    """Material of a surface: skin, eye, cloth or matte."""
    return _guessed(name)[0]


def color_of(name: str) -> Color:
    """Display colour of a surface that has none (linear r, g, b)."""
    return _guessed(name)[1]


def _guessed(name: str) -> tuple[str, Color]:
    last = re.split(r"[/\s]", name.lower())[-1]
    return next(((made, color) for made, color, names in _SURFACES if re.search(names, last)), _OTHER)
