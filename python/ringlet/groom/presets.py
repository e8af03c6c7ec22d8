"""Named curl types. A preset gives the defaults of a recipe's ``[curl]``, in the notation of a recipe."""

from __future__ import annotations

from typing import Any, Literal

Preset = Literal["1", "2A", "2B", "2C", "3A", "3B", "3C", "4A", "4B", "4C"]

# Widths are the objects that curl typing compares with: 3A a thick marker, 3B a marker pen, 3C a pencil, 4A a crochet
# needle; 4B is a zigzag, and the coils of 4C are barely visible. The pitch follows from how much shorter a lock is than
# its hair, which hairdressers give as 20 to 30 % for 3A and 70 to 80 % for 4C. Both are the middle of a distribution,
# whose curvature lies within that of 192 people (Lasisi et al., Scientific Reports 11, 2021): docs/curl_types.md has
# the figures. Neighbouring waves are in phase; neighbouring coils are not.
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
        "pitch": {"value": "60 mm", "vary": 0.15},
        "start": "30 mm",
        "irregularity": 0.3,
        "flatness": 0.65,
        "phase_coherence": 0.7,
    },
    "2C": {
        "width": {"value": "16 mm", "vary": 0.2, "ramp": [(0, 0.5), (0.4, 1), (1, 0.95)]},
        "pitch": {"value": "58 mm", "vary": 0.15},
        "start": "25 mm",
        "irregularity": 0.3,
        "flatness": 0.45,
        "phase_coherence": 0.5,
        "skips": 0.3,
    },
    "3A": {
        "width": {"value": "25 mm", "vary": 0.12, "ramp": [(0, 0.7), (0.3, 1), (1, 0.85)]},
        "pitch": {"value": "70 mm", "vary": 0.12},
        "start": "25 mm",
        "irregularity": 0.25,
        "flatness": 0.2,
        "phase_coherence": 0.3,
        "skips": 0.2,
    },
    "3B": {
        "width": {"value": "16 mm", "vary": 0.2, "ramp": [(0, 0.8), (0.3, 1), (1, 0.85)]},
        "pitch": {"value": "36 mm", "vary": 0.15},
        "start": "20 mm",
        "irregularity": 0.2,
    },
    "3C": {
        "width": {"value": "9 mm", "vary": 0.25, "ramp": [(0, 0.8), (0.3, 1), (1, 0.8)]},
        "pitch": {"value": "15 mm", "vary": 0.25},
        "start": "12 mm",
        "irregularity": 0.2,
    },
    "4A": {
        "width": {"value": "5 mm", "vary": 0.2, "ramp": [(0, 0.8), (0.3, 1), (1, 0.8)]},
        "pitch": {"value": "6 mm", "vary": 0.2},
        "start": "6 mm",
        "irregularity": 0.25,
    },
    "4B": {
        "width": {"value": "6 mm", "vary": 0.3, "ramp": [(0, 0.8), (0.3, 1), (1, 0.9)]},
        "pitch": {"value": "3.6 mm", "vary": 0.25},
        "start": "5 mm",
        "irregularity": 0.5,
        "kink": {"value": 0.95, "vary": 0.1},
        "skips": 0.2,
    },
    "4C": {
        "width": {"value": "3.5 mm", "vary": 0.3, "ramp": [(0, 0.8), (0.3, 1), (1, 0.9)]},
        "pitch": {"value": "2.6 mm", "vary": 0.2},
        "start": "4 mm",
        "irregularity": 0.45,
    },
}
