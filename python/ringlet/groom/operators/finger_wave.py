"""Finger waves: hair laid on the skin in rows of S-waves with ridges between, side by side over the head."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator
from scipy.spatial import KDTree

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.quantities import Quantity, Varied, refuse
from ringlet.data.smooth_step import smooth_step
from ringlet.groom.helpers import Names
from ringlet.groom.operators.operator import (
    Context,
    arc_lengths,
    evenly,
    grid,
    on_splines,
    packed,
    unit,
    with_grid,
    with_lock_points,
)
from ringlet.groom.operators.shape import Shape

SPACING = 5e-4  # of the places that represent a drawn line [m]
POINTS, FEWEST_POINTS = 20, 8  # of a lock in a wave: where recipes leave them free, and at least
EASE = 0.25  # part of a wave over which it begins, ends, and leaves the roots

Field3 = Callable[[NDArray[np.float64]], tuple[NDArray[np.float64], NDArray[np.float64]]]


class FingerWave(Shape):
    """Lays locks on the skin in waves whose phase is the distance *d* from a line, so that locks side by side wave
    together and ridges run along the line: ``p' = p + a sin φ · along + h sin⁴φ · normal`` with
    ``φ = 2π (d - start) / wavelength``. Locks keep their lengths, and end sooner by what the waves take up.

    Ridges are where hair turns, two in a wave. What is below the skin is laid on it first, and what stands off further
    than ``off`` is drawn in.
    """

    op: Literal["finger_wave"] = "finger_wave"
    curve: Names | None = Field(
        default=None,
        description="names of helper curves, from `[curves]`, that ridges run along; the part line of the guides when "
        "absent",
    )
    wavelength: Annotated[float, Quantity("m", 5e-3, 1.0)] = Field(
        default=0.045, description="distance across the ridges over which hair turns to both sides: two ridges"
    )
    amplitude: Annotated[Varied, Quantity("m", 0.0, 0.1)] = Field(
        default=Varied(value=0.006), description="how far hair swings to each side"
    )
    height: Annotated[Varied, Quantity("m", 0.0, 0.05)] = Field(
        default=Varied(value=0.004), description="height of ridges over the hair between them"
    )
    off: Annotated[float, Quantity("m", 1e-4, 0.1)] = Field(
        default=0.006, description="distance from the skin to which hair between the ridges is drawn in at most"
    )
    start: Annotated[float, Quantity("m", 0.0, 10.0)] = Field(
        default=0.01, description="distance from the line at which waves begin"
    )
    end: Annotated[float | None, Quantity("m", 0.0, 10.0)] = Field(
        default=None, description="distance from the line at which they end; at the tips when absent"
    )

    @model_validator(mode="after")
    def _begins_before_it_ends(self) -> FingerWave:
        if self.end is not None and self.end <= self.start:
            raise refuse("ends before it starts; set an 'end' beyond the 'start'")
        return self

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the waved curves, all with ``lock_points`` points or more."""
        if not self.weights(curves, context).any():
            return curves
        waves = float(curves.lengths().max()) / self.wavelength
        fine = with_lock_points(curves, context, int(np.ceil(POINTS * waves)))
        if (points := int(fine.counts[0])) < FEWEST_POINTS * waves:
            raise UserError(
                f"{context.purpose} has {points / waves:.2g} points of a lock in a wave, where it needs "
                f"{FEWEST_POINTS}; raise locks.points, or the wavelength"
            )
        laid = with_grid(fine, _core.push_out(*packed(fine), context.scalp.bodies, 0.0).reshape(grid(fine).shape))
        return self.blended(fine, self.shape(grid(laid), fine, context), self.weights(fine, context))

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the waved shapes; roots and lengths stay."""
        run, places = arc_lengths(points), np.ascontiguousarray(points.reshape(-1, 3), np.float64)
        distance, away = self._from_line(context)(places)
        distance = distance.reshape(run.shape)
        ease = self._eased(run) * self._eased(distance - self.start)
        if self.end is not None:
            ease = ease * self._eased(self.end - distance)
        swing = np.sin(2.0 * np.pi * (distance - self.start) / self.wavelength)
        aside = ease * swing * context.values(self, "amplitude", curves)[:, None]
        raised = ease * swing**4 * context.values(self, "height", curves)[:, None]
        above, _, normal, _ = context.scalp.solid.above(places)
        above = np.maximum(above, 0.0).reshape(run.shape)
        to = above + ease * (self.off * np.tanh(above / self.off) - above) + raised
        moved = places + aside.reshape(-1, 1) * unit(np.cross(normal, away))
        now, _, normal, _ = context.scalp.solid.above(np.ascontiguousarray(moved))
        moved += np.where(ease > 0.0, to - now.reshape(run.shape), 0.0).reshape(-1, 1) * normal
        return on_splines(moved.reshape(points.shape), run)

    def _eased(self, beyond: NDArray) -> NDArray[np.float64]:
        """From 0 to 1 over the first part of a wave beyond where it begins [m]."""
        return smooth_step(beyond / (EASE * self.wavelength))

    def _from_line(self, context: Context) -> Field3:
        """Distances of places (n, 3) from the line [m], shape (n,), and unit directions away from it, shape (n, 3)."""
        part = context.part_line
        names = self.curve or (part.curve if part else None)
        if names is not None:
            drawn = context.helper(names, "curve")
            counts = np.maximum(2, drawn.lengths() / SPACING).astype(int)
            tree = KDTree(np.concatenate([evenly(drawn[k], int(count)) for k, count in enumerate(counts)]))

            def from_curves(places: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
                distance, nearest = tree.query(places)
                return np.asarray(distance), unit(places - tree.data[nearest])

            return from_curves
        if part is None:
            raise UserError(
                f"{context.purpose} has no line to run along; name a curve of [curves], or give guides.part_line"
            )
        across, middle = unit(np.array(part.across)), context.scalp.middle

        def from_plane(places: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
            off = (places - middle) @ across - part.offset
            return np.abs(off), np.sign(off)[:, None] * across

        return from_plane
