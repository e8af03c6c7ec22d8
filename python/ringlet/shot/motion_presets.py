"""Characters of motion. A preset gives the defaults of a shot's ``[motion]``, in the notation of a shot.

They are chosen for the eye. Wet hair and frizz bounce as their material does at its weight. Braids, locs and an afro
are no springs: how stiff they are shows in how the whole swings.
"""

from __future__ import annotations

from typing import Any, Literal

Preset = Literal["tight_springs", "loose_ringlets", "heavy_wet", "light_frizz", "stiff_braids", "locs", "afro"]

PRESETS: dict[str, dict[str, Any]] = {
    "tight_springs": {"bounce": {"value": 6.0, "vary": 0.1}, "settle": 0.5},
    "loose_ringlets": {"bounce": {"value": 3.0, "vary": 0.1}, "settle": 0.9},
    "heavy_wet": {"settle": 0.5, "weight": 2.0},
    "light_frizz": {"settle": {"value": 0.25, "vary": 0.4}, "weight": 0.7, "air": {"value": 4.0, "vary": 0.4}},
    "stiff_braids": {"swing": {"value": 1.3, "of_hair": True}, "settle": 0.25, "weight": 1.2},
    "locs": {"swing": {"value": 1.6, "of_hair": True}, "settle": 0.2, "weight": 1.3},
    "afro": {"swing": {"value": 0.75, "of_hair": True, "noise": 0.1}, "settle": 0.3},
}
