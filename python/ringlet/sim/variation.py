"""Values that vary, at the vertices of locks: from root to tip, over the head, and from lock to lock."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ValidationError

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.explain import explain
from ringlet.data.groom import Groom
from ringlet.data.painted import per_lock
from ringlet.data.random import Random
from ringlet.shot.material import Material
from ringlet.shot.shot import Shot
from ringlet.shot.variation import VARIATIONS, Mapped

LEAST_STRETCH = 1e-6  # factor on stretch; strands that hardly resist it reach as far as they fall
LEAST_WEIGHT = 0.01  # factor on mass, with which the other factors on the radius keep the stiffness


def material_factors(shot: Shot, groom: Groom) -> dict[str, NDArray[np.float64]]:
    """The factors on the material that differ from 1, at the vertices of the locks, by name; shape (n,) each.

    The core has no factor on the mass: weight is one on the radius, and stretch and bend keep their stiffness.
    Raises UserError where a product with the material is beyond the bounds of the material.
    """
    variation, factors = shot.variation, dict[str, NDArray[np.float64]]()
    for name in VARIATIONS:
        if getattr(variation, name) == Mapped():
            continue
        factor = at_vertices(variation, name, groom, f"variation.{name}", variation.seed)
        _check_product(shot.strands, f"variation.{name}", VARIATIONS[name], factor, groom.locks)
        if name == "stretch":
            _check_least(f"variation.{name}", factor, LEAST_STRETCH, groom.locks)
        if (factor != 1.0).any():
            factors[name] = factor
    if shot.motion.weight != Mapped():
        factor = at_vertices(shot.motion, "weight", groom, "motion.weight", shot.motion.seed)
        _check_product(shot.strands, "motion.weight", "density", factor, groom.locks)
        _check_least("motion.weight", factor, LEAST_WEIGHT, groom.locks)
        for name, of_weight in {"radius": np.sqrt(factor), "stretch": 1.0 / factor, "bend": factor**-2.0}.items():
            factors[name] = factors.get(name, 1.0) * of_weight
    if shot.motion.air != Mapped():
        factor = at_vertices(shot.motion, "air", groom, "motion.air", shot.motion.seed)
        _check_product(shot.strands, "motion.air", "drag", factor, groom.locks)
        factors["drag"] = factors.get("drag", 1.0) * factor
    return factors


def at_vertices(settings: BaseModel, name: str, groom: Groom, setting: str, seed: int = 1) -> NDArray[np.float64]:
    """A value at each vertex of the locks, shape (n,).

    settings, name: the table of the value, and its name there
    setting:        its name in the shot, for messages
    """
    locks, varied = groom.locks, getattr(settings, name)
    of_point = varied.map if varied.map in locks.point else None
    plain = settings.model_copy(update={name: varied.model_copy(update={"map": None})}) if of_point else settings
    value = per_lock(plain, name, Random(seed, setting), locks, groom.scalp, f"shot: {setting}")
    values = np.repeat(value, locks.counts) * varied.along(_places(locks))
    return values if of_point is None else values * _at_points(of_point, locks, setting)


def _check_product(
    material: Material, factor_of: str, setting: str, factor: NDArray[np.float64], locks: Curves
) -> None:
    """Raises UserError for a factor that takes a setting of the material beyond its own bounds."""
    for vertex in (factor.argmin(), factor.argmax()):
        where = _where(factor_of, factor, vertex, locks)
        product = getattr(material, setting) * float(factor[vertex])
        try:
            # The product of twist goes up to its limit, whatever the factor.
            Material.model_validate({**material.model_dump(), setting: product, "limit_twist": False})
        except ValidationError as error:
            refused = explain(error, where, name_of=lambda _: f"strands.{setting}")
            raise UserError(f"{refused}, change its ramp or map") from None


def _check_least(factor_of: str, factor: NDArray[np.float64], least: float, locks: Curves) -> None:
    """Raises UserError for a factor that is too small."""
    if factor.min() < least:
        where = _where(factor_of, factor, factor.argmin(), locks)
        raise UserError(f"{where}; must be at least {least:g}, change its ramp or map")


def _where(factor_of: str, factor: NDArray[np.float64], vertex: np.intp, locks: Curves) -> str:
    lock = locks.ids[np.searchsorted(locks.offsets, vertex, side="right") - 1]
    return f"shot: {factor_of} is {factor[vertex]:.6g} on lock {lock}"


def _places(locks: Curves) -> NDArray[np.float64]:
    """Arc length of each vertex relative to its lock's, from 0 at the root to 1 at the tip, shape (n,)."""
    steps = np.linalg.norm(np.diff(locks.points, axis=0, prepend=locks.points[:1]), axis=1)
    steps[locks.offsets[:-1]] = 0.0
    run = np.cumsum(steps)
    return (run - np.repeat(run[locks.offsets[:-1]], locks.counts)) / np.repeat(locks.lengths(), locks.counts)


def _at_points(name: str, locks: Curves, setting: str) -> NDArray[np.float64]:
    """Values painted on the points of the locks, shape (n,)."""
    values = np.asarray(locks.point[name], np.float64)
    if values.ndim != 1:
        raise UserError(
            f"shot: {setting}.map '{name}' has {values.shape[1]} numbers a point; must be one, paint another"
        )
    if (bad := np.flatnonzero(~(np.isfinite(values) & (values >= 0.0)))).size:
        lock = locks.ids[np.searchsorted(locks.offsets, bad[0], side="right") - 1]
        raise UserError(
            f"shot: {setting}.map '{name}' is {values[bad[0]]:g} on lock {lock}; must be at least 0 and finite, "
            "paint it again"
        )
    return values
