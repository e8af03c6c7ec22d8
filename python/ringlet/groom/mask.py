"""Masks of operators: weights per lock and along each lock."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, Field, PrivateAttr

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh
from ringlet.data.painted import painted, region
from ringlet.data.quantities import Quantity, Ramp, Section, along
from ringlet.data.random import Random
from ringlet.groom import expression


class Mask(Section):
    """Weight of an operator: 0 no effect, 1 full effect. In a recipe a number, or a table
    ``{ value = …, ramp = …, map = …, region = …, where = … }``: the product of its entries."""

    value: float = Field(default=1.0, ge=0.0, le=1.0, description="weight everywhere")
    ramp: Ramp = Field(default=[(0.0, 1.0), (1.0, 1.0)], description="[place, factor] from root (0) to tip (1)")
    map: str | None = Field(default=None, description="painted values of the locks, or of the scalp at their roots")
    region: str | None = Field(default=None, description="a named region of the scalp")
    falloff: Annotated[float, Quantity("m", 0.0, 1.0)] = Field(
        default=0.0, description="distance beyond the region over which the weight falls to 0"
    )
    where: Annotated[str, AfterValidator(expression.check)] | None = Field(
        default=None,
        description="an expression of `id`, `random` (0 to 1), `length`, and `x`, `y`, `z` of the root (in the unit "
        "of the recipe), such as `id % 3 == 0 and length > 10`; what is true is 1. With `[locks.sections]` also of "
        "`section`, `strand`, `u`, `v` (0 to 1 within the section) and `edge`, the distance from its border; `section` "
        "and `strand` are -1 where there is none. With `[scalp.edge]` also of `u` along the line and `v` across it",
    )
    invert: bool = Field(default=False, description="act where this mask is not")

    _unit: float = PrivateAttr(1.0)  # of lengths in ``where`` [m]

    def model_post_init(self, context: Any) -> None:
        """Takes the unit of the recipe over."""
        self._unit = (context or {}).get("unit", 1.0)

    @property
    def everywhere(self) -> bool:
        """Whether the mask is 1 everywhere."""
        return self.model_dump() == Mask().model_dump()

    def weights(self, curves: Curves, scalp: Mesh, random: Random, what: str) -> NDArray[np.float64]:
        """Weights at the points of curves with equal point counts, shape (count, points).

        what: name of the setting, for messages
        """
        points = len(curves.points) // len(curves)
        weight = self.per_lock(curves, scalp, random, what)[:, None] * along(self.ramp, np.linspace(0.0, 1.0, points))
        weight = np.clip(weight, 0.0, 1.0)
        return 1.0 - weight if self.invert else weight

    def per_lock(self, curves: Curves, scalp: Mesh, random: Random, what: str) -> NDArray[np.float64]:
        """Factor of the mask that is constant along a lock, before inversion; shape (count,).

        Raises UserError when ``where`` is not finite on a lock.
        """
        weight = np.full(len(curves), self.value)
        if self.map is not None:
            weight *= painted(self.map, curves, scalp, f"{what}.map")
        if self.region is not None:
            weight *= self._region_falloff(region(self.region, scalp, f"{what}.region"), curves, scalp)
        if self.where is not None:
            factor = expression.evaluate(self.where, self._values(curves, random, f"{what}.where"))
            if not (finite := np.isfinite(factor)).all():
                lock = curves.ids[np.flatnonzero(~finite)[0]]
                raise UserError(f"{what}.where is '{self.where}', not a finite number on lock {lock}; rewrite it")
            weight *= np.clip(factor, 0.0, 1.0)
        return weight

    def _values(self, curves: Curves, random: Random, what: str) -> dict[str, NDArray]:
        """Values of the names in ``where``, shape (count,) each, lengths in the unit of the recipe."""
        assert self.where is not None
        used = expression.names(self.where)
        if missing := sorted(used & set(expression.SECTIONED) - curves.curve.keys()):
            raise UserError(
                f"{what} has '{missing[0]}', which only locks of sections and edges have; add [locks.sections] or "
                "[scalp.edge]"
            )
        x, y, z = curves.roots.T / self._unit
        values = {"id": curves.ids, "random": random.uniform(curves.ids), "x": x, "y": y, "z": z}
        if "length" in used:
            values["length"] = curves.lengths() / self._unit
        for name in used & set(expression.SECTIONED):
            values[name] = curves.curve[name] / (self._unit if name == "edge" else 1.0)
        return values

    def _region_falloff(self, triangles: NDArray[np.int32], curves: Curves, scalp: Mesh) -> NDArray[np.float64]:
        """Falloff of a region: 1 inside, 0 farther than ``falloff`` from it, smooth between; shape (count,)."""
        inside = np.isin(curves.curve["root_triangle"], triangles)
        if self.falloff == 0.0 or inside.all() or not len(triangles):
            return inside.astype(np.float64)
        roots = np.ascontiguousarray(curves.roots, np.float64)
        points = np.ascontiguousarray(scalp.points, np.float64)
        distance = _core.bind_roots(points, np.ascontiguousarray(scalp.triangles, np.int32), roots, triangles)[2]
        t = np.where(inside, 1.0, np.clip(1.0 - distance / self.falloff, 0.0, 1.0))
        return t * t * (3.0 - 2.0 * t)
