"""Named curl types. A preset fills what the recipe's ``[curl]`` does not say; it is written as a recipe would."""

from __future__ import annotations

from typing import Any, Literal

Preset = Literal["3B", "3C", "4A", "4C"]

# Diameters after the hair typing in common use (3B: a marker pen, 3C: a pencil, 4A: a crochet needle, 4C: coils hardly
# seen). Pitch, the rise from turn to turn, is that of hair that carries little weight: tighter hair stands closer.
PRESETS: dict[str, dict[str, Any]] = {
    "3B": {
        "width": {"value": "16 mm", "vary": 0.2, "ramp": [(0, 0.8), (0.3, 1), (1, 0.85)]},
        "pitch": {"value": "22 mm", "vary": 0.15},
        "start": "20 mm",
        "irregularity": 0.2,
    },
    "3C": {
        "width": {"value": "9 mm", "vary": 0.2, "ramp": [(0, 0.8), (0.3, 1), (1, 0.8)]},
        "pitch": {"value": "12 mm", "vary": 0.15},
        "start": "12 mm",
        "irregularity": 0.2,
    },
    "4A": {
        "width": {"value": "5 mm", "vary": 0.2, "ramp": [(0, 0.8), (0.3, 1), (1, 0.8)]},
        "pitch": {"value": "6.5 mm", "vary": 0.15},
        "start": "6 mm",
        "irregularity": 0.25,
    },
    "4C": {
        "width": {"value": "3.5 mm", "vary": 0.3, "ramp": [(0, 0.8), (0.3, 1), (1, 0.9)]},
        "pitch": {"value": "4.2 mm", "vary": 0.25},
        "start": "4 mm",
        "irregularity": 0.45,
    },
}
