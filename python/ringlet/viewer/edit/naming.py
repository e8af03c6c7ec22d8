"""Names of maps and curves that the review adds to a recipe, and what its settings name."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from ringlet.data.names import unique
from ringlet.groom import Recipe
from ringlet.viewer.protocol import Place


def new_name(place: Place, recipe: Recipe, used: Collection[str]) -> str:
    """An unused name after a setting: ``guides_length``, ``scraggle_mask``, ``guides_part_line``."""
    stage = recipe.shape[int(place[1])].op if place[0] == "shape" else str(place[0])
    parts = [str(part) for part in place[2 if place[0] == "shape" else 1 :] if part not in ("map", "curve")]
    return unique("_".join([stage, *parts]), used)


def value_at(recipe: Recipe, place: Place) -> object:
    """Value of a setting; None where there is nothing."""
    data: Any = recipe.model_dump(mode="json")
    for part in place:
        try:
            data = data[part]
        except (KeyError, IndexError, TypeError):
            return None
    return data
