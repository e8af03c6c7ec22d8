"""Values that vary: from root to tip by a ramp, over the head by a map, and from lock to lock by chance."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.data.painted import per_lock
from ringlet.data.quantities import Quantity, Ramped
from ringlet.data.random import Random
from ringlet.data.settings import Section
from ringlet.shot.strands import VARIATIONS


class Mapped(Ramped):
    """A number, or a table ``{ value = …, ramp = [[0, 1], [1, 0.5]], map = "…", vary = …, noise = … }``: the product of
    all of it."""

    value: float = Field(default=1.0)
    map: str | None = Field(
        default=None,
        description="a primvar of floats that multiplies it: of the locks, or of the scalp at their roots",
    )


Factor = Annotated[Mapped, Quantity("", 0.0, 1e6)]


class Variation(Section):
    """Factors on the material of the strands, for each vertex of each lock."""

    radius: Factor = Field(default=Mapped(), description="on `strands.radius`")
    stretch: Factor = Field(default=Mapped(), description="on `strands.stretch_scale`")
    bend: Factor = Field(default=Mapped(), description="on `strands.bend_scale`")
    twist: Factor = Field(default=Mapped(), description="on `strands.twist_ratio`; their product goes up to 1")
    damping: Factor = Field(default=Mapped(), description="on `strands.damping`")
    seed: int = Field(default=1, ge=0, le=2**31, description="another seed, another chance for `vary` and `noise`")

    def factors(self, groom: Groom) -> dict[str, NDArray[np.float64]]:
        """The factors that differ from 1 at the vertices of the locks, by name, shape (n,) each."""
        factors: dict[str, NDArray[np.float64]] = {}
        for name in VARIATIONS:
            if (varied := getattr(self, name)) == Mapped():
                continue
            factor = at_vertices(varied, groom, f"variation.{name}", self.seed)
            if name in ("radius", "stretch") and not factor.min() > 0.0:
                raise UserError(f"shot: variation.{name} is 0 somewhere; it must be above 0, raise its ramp or map")
            if (factor != 1.0).any():
                factors[name] = factor
        return factors


def at_vertices(varied: Mapped, groom: Groom, setting: str, seed: int = 1) -> NDArray[np.float64]:
    """A value at each vertex of the locks, shape (n,); ``setting`` is its name in the shot, for messages."""
    locks = groom.locks
    of_point = varied.map if varied.map in locks.point else None
    plain = varied.model_copy(update={"map": None}) if of_point else varied
    value = per_lock(plain, Random(seed, setting), locks, groom.scalp, f"shot: {setting}")
    values = np.repeat(value, locks.counts) * varied.along(_places(locks))
    return values if of_point is None else values * _at_points(of_point, locks, setting)


def _places(locks: Curves) -> NDArray[np.float64]:
    """How far along its lock each vertex is, from 0 at the root to 1 at the tip, by arc length; shape (n,)."""
    steps = np.linalg.norm(np.diff(locks.points, axis=0, prepend=locks.points[:1]), axis=1)
    steps[locks.offsets[:-1]] = 0.0
    run = np.cumsum(steps)
    return (run - np.repeat(run[locks.offsets[:-1]], locks.counts)) / np.repeat(locks.lengths(), locks.counts)


def _at_points(name: str, locks: Curves, setting: str) -> NDArray[np.float64]:
    """What is painted on the points of the locks, shape (n,)."""
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
