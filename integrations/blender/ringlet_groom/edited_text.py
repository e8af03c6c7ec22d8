"""A recipe or a shot as the .blend keeps it: its text, and changes that Ringlet has not put into the text yet.

Both together say what the recipe is at any time, so that a slider counts at once, also for undo. Ringlet answers with
the text that has the changes in it, with all comments.
"""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from typing import Any

UNITS = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "in": 0.0254}
Place = tuple[str | int, ...]
MISSING = object()


def stem_of(name: str) -> str:
    """The name of a recipe or a shot without its extension; the number that Blender adds to one that is taken stays."""
    found = re.fullmatch(r"(.*?)(?:\.recipe|\.shot)?\.toml(\.\d+)?", name, re.DOTALL)
    return f"{found[1]}{found[2] or ''}" if found else name


def with_change(changes: str, change: dict[str, Any]) -> str:
    """Changes with one more, as JSON. Of several values for one setting the last stays."""
    kept = json.loads(changes or "[]")
    if "set" in change:
        last_move = max((k for k, one in enumerate(kept) if "set" not in one), default=-1)
        kept = [one for k, one in enumerate(kept) if k <= last_move or one["set"] != change["set"]]
    return json.dumps([*kept, change])


def value_at(settings: dict[str, Any], place: Sequence[str | int], default: Any = None) -> Any:
    """The value at a place of all settings; the default where a table on the path is absent."""
    found: Any = settings
    for key in place:
        rows: Any = dict(enumerate(found)) if isinstance(found, list) else found
        if not isinstance(rows, dict) or key not in rows:
            return default
        found = rows[key]
    return found


def pending(changes: str, place: Sequence[str | int]) -> Any:
    """The value that changes give a place, in the notation of the text; MISSING where they do not."""
    for change in reversed(json.loads(changes or "[]")):
        if "set" not in change:  # rows may have moved: what Ringlet answers counts
            return MISSING
        if change["set"] == list(place):
            return change["value"]
    return MISSING


def length_in(unit: str, metres: float) -> float:
    """A length in the unit of a recipe, to the digits that a slider has."""
    return float(f"{metres / UNITS[unit]:.6g}")


def in_metres(unit: str, value: Any) -> float:
    """A length of a recipe, a number or a text such as ``5 mm``, in metres."""
    if isinstance(value, str):
        number, _, own = value.strip().partition(" ")
        return float(number) * UNITS[own.strip()]
    return float(value) * UNITS[unit]


def ramp_text(ramp: Any) -> str:
    """A ramp in a line: ``0 1, 0.5 0.8``."""
    return ", ".join(f"{at:g} {factor:g}" for at, factor in ramp or [])


def parse_ramp(text: str) -> list[list[float]] | None:
    """The ramp of a line; None for another text."""
    try:
        pairs = [[float(number) for number in part.split()] for part in text.split(",") if part.strip()]
    except ValueError:
        return None
    return pairs if pairs and all(len(pair) == 2 for pair in pairs) else None
