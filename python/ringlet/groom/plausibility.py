"""Sizes and lengths that suggest a wrong unit: of the head in its file, and of hair in the recipe."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ringlet.data.curves import Curves
from ringlet.data.lengths import UNITS
from ringlet.groom.edge import EdgeScalp
from ringlet.groom.operators import Grown
from ringlet.groom.recipe import Recipe
from ringlet.groom.scalp import Scalp

PLAUSIBLE_SIZES = (0.03, 2.0)  # [m] width of a scalp; a size ten times off suggests a wrong unit
PLAUSIBLE_LENGTHS = (0.02, 30.0)  # of hair, in widths of the scalp: on a head from 4 mm to 5 m
OF_SPACING = 0.5  # of the distance of locks: shorter ones do not reach each other
MEANT = ("m", "cm", "mm")  # units that a number may be meant in
IN_HAIRS = 4.0  # width of a curl, in widths of its hairs


def odd_sizes(recipe: Recipe, scalp: Scalp, guides: Curves, locks: Curves) -> Iterator[str]:
    """Messages for a head of implausible size, or for lengths that are out of proportion to it.

    guides: as they grow, before they are sculpted
    """
    width = scalp.width
    if PLAUSIBLE_SIZES[0] <= width <= PLAUSIBLE_SIZES[1]:
        yield from _odd_lengths(recipe, scalp, width, guides, locks)
    else:
        yield (
            f"the scalp is {width:.2g} m across; see whether its file names the unit in which it was made "
            "(metersPerUnit, or `unit` under [scalp] for an OBJ)"
        )


def _odd_lengths(recipe: Recipe, scalp: Scalp, width: float, guides: Curves, locks: Curves) -> Iterator[str]:
    """Messages for lengths that are out of proportion to the width of the scalp [m] or to hairs."""
    unit = UNITS[recipe.unit]
    if isinstance(recipe.guides, Grown) and not isinstance(scalp, EdgeScalp) and len(guides) and len(locks):
        length, spacing = float(np.median(guides.lengths())), math.sqrt(scalp.area / len(locks))
        shortest, longest = (width * ratio for ratio in PLAUSIBLE_LENGTHS)
        if length < min(shortest, OF_SPACING * spacing):
            reason = f"but locks are {spacing / unit:.3g} {recipe.unit} apart, on a scalp {width / unit:.3g} wide"
        else:
            reason = f"{length / width:.0f} times the width of the scalp" if length > longest else ""
        if reason:
            yield from _odd("guides.length", recipe.guides.length.value, reason, recipe, (shortest, longest))
    if recipe.curl and (curl := recipe.curl.width) and 0.0 < curl.value < (narrowest := IN_HAIRS * _hair(recipe)):
        reason = f"hardly wider than a hair, {_hair(recipe) / unit:.2g} {recipe.unit}"
        yield from _odd("curl.width", curl.value, reason, recipe, (narrowest, width))


def _odd(setting: str, value: float, reason: str, recipe: Recipe, plausible: tuple[float, float]) -> Iterator[str]:
    """A message with the unit in which the number of a setting [m] is most plausible; none where it is in no unit."""
    number, (least, most) = value / UNITS[recipe.unit], plausible
    lengths = {unit: number * UNITS[unit] for unit in MEANT if least <= number * UNITS[unit] <= most}
    if lengths:
        meant = min(lengths, key=lambda unit: abs(math.log(lengths[unit] ** 2 / (least * most))))
        yield (
            f"{setting} is {number:.4g} {recipe.unit}, {reason}; a number counts in the unit of the recipe: write "
            f'"{number:.4g} {meant}" if that is meant'
        )


def _hair(recipe: Recipe) -> float:
    """Width of a hair [m]."""
    return recipe.hairs.width.value
