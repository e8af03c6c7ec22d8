"""Settings of render hairs, and their values."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationError

from ringlet.data.curves import Curves
from ringlet.data.groom import STRAND_RADIUS, Groom
from ringlet.data.quantities import Quantity, Ramped, Section, Varied, explain
from ringlet.groom.fiber import FiberSettings
from ringlet.groom.hair_curl import Families, HairCoil, HairCurl
from ringlet.groom.mask import Mask
from ringlet.groom.values import Values

IDS_PER_LOCK = 10_000  # id of a hair: id of its lock · 10 000 + number in the lock


class HairSettings(Section):
    """Render hairs of each lock."""

    per_lock: Annotated[Varied, Quantity("", 1, IDS_PER_LOCK)] = Field(
        default=Varied(value=20), description="hairs of a lock; the first of them is the groom guide itself"
    )
    density: Annotated[Varied | None, Quantity("/cm2", 0.1, 2000.0)] = Field(
        default=None,
        description="hairs per cm² of scalp, in place of `per_lock`: 120 is a full head. Roots fill the share of the "
        "scalp that is nearest to their lock",
    )
    cover: Annotated[float | None, Quantity("", 0.0, 0.999)] = Field(
        default=None,
        description="fraction of the scalp that hair hides from cameras around the head; the density is raised "
        "until it does",
    )
    mask: Annotated[Mask | None, Quantity("", 0.0, 1.0)] = Field(
        default=None,
        description="fraction of the hairs that grow: a number, map, region or expression; all when absent",
    )
    points: int | None = Field(
        default=None,
        ge=2,
        le=10_000,
        description="points per hair; those of the lock when absent, or what a `coil` of its own needs",
    )
    lock_radius: Annotated[Ramped, Quantity("m", 0.0, 0.1)] = Field(
        default=Ramped(value=0.0012, ramp=[(0, 1), (0.5, 0.8), (1, 0.5)]),
        description="radius of a lock's cross-section",
    )
    lock_taper: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.0),
        description="how much narrower a lock gets towards its tip, on top of the ramp of `lock_radius`: 1 to a point",
    )
    lock_flatness: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.0), description="cross-section of a lock: 0 round, 1 a flat ribbon"
    )
    hollow: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.0), description="where hairs are in the cross-section: 0 everywhere, 1 at the rim"
    )
    root_radius: Annotated[Varied, Quantity("m", 0.0, 0.1)] = Field(
        default=Varied(value=0.003),
        description="radius on the scalp that a lock's roots cover; those of a section's strand cover its share of the "
        "section, and lie flat up to where it grows",
    )
    root_falloff: Annotated[float, Quantity("", 0.001, 1.0)] = Field(
        default=0.15, description="part of the lock, from its root, over which its hairs come together"
    )
    width: Annotated[Ramped, Quantity("m", 1e-6, 0.01)] = Field(
        default=Ramped(value=0.00009, vary=0.2, ramp=[(0, 1), (0.7, 0.9), (1, 0.3)]), description="diameter of a hair"
    )
    shorter: Annotated[Varied, Quantity("", 0.0, 0.9)] = Field(
        default=Varied(value=0.08), description="by how much the shortest hairs of a lock are shorter, as a fraction"
    )
    frizz: Annotated[Varied, Quantity("m", 0.0, 0.05)] = Field(
        default=Varied(value=0.0004), description="how far hairs wander within the lock; larger is fuzzier"
    )
    stray: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.04), description="fraction of the hairs that leave their lock"
    )
    stray_distance: Annotated[Varied, Quantity("m", 0.0, 0.1)] = Field(
        default=Varied(value=0.004), description="how far stray hairs leave their lock"
    )
    blend: Annotated[Ramped, Quantity("", 0.0, 1.0)] = Field(
        default=Ramped(value=0.0),
        description="how far hairs between two locks mix both: 0 each follows its own; mixed curls get narrower",
    )
    apart: Annotated[float, Quantity("deg", 1.0, 180.0)] = Field(
        default=60.0, description="locks that lean further apart than this, as across a part line, are not mixed"
    )
    families: Families | None = Field(default=None, description="sub-clumps of each lock; none when absent")
    curl: HairCurl | None = Field(
        default=None, description="how hairs follow the coil of their lock; all in the same phase when absent"
    )
    coil: HairCoil | None = Field(default=None, description="a coil of each hair's own; none when absent")
    file: str | None = Field(
        default=None,
        description="USD file with hairs that `ringlet adopt` took from elsewhere, in place of those that the settings "
        "make; `offset` and `seed` apply to them, and `color`",
    )
    offset: Annotated[float, Quantity("", 0.0, 10.0)] = Field(
        default=1.0, description="factor on the distances of adopted hairs from their lock"
    )
    seed: int = Field(default=1, ge=0, le=2**31, description="another seed gives hairs other places in their locks")

    @property
    def sections(self) -> dict[str, Section]:
        """Tables of settings that are given, by name."""
        tables = {"families": self.families, "curl": self.curl, "coil": self.coil}
        return {name: table for name, table in tables.items() if table is not None}


def hair_settings(groom: Groom) -> HairSettings:
    """The settings of a groom's hairs; raises UserError for wrong ones."""
    try:
        return HairSettings.model_validate(groom.hairs, context={"unit": 1.0})
    except ValidationError as error:
        raise explain(error, "groom: hairs", groom.hairs) from error


def fiber_settings(groom: Groom) -> FiberSettings:
    """The settings of a groom's fibre; raises UserError for wrong ones."""
    try:
        return FiberSettings.model_validate(groom.fiber or {}, context={"unit": 1.0})
    except ValidationError as error:
        raise explain(error, "groom: fiber", groom.fiber) from error


def hair_values(groom: Groom, settings: HairSettings) -> dict[str, Values]:
    """The values of the settings per lock, and of each table of them that is given, by its name; "": their own."""
    return {
        name: Values(table, groom.locks, groom.scalp, settings.seed, f"hairs.{name}".rstrip("."))
        for name, table in {"": settings, **settings.sections}.items()
    }


def lock_radii(locks: Curves, radius: NDArray[np.float64]) -> NDArray[np.float64]:
    """Radius of each lock [m], shape (locks,): its own, as that of a strand of a braid, or the ``lock_radius``."""
    own = locks.curve.get(STRAND_RADIUS, np.zeros(len(locks)))
    return np.where(own > 0.0, own, radius)
