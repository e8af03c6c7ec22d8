"""The curl operator: winds groom guides about the shapes of locks."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, field_validator, model_validator

from ringlet import _core
from ringlet.data import limits
from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.errors import Fix, UserError
from ringlet.data.groom import STRAND_RADIUS
from ringlet.data.quantities import Quantity, Ramp, Ramped, Varied, along, refuse
from ringlet.data.random import soft_threshold
from ringlet.groom.operators.operator import LOCK_POINTS, Context, Operator, at_even_lengths, packed
from ringlet.groom.operators.phase_groups import PhaseGroups
from ringlet.groom.operators.tied import after_ties, with_heads
from ringlet.groom.presets import PRESETS, Preset
from ringlet.groom.scalp import axes

RAMP_SAMPLES = 128
NOISE_VALUES = 24
LEAST_POINTS, GOOD_POINTS = 6, 12  # of a lock, per turn
MAX_EVENTS = 12  # largest number of switchbacks, and of skips, of a lock
NEVER = 1e9
MAX_OPENING = 10.0  # largest factor on the width where a curl opens or closes
MIN_START = 1e-3  # [m] an opening length of 0 would move the root off the scalp


class Curl(Operator):
    """Winds each lock about its shape: ``p(v) = c(v) + r(v) (a cos φ + b sin φ)``, with (a, b) the rotation-minimising
    frame of the shape c. The radius ``r = width/2 · ramp`` opens smoothly from the root. The phase φ grows by one turn
    a pitch, and falls where the curl is left-handed. All ramps run from the root (0) to the tip (1).

    ``keep = "silhouette"``: the curl fills the shape's length, and the hair is longer by √(1 + (2πr/pitch)²).
    ``keep = "length"``: the hair has the shape's length, to a thousandth, and the silhouette is shorter.
    """

    removed: ClassVar[dict[str, str]] = {"rate": "give curls, curls_per_cm or pitch a ramp"}

    preset: Preset | None = Field(default=None, description="curl type; fills what is not given here")
    width: Annotated[Ramped, Quantity("m", 0.0, 0.2)] = Field(
        default=Ramped(value=0.008), description="diameter of the curl"
    )
    pitch: Annotated[Ramped | None, Quantity("m", 5e-4, 1.0)] = Field(
        default=None, description="rise per turn, along the shape"
    )
    curls: Annotated[Ramped | None, Quantity("", 0.0, 500.0, product=False)] = Field(
        default=None, description="number of turns of a lock; its ramp says where they are closer"
    )
    curls_per_cm: Annotated[Ramped | None, Quantity("", 0.0, 20.0)] = Field(
        default=None, description="number of turns per centimetre of the shape"
    )
    start: Annotated[Varied, Quantity("m", 0.0, 1.0)] = Field(
        default=Varied(value=0.01), description="length at the root over which the curl opens"
    )
    opening: Ramp = Field(
        default=[(0.0, 0.0), (1.0, 1.0)], description="ramp over that length: [place, factor on the width]"
    )
    end: Annotated[Varied, Quantity("m", 0.0, 1.0)] = Field(
        default=Varied(value=0.0), description="length at the tip over which the curl closes"
    )
    closing: Ramp = Field(
        default=[(0.0, 1.0), (1.0, 0.0)], description="ramp over that length: [place, factor on the width]"
    )
    taper: Annotated[Ramped, Quantity("", -1.0, 1.0)] = Field(
        default=Ramped(value=0.0, ramp=[(0, 0), (1, 1)]),
        description="how much narrower the curl gets: 1 to nothing, -1 to double; the ramp says where",
    )
    right_handed: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.5), description="fraction of the locks that wind right-handed"
    )
    switchbacks: Annotated[Varied, Quantity("", 0.0, 5.0)] = Field(
        default=Varied(value=0.0), description="changes of handedness per lock, on average"
    )
    skips: Annotated[Varied, Quantity("", 0.0, 5.0)] = Field(
        default=Varied(value=0.0), description="turns that a lock leaves out, on average"
    )
    phase: Annotated[Varied, Quantity("deg", -360.0, 360.0)] = Field(
        default=Varied(value=0.0), description="angle at which the curl starts"
    )
    phase_spread: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=1.0), description="scatter of phases: 0 all locks start alike, 1 anywhere"
    )
    phase_coherence: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.0), description="fraction of that scatter that neighbours share"
    )
    phase_wavelength: Annotated[float, Quantity("m", 1e-3, 1.0)] = Field(
        default=0.03, description="distance over which the phases of neighbours become independent"
    )
    phase_groups: PhaseGroups | None = Field(
        default=None, description="groups of neighbouring curls in phase; none when absent"
    )
    irregularity: Annotated[Varied, Quantity("", 0.0, 0.9)] = Field(
        default=Varied(value=0.2), description="how much width and pitch vary along a lock: 0 is even"
    )
    flatness: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.0), description="cross-section of the curl: 0 round, 1 a flat wave"
    )
    kink: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.0), description="0 a coil, 1 a zigzag whose plane varies with the irregularity"
    )
    wave: Annotated[Ramped, Quantity("m", 0.0, 0.2)] = Field(
        default=Ramped(value=0.0),
        description="width of a plane S-wave under the curl, in the plane where the curl starts",
    )
    wave_pitch: Annotated[Varied, Quantity("m", 1e-3, 1.0)] = Field(
        default=Varied(value=0.04), description="length of one such wave"
    )
    keep: Literal["silhouette", "length"] = Field(
        default="silhouette", description="what the curl preserves: the silhouette, or the length of the hair"
    )

    @field_validator("opening", "closing")
    @classmethod
    def _bounded(cls, ramp: list[tuple[float, float]]) -> list[tuple[float, float]]:
        if (most := max(factor for _, factor in ramp)) > MAX_OPENING:
            raise refuse(f"has a factor of {most:g}; must be at most {MAX_OPENING:g}")
        return ramp

    @classmethod
    def defaults(cls, data: dict[str, Any]) -> dict[str, Any]:
        """Defaults of the class, overridden by those of the preset."""
        preset = dict(PRESETS.get(str(data.get("preset")), {}))
        if any(data.get(name) is not None for name in ("curls", "curls_per_cm", "pitch")) and "pitch" not in data:
            preset.pop("pitch", None)
        return {**super().defaults(data), **preset}

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

    def turns(
        self, curves: Curves, lengths: NDArray, context: Context, u: NDArray
    ) -> tuple[NDArray[np.floating], NDArray[np.floating]]:
        """Curl count of each lock, shape (count,), and its relative density at parameters ``u``, with mean 1.

        lengths: of what is curled of each lock [m], shape (count,)
        """
        if self.curls is not None:
            turns, rate = context.values(self, "curls", curves), self.curls.along(u)
            return turns, rate / max(float(np.mean(rate)), 1e-9)
        if self.curls_per_cm is not None:
            turns, rate = (
                100.0 * lengths * context.values(self, "curls_per_cm", curves),
                self.curls_per_cm.along(u),
            )
        else:
            assert self.pitch is not None
            turns, rate = (
                lengths / context.values(self, "pitch", curves),
                1.0 / np.maximum(self.pitch.along(u), 0.05),
            )
        mean = max(float(np.mean(rate)), 1e-9)
        return turns * mean, rate / mean

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the groom guides, with points evenly spaced along the curl."""

        def values(name: str) -> NDArray[np.float64]:
            return context.values(self, name, curves)

        ids, u = curves.ids, np.linspace(0.0, 1.0, RAMP_SAMPLES)
        wound = after_ties(curves)
        lengths = wound.lengths()
        turns, rate = self.turns(curves, lengths, context, u)
        width = values("width")
        points = self._points(turns * curves.lengths() / lengths, width, curves, lengths, context.lock_points)
        # The irregularity itself varies per lock: some locks are neat, others are not.
        irregularity = (values("irregularity") * (0.5 + context.random("neatness").uniform(ids)))[:, None]
        noise = {
            name: np.clip(irregularity * (2.0 * context.random(name).uniforms(ids, NOISE_VALUES) - 1.0), -0.9, 0.9)
            for name in ("width", "rate", "sway")
        }
        kink = values("kink")
        curled = _core.curl_curves(
            *packed(wound),
            axis=axes(wound, context.scalp.frames(wound)),
            radius=0.5 * width,
            turns=turns,
            phase=np.radians(self._phase(curves, context)),
            # A lock between the two hands changes its hand at a point along its length.
            flip=2.0 - 3.0 * soft_threshold(values("right_handed"), context.random("hand").uniform(ids)),
            start=np.hypot(values("start"), MIN_START),
            end=values("end"),
            taper=np.minimum(values("taper"), 1.0),
            flatness=np.clip(values("flatness"), 0.0, 1.0),
            kink=np.clip(kink, 0.0, 1.0),
            wave=0.5 * values("wave"),
            wave_turns=lengths / values("wave_pitch"),
            width_ramp=self.width.along(u),
            rate_ramp=rate,
            opening=along(self.opening, u),
            closing=along(self.closing, u),
            taper_ramp=self.taper.along(u),
            wave_ramp=self.wave.along(u),
            width_noise=noise["width"],
            rate_noise=noise["rate"],
            sway=np.pi * np.clip(kink, 0.0, 1.0)[:, None] * noise["sway"],
            switchbacks=_events(values("switchbacks"), context.random("switchbacks").uniforms(ids, MAX_EVENTS)),
            skips=_events(values("skips"), context.random("skips").uniforms(ids, MAX_EVENTS)),
            **(self.phase_groups.values(curves, context) if self.phase_groups else _no_phase_groups(len(ids))),
            counted=self.curls is not None,
            keep_length=self.keep == "length",
            count=points,
        )
        curled = with_heads(curled, curves, wound)
        if (woven := curves.curve.get(STRAND_RADIUS, np.zeros(len(ids))) > 0.0).any():  # a braid holds its strands
            grid = curled.reshape(len(ids), points, 3)
            grid[woven] = _core.resample_curves(*packed(curves.take(woven)), points).reshape(-1, points, 3)
        offsets = offsets_from_counts(np.full(len(ids), points))
        return Curves(curled, offsets, ids, curves.curve, at_even_lengths(curves, points))

    def _points(self, turns: NDArray, width: NDArray, curves: Curves, lengths: NDArray, given: int | None) -> int:
        """Points of a lock: as given, or as the closest curl needs; raises UserError for fewer than 6 a curl."""
        if self.keep == "length" and self.curls is None:  # the curled part of the shape is shorter
            turns = turns / np.hypot(1.0, np.pi * width * turns / lengths)
        most = float(turns.max())
        good = int(np.ceil(GOOD_POINTS * most))
        points = given or min(max(good, LOCK_POINTS, int(curves.counts.max())), limits.POINTS)
        if most > points / LEAST_POINTS:
            least = int(np.ceil(LEAST_POINTS * most))
            remedy = f"leave it out, or set it to {good} (at least {least}), or ask for fewer curls"
            if good > limits.POINTS:
                remedy = f"must be at most {limits.POINTS}, so ask for fewer than {points // LEAST_POINTS} curls"
            raise UserError(
                f"locks.points is {points}: too few for {most:.1f} curls ({points / most:.1f} points a curl); {remedy}",
                [Fix(("locks", "points"), good)] if good <= limits.POINTS else [],
            )
        return points

    def _phase(self, curves: Curves, context: Context) -> NDArray[np.float64]:
        """Initial phase of each curl [degrees], shape (count,): random per lock plus a field that neighbours share."""
        spread, shared_fraction, phase = (
            context.values(self, name, curves) for name in ("phase_spread", "phase_coherence", "phase")
        )
        own = context.random("phase").uniform(curves.ids)
        shared = context.random("phase_field").field(curves.roots, self.phase_wavelength)
        return phase + 360.0 * spread * ((1.0 - shared_fraction) * own + shared_fraction * shared)


def _events(rate: NDArray, chance: NDArray) -> NDArray[np.float64]:
    """Ascending event parameters of each lock, shape (count, MAX_EVENTS): on average ``rate`` events in [0, 1].

    The gaps are exponentially distributed. A higher rate moves all events towards the root; new ones enter at the tip.
    """
    gaps = -np.log1p(-np.minimum(chance, 1.0 - 1e-12))
    return np.minimum(np.cumsum(gaps, axis=1) / np.maximum(rate, 1e-9)[:, None], NEVER)


def _no_phase_groups(count: int) -> dict[str, NDArray]:
    """Arguments of the core for locks without phase locking; each of shape (count,)."""
    zeros = np.zeros(count)
    return {"leader": np.arange(count, dtype=np.int32), "join": zeros, "join_over": zeros, "cohesion": zeros}
