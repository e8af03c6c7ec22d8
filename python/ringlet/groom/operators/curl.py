"""Curls: the operator that makes groom guides out of shapes."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from ringlet import _core
from ringlet.curves import Curves, offsets_from_counts
from ringlet.errors import UserError
from ringlet.groom.operators.operator import Context, Operator, packed
from ringlet.groom.presets import PRESETS
from ringlet.groom.settings import Quantity, Ramp, Ramped, Varied, along, refuse

RAMP_SAMPLES = 128
NOISE_VALUES = 24


class Curl(Operator):
    """Winds each lock about its shape: ``p(u) = c(u) + r(u) (a cos φ + b sin φ)``, with (a, b) the rotation-minimising
    frame of the shape c, the radius ``r = width/2 · ramp`` opening smoothly from the root, and φ growing by one turn
    per pitch.

    ``keep = "silhouette"``: the curl fills the shape's length L, and the hair is longer, by √(1 + (2πr/pitch)²).
    ``keep = "length"``: the hair has the shape's length, and the silhouette is shorter by the same factor.
    """

    preset: Literal["3B", "3C", "4A", "4C"] | None = Field(
        default=None, description="curl type; fills what is not given here"
    )
    width: Annotated[Ramped, Quantity("m", 0.0, 0.2)] = Field(
        default=Ramped(value=0.008), description="diameter of the curl"
    )
    pitch: Annotated[Varied | None, Quantity("m", 5e-4, 1.0)] = Field(
        default=None, description="rise per curl, along the shape"
    )
    curls: Annotated[Varied | None, Quantity("", 0.0, 500.0)] = Field(
        default=None, description="number of curls of a lock"
    )
    curls_per_cm: Annotated[Varied | None, Quantity("", 0.0, 20.0)] = Field(
        default=None, description="number of curls per centimetre of shape"
    )
    rate: Ramp = Field(default=[(0.0, 1.0), (1.0, 1.0)], description="ramp: [place, factor] on curls per length")
    start: Annotated[float, Quantity("m", 0.0, 1.0)] = Field(
        default=0.01, description="length at the root over which the curl opens"
    )
    right_handed: Annotated[float, Quantity("", 0.0, 1.0)] = Field(
        default=0.5, description="part of the locks that wind right-handed"
    )
    switchbacks: Annotated[float, Quantity("", 0.0, 5.0)] = Field(
        default=0.0, description="changes of hand per lock, on average"
    )
    phase: Annotated[float, Quantity("deg", -360.0, 360.0)] = Field(default=0.0, description="where the curl starts")
    phase_spread: Annotated[float, Quantity("", 0.0, 1.0)] = Field(
        default=1.0, description="0: all start alike, 1: anywhere"
    )
    irregularity: Annotated[float, Quantity("", 0.0, 0.9)] = Field(
        default=0.2, description="how much width and pitch wander along a lock"
    )
    flatness: Annotated[float, Quantity("", 0.0, 1.0)] = Field(default=0.0, description="0 a round curl, 1 a flat wave")
    keep: Literal["silhouette", "length"] = Field(default="silhouette", description="what the curl does not change")

    @classmethod
    def defaults(cls, data: dict[str, Any]) -> dict[str, Any]:
        """The preset's settings, then those of the class."""
        said = dict(PRESETS.get(str(data.get("preset")), {}))
        if any(data.get(name) is not None for name in ("curls", "curls_per_cm", "pitch")) and "pitch" not in data:
            said.pop("pitch", None)
        return {**super().defaults(data), **said}

    @model_validator(mode="after")
    def _one_count(self) -> Curl:
        given = [name for name in ("curls", "curls_per_cm", "pitch") if getattr(self, name) is not None]
        if len(given) > 1:
            raise refuse(f"has both '{given[0]}' and '{given[1]}'; give exactly one of curls, curls_per_cm and pitch")
        if not given:
            raise refuse(
                "says neither how many curls nor how close; give a preset, or one of curls, curls_per_cm and pitch"
            )
        return self

    def turns(self, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Curls of each lock, shape (count,)."""
        lengths = curves.lengths()
        if self.curls is not None:
            return context.values("curls", self.curls, curves)
        if self.curls_per_cm is not None:
            return 100.0 * lengths * context.values("curls_per_cm", self.curls_per_cm, curves)
        assert self.pitch is not None
        return lengths / context.values("pitch", self.pitch, curves)

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Groom guides, their points evenly spaced along the curl."""
        turns, points = self.turns(curves, context), context.lock_points
        if (most := float(turns.max())) > points / 6.0:
            raise UserError(
                f"locks.points is {points}: too few for {most:.1f} curls ({points / most:.1f} points a curl); "
                f"set it to {int(np.ceil(12 * most))} (at least {int(np.ceil(6 * most))}), or ask for fewer curls"
            )
        frames = context.scalp.frames(curves)
        ids, u = curves.ids, np.linspace(0.0, 1.0, RAMP_SAMPLES)
        right = context.random("hand").uniform(ids) < self.right_handed
        phase = 360.0 * self.phase_spread * context.random("phase").uniform(ids) + self.phase
        # How strongly each lock wanders is its own affair too: some are neat, some are not.
        wander = self.irregularity * (0.5 + context.random("neatness").uniform(ids))[:, None]
        width_noise, rate_noise = (
            np.clip(wander * (2.0 * context.random(name).uniforms(ids, NOISE_VALUES) - 1.0), -0.9, 0.9)
            for name in ("width", "rate")
        )
        curled = _core.curl_curves(
            *packed(curves),
            axis=np.ascontiguousarray(frames[:, :, 0]),
            radius=0.5 * context.values("width", self.width, curves),
            turns=np.where(right, turns, -turns),
            phase=np.radians(phase),
            start=np.full(len(ids), self.start),
            width_ramp=self.width.along(u),
            rate_ramp=along(self.rate, u),
            width_noise=width_noise,
            rate_noise=rate_noise,
            hand=self._hands(context, ids),
            flatness=self.flatness,
            keep_length=self.keep == "length",
            count=points,
        )
        return Curves(curled, offsets_from_counts(np.full(len(ids), points)), ids, curves.curve)

    def _hands(self, context: Context, ids: NDArray) -> NDArray[np.float64]:
        """+1, and -1 after an odd number of switchbacks; shape (count, NOISE_VALUES)."""
        turned = context.random("switchbacks").uniforms(ids, NOISE_VALUES) < self.switchbacks / NOISE_VALUES
        turned[:, 0] = False
        return np.where(np.cumsum(turned, axis=1) % 2 == 1, -1.0, 1.0)
