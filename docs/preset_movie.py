"""Makes docs/images/presets.webp and presets_flight.webp: each character of motion in the hop of the demo.

python docs/preset_movie.py
"""

from __future__ import annotations

from typing import Any

from bounce_movie import EXAMPLE, HOP, IMAGES, SHOWN, play, save, side_by_side
from ringlet.data.groom import Groom
from ringlet.shot.motion import WantedMotion

import ringlet

COLUMNS = 4
FLIGHT = 41  # the frame of the picture: hair floats
# Recipes of the examples, with fewer and thicker locks: what changes in tables of each.
GROOMS: dict[str, tuple[str, dict[str, dict[str, Any]]]] = {
    "tight_springs": ("types/3C", {"locks": {"count": 160, "points": 110}}),
    "loose_ringlets": ("child/ringlets", {}),
    "heavy_wet": ("types/3A", {"locks": {"count": 160, "points": 72}}),
    "light_frizz": ("types/4A", {"locks": {"count": 160, "points": 120}}),
    "stiff_braids": ("looks/box_braids", {"sections": {"size": 0.032}}),
    "locs": ("looks/locs", {"sections": {"size": 0.026}}),
    "afro": ("looks/afro", {"locks": {"count": 160, "points": 120}}),
}


def groom_of(preset: str) -> Groom:
    """The hair on which a preset is shown."""
    name, changes = GROOMS[preset]
    recipe = ringlet.read_recipe(EXAMPLE.parent / f"{name}.recipe.toml")
    locks = recipe.locks.model_copy(update=changes.get("locks", {}))
    if "sections" in changes:
        locks = locks.model_copy(update={"sections": locks.sections.model_copy(update=changes["sections"])})
    return ringlet.build_groom(recipe.model_copy(update={"locks": locks}))


def main() -> None:
    """Writes movie and picture."""
    shot, movies = ringlet.read_shot(EXAMPLE / "ringlets.shot.toml"), []
    for preset in GROOMS:
        motion = WantedMotion.model_validate({"preset": preset})
        hop = shot.model_copy(update={"motion": motion, "frames": HOP})
        movies.append(play(hop, groom_of(preset), preset.replace("_", " ")))
    save(movies, IMAGES / "presets.webp", COLUMNS)
    flight = side_by_side([pages[FLIGHT - SHOWN[0]] for pages in movies], COLUMNS)
    flight.save(IMAGES / "presets_flight.webp", quality=80)


if __name__ == "__main__":
    main()
