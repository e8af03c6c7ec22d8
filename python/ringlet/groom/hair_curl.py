"""Curl of hairs within their lock: sub-clumps, phases that slip, and a coil of each hair's own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from scipy.fft import rfft

from ringlet.data import limits
from ringlet.data.curves import Curves
from ringlet.data.errors import Fix, UserError
from ringlet.data.quantities import Quantity, Ramped, Section, Varied
from ringlet.data.random import Random, soft_threshold
from ringlet.groom.values import Values

MOST_FAMILIES = 64
LEAST_POINTS, GOOD_POINTS = 6, 8  # of a hair, per turn of its own coil
STEP = 16  # of the points of hairs: where they follow the lengths of locks, most changes of these keep them
TINY = float(np.finfo(np.float32).tiny)
BLOCK = 64  # locks whose points and spectra stay in the cache
FEWEST_TURNS = 1.5  # of a lock below which it has no coil


class Families(Section):
    """Sub-clumps of each lock: its hairs are drawn to the middle of the family that they stand nearest to."""

    count: Annotated[Varied, Quantity("", 1, MOST_FAMILIES)] = Field(
        default=Varied(value=5), description="number of families in a lock"
    )
    tightness: Annotated[Ramped, Quantity("", 0.0, 1.0)] = Field(
        default=Ramped(value=0.8, ramp=[(0, 0), (0.3, 1), (1, 0.9)]),
        description="how far hairs move to the middle of their family: 0 not, 1 to its radius",
    )
    radius: Annotated[Varied, Quantity("m", 0.0, 0.05)] = Field(
        default=Varied(value=0.0001), description="radius of a family at tightness 1"
    )
    noise: Annotated[Varied, Quantity("m", 0.0, 0.05)] = Field(
        default=Varied(value=0.0), description="how far families wander from their place in the lock"
    )


class HairCurl(Section):
    """How hairs follow the coil of their lock. The centre line of a coil is the lock smoothed over one turn."""

    drift: Annotated[Varied, Quantity("", 0.0, 5.0)] = Field(
        default=Varied(value=0.1),
        description="drift of the phase of hairs up to the tip (standard deviation, in turns)",
    )
    slips: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.1), description="fraction of the hairs whose phase slips at some place along the lock"
    )
    slip: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.3), description="size of a slip, in turns"
    )
    pitch_spread: Annotated[Varied, Quantity("", 0.0, 0.9)] = Field(
        default=Varied(value=0.0),
        description="how much the pitch differs between families, relative to that of the lock: 0.2 is ±20 %",
    )
    coherence: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.5), description="fraction of drift and slips that the hairs of a family share"
    )
    escape: Annotated[Ramped, Quantity("m", 0.0, 0.1)] = Field(
        default=Ramped(value=0.0, ramp=[(0, 0), (0.4, 0.2), (1, 1)]),
        description="distance of the coils of hairs from the centre line of the lock (standard deviation)",
    )
    relax: Annotated[Ramped, Quantity("", 0.0, 1.0)] = Field(
        default=Ramped(value=0.0, vary=0.3, ramp=[(0, 0), (0.8, 0), (1, 1)]),
        description="how much narrower the coil of a hair gets towards its own tip",
    )


class HairCoil(Section):
    """A coil of each hair's own about its place in the lock. Hairs get longer by it."""

    width: Annotated[Ramped, Quantity("m", 0.0, 0.05)] = Field(
        default=Ramped(value=0.0015, vary=0.3, ramp=[(0, 0), (0.1, 1), (1, 1)]),
        description="diameter; varies from hair to hair",
    )
    pitch: Annotated[Varied, Quantity("m", 5e-4, 1.0)] = Field(
        default=Varied(value=0.006, vary=0.2), description="length of the lock per turn; varies from hair to hair"
    )
    kink: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.0), description="0 a coil, 1 a zigzag in a plane"
    )
    irregularity: Annotated[Varied, Quantity("", 0.0, 0.9)] = Field(
        default=Varied(value=0.3), description="how much the pitch varies along a hair: 0 is even"
    )
    coherence: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.0), description="fraction of phase and pitch that the hairs of a family share"
    )


@dataclass
class Placed:
    """Hairs of all locks, in their places: arrays of one value a hair."""

    ids: NDArray[np.int64]
    lock: NDArray[np.int32]
    disk: NDArray[np.float64]  # place in the cross-section, relative to its radius, shape (hairs, 2)
    radius: NDArray[np.float64]  # of the lock's cross-section [m]
    free: NDArray[np.bool_]  # False for the hair that is the lock itself


def families(values: Values | None, hairs: Placed) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """The family of each hair: an id, shape (hairs,), and the vector to its middle in the disk, shape (hairs, 2).

    Without families every hair is one of its own.
    """
    if values is None:
        return hairs.ids, np.zeros((len(hairs.ids), 2))
    lock_ids = values.locks.ids
    counts = np.round(values("count")).astype(np.int64)
    random = Random(values.seed, "hairs/families")
    nearest, family = np.full(len(hairs.ids), np.inf), np.zeros(len(hairs.ids), np.int64)
    to = np.zeros((len(hairs.ids), 2))
    for k in range(int(counts.max())):
        names = lock_ids * MOST_FAMILIES + k
        radius = np.sqrt((k + 0.3 + 0.7 * random.uniform(names, 0)) / np.maximum(counts, 1))
        angle = k * np.pi * (3.0 - np.sqrt(5.0)) + 2.0 * np.pi * random.uniform(lock_ids, 1)
        middle = (0.9 * radius * (counts > 1))[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        off = middle[hairs.lock] - hairs.disk
        distance = np.where(k < counts[hairs.lock], np.sum(off**2, axis=1), np.inf)
        nearer = distance < nearest
        nearest[nearer], family[nearer], to[nearer] = distance[nearer], names[hairs.lock][nearer], off[nearer]
    return family, to


def curl_layout(
    family_values: Values | None,
    curl_values: Values | None,
    coil_values: Values | None,
    hairs: Placed,
    u: NDArray[np.float64],
    knots: int,
) -> tuple[dict[str, NDArray], NDArray[np.float64]]:
    """Arrays of the kernel's curl (src/ringlet/groom/hairs.h), and how far families wander at knots, (hairs, 2·knots).

    Turns of a coil and the wander of its phase count per metre of lock, and ``start`` is that phase at the root.
    ``spread`` is by how much the hair has more turns than its lock, relative to these. ``with_turns`` puts them
    together.
    """
    count, points, lock = len(hairs.ids), len(u), hairs.lock
    family, to = families(family_values, hairs)
    layout = {
        "slip": np.zeros((count, knots)),
        "escape": np.zeros((count, 2)),
        "relax": np.zeros(count),
        "family": np.zeros((count, 2)),
        "coil": np.zeros((count, 4)),
        "phase": np.zeros((count, knots)),
        "start": np.zeros(count),
        "spread": np.zeros(count),
        **{ramp: np.zeros(points) for ramp in ("escaping", "relaxing", "tight", "opening")},
    }
    wander = np.zeros((count, 2 * knots))
    if family_values is not None:
        own_radius = hairs.radius / np.sqrt(np.maximum(family_values("count")[lock], 1.0))
        share = np.clip(1.0 - family_values("radius")[lock] / np.maximum(own_radius, 1e-9), 0.0, 1.0)
        assert isinstance(family_values.settings, Families)
        layout["family"] = (family_values("tightness")[lock] * share * hairs.radius)[:, None] * to
        layout["tight"] = family_values.settings.tightness.along(u)
        noise = 2.0 * Random(family_values.seed, "hairs/families/noise").uniforms(family, 2 * knots) - 1.0
        wander = family_values("noise")[lock, None] * noise * np.linspace(0.0, 1.0, knots).repeat(2)
    if curl_values is not None:
        settings = curl_values.settings
        assert isinstance(settings, HairCurl)
        layout["slip"] = _slips(curl_values, hairs, family, knots)
        chance = 2.0 * Random(curl_values.seed, "hairs/pitch").uniform(family) - 1.0
        layout["spread"] = curl_values("pitch_spread")[lock] * chance
        away = Random(curl_values.seed, "hairs/escape").normals(hairs.ids, 2)
        layout["escape"] = curl_values("escape")[lock, None] * away
        layout["relax"] = curl_values.per_hair("relax", lock, hairs.ids)
        layout["escaping"], layout["relaxing"] = settings.escape.along(u), settings.relax.along(u)
    if coil_values is not None:
        settings = coil_values.settings
        assert isinstance(settings, HairCoil)
        layout["coil"], layout["phase"], layout["start"] = _coils(coil_values, hairs, family, knots)
        layout["opening"] = settings.width.along(u)
    for name in ("slip", "spread", "escape", "relax", "family"):
        layout[name][~hairs.free] = 0.0
    layout["coil"][~hairs.free, :2] = 0.0
    wander[~hairs.free] = 0.0
    return {name: np.ascontiguousarray(values, np.float32) for name, values in layout.items()}, wander


def _slips(values: Values, hairs: Placed, family: NDArray, knots: int) -> NDArray[np.float64]:
    """Phase of each hair relative to its lock [turns] at knots, shape (hairs, knots): a random walk, and a slip."""

    def phases(ids: NDArray, of: str) -> NDArray[np.float64]:
        random = Random(values.seed, f"hairs/slips/{of}")
        steps = random.normals(ids, knots - 1) * (values("drift")[hairs.lock, None] / np.sqrt(knots - 1))
        chance = random.uniforms(ids, knots + 2)[:, -3:]
        slips = soft_threshold(values("slips")[hairs.lock], chance[:, 0]) * np.where(chance[:, 1] < 0.5, -1.0, 1.0)
        at = np.floor(chance[:, 2] * (knots - 1)).astype(np.int64)
        steps[np.arange(len(ids)), at] += slips * values("slip")[hairs.lock]
        return np.concatenate([np.zeros((len(ids), 1)), np.cumsum(steps, axis=1)], axis=1)

    coherence = values("coherence")[hairs.lock, None]
    return coherence * phases(family, "family") + (1.0 - coherence) * phases(hairs.ids, "hair")


def _coils(values: Values, hairs: Placed, family: NDArray, knots: int) -> tuple[NDArray, NDArray, NDArray]:
    """Coil of each hair: radius times its direction [m], turns per metre of lock, kink; wander of its phase at knots
    [turns per metre], and the phase at the root [turns]."""
    lock, coherence = hairs.lock, values("coherence")[hairs.lock]

    def shared(own: NDArray, of_family: NDArray) -> NDArray[np.float64]:
        weight = coherence.reshape(-1, *[1] * (own.ndim - 1))
        return weight * of_family + (1.0 - weight) * own

    def of_both(purpose: str, columns: int) -> NDArray[np.float64]:
        random = Random(values.seed, f"hairs/coil/{purpose}")
        return shared(random.uniforms(hairs.ids, columns), random.uniforms(family, columns))

    turns = 1.0 / shared(values.per_hair("pitch", lock, hairs.ids), values.per_hair("pitch", lock, family))
    start = of_both("start", 2)
    angle = 2.0 * np.pi * start[:, 1]
    radius = 0.5 * values.per_hair("width", lock, hairs.ids)
    hand = np.where(
        Random(values.seed, "hairs/coil/hand").uniform(np.where(coherence > 0.5, family, hairs.ids)) < 0.5, -1, 1
    )
    wander = (values("irregularity")[lock] * turns / (knots - 1))[:, None]
    phase = np.cumsum(wander * (2.0 * of_both("wander", knots) - 1.0), axis=1)
    coil = [radius * np.cos(angle), radius * np.sin(angle), hand * turns, np.minimum(values("kink"), 1.0)[lock]]
    return np.stack(coil, axis=1), phase, start[:, 0]


def with_turns(layout: dict[str, NDArray], lengths: NDArray, turns: NDArray) -> dict[str, NDArray]:
    """The arrays of ``curl_layout`` as the kernel takes them, for hairs of these lengths [m], shape (hairs,).

    turns: of the lock of each hair, shape (hairs,)
    """
    lengths = lengths.astype(np.float32)
    coil, start = layout["coil"].copy(), layout["start"][:, None]
    coil[:, 2] *= lengths
    rest = {name: values for name, values in layout.items() if name not in ("start", "spread")}
    if layout["spread"].any():
        more = (layout["spread"] * turns).astype(np.float32)[:, None]
        rest["slip"] = rest["slip"] + more * np.linspace(0.0, 1.0, rest["slip"].shape[1], dtype=np.float32)
    return {**rest, "coil": coil, "phase": start + lengths[:, None] * layout["phase"]}


def points_needed(values: Values, lengths: NDArray) -> int:
    """Points that the coils of hairs need on locks of these lengths [m], shape (locks,)."""
    settings = values.settings
    assert isinstance(settings, HairCoil)
    closest = (1.0 - settings.pitch.vary) * values("pitch") / (1.0 + values("irregularity"))
    most = GOOD_POINTS * float((lengths / np.maximum(closest, 1e-9)).max(initial=0.0))
    return min(STEP * int(np.ceil(most / STEP)), limits.POINTS)


def check_points(coil: NDArray[np.float32], points: int) -> None:
    """Raises UserError when hairs have fewer than 6 points a turn of their coil."""
    most = float(np.abs(coil[:, 2]).max(initial=0.0))
    if most * LEAST_POINTS > points and np.any(coil[:, :2]):
        good = int(np.ceil(10 * most))
        raise UserError(
            f"hairs.points is {points}: too few for {most:.1f} turns of hairs.coil ({points / most:.1f} points a "
            f"turn); leave it out, or set it to {good} (at least {int(np.ceil(LEAST_POINTS * most))}), or "
            "raise hairs.coil.pitch",
            [Fix(("hairs", "points"), good)],
        )


def turn_points(locks: Curves) -> NDArray[np.int32]:
    """Points of a turn of each lock's coil, shape (locks,); 0 where a lock has none."""
    result = np.zeros(len(locks), np.int32)
    for n in np.unique(locks.counts):
        if n < 8:
            continue
        chosen = np.flatnonzero(locks.counts == n)
        for block in np.split(chosen, range(BLOCK, len(chosen), BLOCK)):
            result[block] = _turn_points(locks.points[locks.offsets[block, None] + np.arange(n)])
    return result


def _turn_points(points: NDArray[np.floating]) -> NDArray[np.float64]:
    """Points of a turn of locks with as many points each, (locks, n, 3), whole numbers of shape (locks,).

    The number of turns is the centre of the strongest peak in the spectrum of the second differences of its points.
    """
    n = points.shape[1]
    bend = np.diff(points, 2, axis=1).astype(np.float32)
    bend = (bend - bend.mean(axis=1, keepdims=True)) * np.hanning(n)[1:-1, None].astype(np.float32)
    spectrum: NDArray[np.complex64] = np.asarray(rfft(bend, n, axis=1), np.complex64)
    power = np.einsum("lfx,lfx->lf", spectrum.real, spectrum.real)
    power += np.einsum("lfx,lfx->lf", spectrum.imag, spectrum.imag)
    peak = np.where(power >= 0.25 * power.max(axis=1, keepdims=True), power, 0.0)
    turns = np.sum(peak * np.arange(power.shape[1]), axis=1) / np.maximum(peak.sum(axis=1), TINY)
    return np.where(turns >= FEWEST_TURNS, np.round(n / np.maximum(turns, 1.0)), 0.0)
