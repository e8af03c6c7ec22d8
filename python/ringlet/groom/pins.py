"""Pins: constraints that attach hair to the skin, as at a hairline or in a bun."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.mesh import Mesh
from ringlet.data.quantities import Quantity, Section
from ringlet.data.random import Random
from ringlet.groom.mask import Mask
from ringlet.groom.operators.operator import arc_lengths, grid
from ringlet.groom.shares import LAID, LEAVE

PIN = "pin"  # point attribute of locks: 0 free … 1 moves rigidly with the skin at the root


class Pin(Section):
    """Attaches locks to their groomed position: from the root up to ``length``, with a ``falloff``. In a
    simulation, points of weight 1 move rigidly with the skin; springs pull points of lower weight to that position."""

    mask: Annotated[Mask, Quantity("", 0.0, 1.0)] = Field(
        default=Mask(), description="which locks, and where along them"
    )
    firm: Annotated[float, Quantity("", 0.0, 1.0)] = Field(
        default=1.0, description="1 rigid; smaller is a softer spring"
    )
    length: Annotated[float | None, Quantity("m", 0.0, 10.0)] = Field(
        default=None, description="length from the root that is held; the whole lock when absent"
    )
    falloff: Annotated[float, Quantity("m", 0.0, 10.0)] = Field(
        default=0.0, description="length beyond that over which the hold falls off"
    )

    def weights(self, locks: Curves, scalp: Mesh, random: Random, what: str) -> NDArray[np.float64]:
        """Attachment weight of each point, shape (count, points)."""
        weight = self.firm * self.mask.weights(locks, scalp, random, f"{what}.mask")
        if self.length is None:
            return weight
        beyond = arc_lengths(grid(locks)) - self.length
        t = (
            np.clip(1.0 - beyond / self.falloff, 0.0, 1.0)
            if self.falloff > 0.0
            else (beyond <= 1e-9).astype(np.float64)
        )
        return weight * t * t * (3.0 - 2.0 * t)


def pinned(locks: Curves, pins: Sequence[Pin], scalp: Mesh, seed: int) -> Curves:
    """Adds the point attribute ``pin``: the largest weight of all pins, and of what lies on the scalp."""
    weights = [pin.weights(locks, scalp, Random(seed, f"pin[{k}]/mask"), f"pin[{k}]") for k, pin in enumerate(pins)]
    if LAID in locks.curve and locks.curve[LAID].any():
        t = np.clip((locks.curve[LAID][:, None] - arc_lengths(grid(locks))) / LEAVE, 0.0, 1.0)
        weights.append(np.where(locks.curve[LAID][:, None] > 0.0, t * t * (3.0 - 2.0 * t), 0.0))
    if not weights:
        return locks
    weight = np.max(weights, axis=0).ravel().astype(np.float32)
    return Curves(locks.points, locks.offsets, locks.ids, locks.curve, {**locks.point, PIN: weight})
