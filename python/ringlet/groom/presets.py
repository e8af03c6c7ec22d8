"""Named curl types. A preset fills what the recipe's ``[curl]`` does not say. Lengths in metres."""

from __future__ import annotations

from typing import Any

# Diameters after the hair typing in common use (3B: a marker pen, 3C: a pencil, 4A: a crochet needle, 4C: barely visible coils). Pitch,
# the rise from turn to turn, is that of hair hanging under little weight: tighter hair stands closer.
PRESETS: dict[str, dict[str, Any]] = {
    "3B": {
        "width": {"value": 0.016, "vary": 0.2, "ramp": [(0, 0.8), (0.3, 1), (1, 0.85)]},
        "pitch": {"value": 0.022, "vary": 0.15},
        "start": 0.02,
        "irregularity": 0.2,
    },
    "3C": {
        "width": {"value": 0.009, "vary": 0.2, "ramp": [(0, 0.8), (0.3, 1), (1, 0.8)]},
        "pitch": {"value": 0.012, "vary": 0.15},
        "start": 0.012,
        "irregularity": 0.2,
    },
    "4A": {
        "width": {"value": 0.005, "vary": 0.2, "ramp": [(0, 0.8), (0.3, 1), (1, 0.8)]},
        "pitch": {"value": 0.0065, "vary": 0.15},
        "start": 0.006,
        "irregularity": 0.25,
    },
    "4C": {
        "width": {"value": 0.0035, "vary": 0.3, "ramp": [(0, 0.8), (0.3, 1), (1, 0.9)]},
        "pitch": {"value": 0.0042, "vary": 0.25},
        "start": 0.004,
        "irregularity": 0.45,
    },
}
