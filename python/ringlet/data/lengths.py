"""Lengths with a unit as text, such as ``5 mm``."""

from __future__ import annotations

import re

UNITS: dict[str, float] = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "in": 0.0254}


def measure(text: str, units: dict[str, float] = UNITS) -> float | None:
    """A number with one of the units, in SI; None for other text."""
    match = re.fullmatch(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*([a-z]+|/cm2)\s*", text)
    if not match or match[2] not in units:
        return None
    try:
        return float(match[1]) * units[match[2]]
    except ValueError:
        return None
