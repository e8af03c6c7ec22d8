"""Several grooms on one head as one groom: hair, brows, lashes and beard, simulated and written together."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from hashlib import blake2b
from typing import Any

import numpy as np

from ringlet.data.accessory import Accessory
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import GROOM, HAIR_SHARE, SECTION, STRAND_PROFILE, Groom
from ringlet.data.names import unique
from ringlet.data.pigment import DEFAULT_COLOR, HAIR_COLORS, MELANIN, REDNESS, USUAL_FIBER
from ringlet.groom.named import MOST_GROOMS
from ringlet.groom.recipe import Recipe

# Ids of several grooms: those of the groom alone, of at most 1.1·10¹³ either way, and a slot that its name chooses.
IDS_PER_GROOM = 25 * 10**12
SLOTS = 360  # within the 53 bits that other programs keep exactly
SECTIONS_PER_GROOM = 1 << 24

STAGES = ("guides", "shapes", "unsculpted")  # curves of a groom besides its locks
ALONE = ("region", "edge", "hairs", "color", "fiber")  # settings that each groom has of its own

# What attributes are where a groom has none: factors are 1, and hair has the colour that it has without settings.
WITHOUT = {
    SECTION: -1,
    STRAND_PROFILE: 1,
    HAIR_SHARE: 1,
    MELANIN: HAIR_COLORS[DEFAULT_COLOR].melanin,
    REDNESS: HAIR_COLORS[DEFAULT_COLOR].redness,
    **USUAL_FIBER,
}


def join_grooms(grooms: Mapping[str, Groom]) -> Groom:
    """Several grooms on one head, by name, as one groom.

    Ids of locks, guides and sections become unique: those of a groom depend on its name alone, whichever others there
    are. Raises UserError for grooms on different heads, and for adopted hairs.
    """
    names, first = list(grooms), next(iter(grooms.values()))
    for name, groom in grooms.items():
        if _scalp(groom) != _scalp(first) or not np.array_equal(groom.scalp.points, first.scalp.points):
            raise UserError(
                f"grooms.{name}: grows on another scalp ({groom.scalp.name}) than {names[0]} ({first.scalp.name}); "
                "must be the same"
            )
        if groom.offsets is not None:
            raise UserError(
                f"grooms.{name}.hairs.file: adopted hairs cannot be combined with other grooms; "
                "keep them in a recipe of their own"
            )
    offsets = id_offsets(names)
    locks = {name: _marked(groom.locks, row, offsets[name]) for row, (name, groom) in enumerate(grooms.items())}
    joined = _joined(list(locks.values()))
    stages = {stage: [getattr(groom, stage) for groom in grooms.values()] for stage in STAGES}
    curves = {
        stage: _joined([_marked(one, row, offsets[names[row]]) for row, one in enumerate(of)])
        for stage, of in stages.items()
        if all(one is not None for one in of)
    }
    return replace(
        first,
        **curves,
        locks=joined,
        region=None,
        edge=None,
        hairs={},
        color=None,
        fiber=None,
        recipe=None,
        hidden=list(dict.fromkeys(path for groom in grooms.values() for path in groom.hidden)),
        accessories=_accessories(grooms),
        conflicts=[f"{name}: {line}" for name, groom in grooms.items() for line in groom.conflicts],
        grooms={
            name: {
                **{key: getattr(groom, key) for key in ALONE},
                "absent": sorted((joined.curve.keys() | joined.point.keys()) - _attributes(locks[name])),
            }
            for name, groom in grooms.items()
        },
    )


def grooms_of(groom: Groom) -> dict[str, Groom]:
    """The grooms that are joined in one, by name, with the ids that each has alone; {"": groom} for a single one."""
    if not groom.grooms:
        return {"": groom}
    offsets = id_offsets(list(groom.grooms))
    return {
        name: replace(
            groom,
            locks=_alone(groom.locks, row, offsets[name], settings["absent"]),
            guides=_alone(groom.guides, row, offsets[name], ()),
            shapes=groom.shapes and _alone(groom.shapes, row, offsets[name], ()),
            unsculpted=groom.unsculpted and _alone(groom.unsculpted, row, offsets[name], ()),
            accessories=_accessories_of(groom, row, name),
            grooms={},
            **{key: settings[key] for key in ALONE},
        )
        for row, (name, settings) in enumerate(groom.grooms.items())
    }


def with_each(groom: Groom, changed: Callable[[Groom], Groom]) -> Groom:
    """Several grooms with each of them changed on its own."""
    joined = join_grooms({name: changed(one) for name, one in grooms_of(groom).items()})
    return replace(joined, recipe=groom.recipe, conflicts=groom.conflicts)


def _accessories(grooms: Mapping[str, Groom]) -> list[Accessory]:
    """What all grooms wear, on the points of the joined locks, with names that are unique."""
    worn, first = list[Accessory](), 0
    for name, groom in grooms.items():
        for one in groom.accessories:
            unused = unique(f"{name}_{one.mesh.name}", [other.mesh.name for other in worn])
            worn.append(Accessory(replace(one.mesh, name=unused), one.vertices + first))
        first += len(groom.locks.points)
    return worn


def _accessories_of(groom: Groom, row: int, name: str) -> list[Accessory]:
    """What the locks of one groom wear, on its own points and with the names that it has alone."""
    own = np.repeat(groom.locks.curve[GROOM], groom.locks.counts) == row
    first = int(own.argmax())
    return [
        Accessory(replace(one.mesh, name=one.mesh.name.removeprefix(f"{name}_")), one.vertices - first)
        for one in groom.accessories
        if own[one.vertices].all()
    ]


def id_offsets(names: list[str]) -> dict[str, int]:
    """What ids of each groom's locks and guides are moved by: a slot by its name, the next one if that is taken."""
    assert len(names) <= MOST_GROOMS
    taken: dict[int, str] = {}
    for name in names:
        slot = int.from_bytes(blake2b(name.encode(), digest_size=4).digest(), "little") % SLOTS
        while slot in taken:
            slot = (slot + 1) % SLOTS
        taken[slot] = name
    return {name: slot * IDS_PER_GROOM for slot, name in taken.items()}


def recipes_of(recipe: Recipe) -> list[tuple[Recipe, int]]:
    """The recipe of each groom, and what its ids are moved by among several; itself and 0 for a single one."""
    offsets = id_offsets(list(recipe.grooms))
    return [(one, offsets[name]) for name, one in recipe.grooms.items()] or [(recipe, 0)]


def recipe_of_lock(recipe: Recipe, lock: int) -> tuple[Recipe, int]:
    """The recipe of the groom that a lock is of, and the id of the lock in it.

    Raises UserError for a lock that is of none of several grooms.
    """
    for one, offset in recipes_of(recipe):
        if not recipe.grooms or abs(lock - offset) < IDS_PER_GROOM // 2:
            return one, lock - offset
    where, names = recipe.path or "recipe", ", ".join(recipe.grooms)
    raise UserError(f"{where}: lock {lock} belongs to no groom; there are: {names}")


def _scalp(groom: Groom) -> tuple[Any, ...]:
    return groom.scalp_file and groom.scalp_file.resolve(), groom.scalp_prim, groom.cage


def _joined(sets: list[Curves]) -> Curves:
    return Curves.joined(sets, WITHOUT)


def _attributes(curves: Curves) -> set[str]:
    return curves.curve.keys() | curves.point.keys()


def _marked(curves: Curves, row: int, offset: int) -> Curves:
    """Curves of one groom as those of one of several."""
    attributes = {**curves.curve, GROOM: np.full(len(curves), row, np.int32)}
    if SECTION in attributes:
        section = attributes[SECTION]
        attributes[SECTION] = np.where(section < 0, section, section + row * SECTIONS_PER_GROOM).astype(section.dtype)
    return replace(curves, ids=curves.ids + offset, curve=attributes)


def _alone(curves: Curves, row: int, offset: int, absent: list[str] | tuple[()]) -> Curves:
    """The curves of one of several grooms, as in ``_marked`` before."""
    chosen = curves.take(curves.curve[GROOM] == row)
    dropped = {*absent, GROOM}
    curve = {name: values for name, values in chosen.curve.items() if name not in dropped}
    point = {name: values for name, values in chosen.point.items() if name not in dropped}
    if SECTION in curve:
        section = curve[SECTION]
        curve[SECTION] = np.where(section < 0, section, section - row * SECTIONS_PER_GROOM).astype(section.dtype)
    return replace(chosen, ids=chosen.ids - offset, curve=curve, point=point)
