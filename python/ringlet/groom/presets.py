"""Named curl types. A preset gives the defaults of a recipe's ``[curl]``, in the notation of a recipe."""

from __future__ import annotations

from typing import Any, Literal

Preset = Literal["1", "2A", "2B", "2C", "3A", "3B", "3C", "4A", "4B", "4C"]

# Diameters follow the common hair typing: 3A a thick marker, 3B a marker pen, 3C a pencil, 4A a crochet needle. Type 4B
# has zigzags, and the coils of 4C are barely visible. Type 2 is flat waves. Pitch, the rise per turn, is that of
# unloaded hair: tighter curls have a smaller pitch. Neighbouring waves are in phase; neighbouring coils are not.
PRESETS: dict[str, dict[str, Any]] = {
    "1": {
        "width": {"value": "3 mm", "vary": 0.5, "ramp": [(0, 0.5), (0.5, 1), (1, 1)]},
        "pitch": {"value": "120 mm", "vary": 0.3},
        "start": "30 mm",
        "irregularity": 0.6,
        "flatness": 0.5,
        "phase_coherence": 0.3,
    },
    "2A": {
        "width": {"value": "9 mm", "vary": 0.3, "ramp": [(0, 0.3), (0.5, 1), (1, 1)]},
        "pitch": {"value": "72 mm", "vary": 0.15},
        "start": "40 mm",
        "irregularity": 0.3,
        "flatness": 0.75,
        "phase_coherence": 0.8,
    },
    "2B": {
        "width": {"value": "13 mm", "vary": 0.25, "ramp": [(0, 0.4), (0.4, 1), (1, 1)]},
        "pitch": {"value": "56 mm", "vary": 0.15},
        "start": "30 mm",
        "irregularity": 0.3,
        "flatness": 0.65,
        "phase_coherence": 0.7,
    },
    "2C": {
        "width": {"value": "17 mm", "vary": 0.25, "ramp": [(0, 0.5), (0.4, 1), (1, 0.95)]},
        "pitch": {"value": "46 mm", "vary": 0.15},
        "start": "25 mm",
        "irregularity": 0.3,
        "flatness": 0.45,
        "phase_coherence": 0.5,
        "skips": 0.3,
    },
    "3A": {
        "width": {"value": "25 mm", "vary": 0.2, "ramp": [(0, 0.7), (0.3, 1), (1, 0.85)]},
        "pitch": {"value": "36 mm", "vary": 0.15},
        "start": "25 mm",
        "irregularity": 0.25,
        "flatness": 0.1,
        "phase_coherence": 0.3,
        "skips": 0.2,
    },
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
    "4B": {
        "width": {"value": "4.5 mm", "vary": 0.3, "ramp": [(0, 0.8), (0.3, 1), (1, 0.9)]},
        "pitch": {"value": "5.5 mm", "vary": 0.25},
        "start": "5 mm",
        "irregularity": 0.5,
        "kink": {"value": 0.95, "vary": 0.1},
        "skips": 0.2,
    },
    "4C": {
        "width": {"value": "3.5 mm", "vary": 0.3, "ramp": [(0, 0.8), (0.3, 1), (1, 0.9)]},
        "pitch": {"value": "4.2 mm", "vary": 0.25},
        "start": "4 mm",
        "irregularity": 0.45,
    },
}
