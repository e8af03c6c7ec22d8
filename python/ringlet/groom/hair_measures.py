"""What the hairs of a groom come to: how much of the scalp they hide, and how thick locks are with them."""

from __future__ import annotations

from typing import Any

import numpy as np

from ringlet.data.curves import Curves
from ringlet.data.groom import Groom
from ringlet.data.quantities import Varied
from ringlet.groom import felt
from ringlet.groom.cover import Cover, measure
from ringlet.groom.density import hair_count, hair_region, hairs_per_cm2
from ringlet.groom.hair_settings import HairSettings, hair_settings, lock_radii
from ringlet.groom.hairs import make_hairs
from ringlet.groom.several import grooms_of

CM = 100.0  # in a metre
FIRST_PER_CM2, MOST_PER_CM2 = 60.0, 400.0  # densities that a cover begins with and ends at


def hair_cover(groom: Groom, hairs: Curves | None = None) -> Cover:
    """Cover of the scalp by all hairs of a groom at rest; ``hairs``: those, where they are made already."""
    return measure(groom.scalp, hair_region(groom), make_hairs(groom).curves if hairs is None else hairs)


def raise_density(groom: Groom, settings: HairSettings) -> None:
    """Sets the density of a groom to the least that has the cover of the settings, or leaves it if that has more.

    Adds to the groom's conflicts where MOST_PER_CM2 hairs do not suffice.
    """
    assert settings.cover is not None
    start = settings.density or Varied(value=FIRST_PER_CM2)
    groom.hairs["density"] = start.model_dump(mode="json")
    cover, least = hair_cover(groom), 1.0 if settings.density else 0.0
    factor = max(cover.factor_for(settings.cover, MOST_PER_CM2 / start.value), least)
    groom.hairs["density"]["value"] = min(factor * start.value, MOST_PER_CM2)
    if (seen := cover.seen(factor)) > 1.001 * (1.0 - settings.cover):
        groom.conflicts.append(
            f"hairs.cover is {settings.cover:g}, but at {MOST_PER_CM2:g} hairs/cm² {100 * seen:.1f} % of the scalp are "
            "still seen; let locks grow closer, longer or flatter"
        )


def hair_measures(groom: Groom, hairs: Curves | None = None) -> dict[str, Any]:
    """Density and cover of a groom at rest: ``hairs_per_cm2``, and ``scalp_seen`` through its hair, from 0 to 1.

    Of one on an edge, ``hairs_per_cm`` of its lines. Of several that are joined, ``grooms`` with those of each by name.
    ``hairs``: all of them, where they are made already; those of several are made again, one by one.
    """
    if groom.grooms:
        alone = grooms_of(groom).items()
        return {"grooms": {name: {"hairs": hair_count(one), **hair_measures(one)} for name, one in alone}}
    if groom.edge is not None:
        return {"hairs_per_cm": hair_count(groom) / (CM * groom.edge)}
    return {"hairs_per_cm2": hairs_per_cm2(groom), "scalp_seen": hair_cover(groom, hairs).seen()}


def lock_thickness(groom: Groom) -> float:
    """Largest diameter of a lock with its hairs [m], but for chance and maps."""
    if groom.grooms:
        return max(lock_thickness(one) for one in grooms_of(groom).values())
    radius = hair_settings(groom).lock_radius
    largest = max([radius.value, *radius.region.values(), *radius.lock.values()])
    thickness = lock_radii(groom.locks, np.full(len(groom.locks), largest)) * felt.most_thick(groom.locks)
    return 2.0 * float(thickness.max(initial=0.0)) * radius.peak
