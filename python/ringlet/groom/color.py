"""The colour of hair in a recipe: melanin, gray hairs and dye, for each lock and each hair."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator, Field, WithJsonSchema

from ringlet.data.curves import Curves
from ringlet.data.groom import Groom
from ringlet.data.mesh import Mesh
from ringlet.data.painted import per_lock
from ringlet.data.pigment import (
    AZIMUTHAL_ROUGHNESS,
    DEFAULT_COLOR,
    DYE,
    DYE_AMOUNT,
    FIBER,
    GRAY,
    HAIR_COLORS,
    MELANIN,
    REDNESS,
    ROUGHNESS,
    WHITE,
    concentration,
    linear_color,
    melanin_of,
)
from ringlet.data.quantities import Quantity, Ramped, Section, Varied, refuse
from ringlet.data.random import Random, soft_threshold
from ringlet.groom.fiber import FiberSettings
from ringlet.groom.hair_settings import fiber_settings
from ringlet.groom.mask import Mask
from ringlet.groom.operators.operator import arc_lengths, grid

MOST_DYES = 32
REGROWN = 0.15  # part of the regrowth over which the natural colour passes into the dye

Preset = Literal["black", "dark_brown", "brown", "auburn", "ginger", "blond", "gray", "white"]


def _is_color(text: str) -> str:
    try:
        linear_color(text)
    except ValueError:
        raise refuse(f"is '{text}'; must be a colour such as \"#b4531f\"") from None
    return text.lower()


Color = Annotated[
    str,
    AfterValidator(_is_color),
    WithJsonSchema({"type": "string", "format": "color", "pattern": "^#[0-9a-fA-F]{6}$"}),
]


class Dye(Section):
    """Hair that is dyed. Dye replaces the natural colour by its amount, as after bleaching."""

    color: Color = Field(default="#b4531f", description="colour of dyed hair, in sRGB: `#rrggbb`")
    amount: Annotated[Ramped, Quantity("", 0.0, 1.0)] = Field(
        default=Ramped(value=1.0), description="how much of the natural colour it replaces; a ramp gives an ombré"
    )
    mask: Annotated[Mask, Quantity("", 0.0, 1.0)] = Field(
        default=Mask(), description='which locks, and where along them, such as streaks: `{ where = "random < 0.2" }`'
    )
    regrowth: Annotated[Varied, Quantity("m", 0.0, 10.0)] = Field(
        default=Varied(value=0.0), description="length at the root that has grown since, in the natural colour"
    )

    def amounts(self, locks: Curves, scalp: Mesh, seed: int, what: str) -> NDArray[np.float64]:
        """Amount of dye at the points of locks, shape (locks, points), or (locks, 1) where it is the same along all.

        what: the table's name in the recipe, such as ``color.dye``
        """
        source = what.replace(".", "/")

        def values(name: str) -> NDArray[np.float64]:
            return per_lock(self, name, Random(seed, f"{source}/{name}"), locks, scalp, f"{what}.{name}")

        u = np.linspace(0.0, 1.0, int(locks.counts[0]))
        amount = values("amount")[:, None] * self.amount.along(u)
        amount = amount * self.mask.weights(locks, scalp, Random(seed, f"{source}/mask"), f"{what}.mask")
        if (regrowth := values("regrowth")).any():
            beyond = arc_lengths(grid(locks)) / np.maximum(regrowth, 1e-9)[:, None] - 1.0
            t = np.clip(beyond / REGROWN + 1.0, 0.0, 1.0)
            amount = amount * np.where(regrowth[:, None] > 0.0, t * t * (3.0 - 2.0 * t), 1.0)
        constant = np.ptp(amount, axis=1).max(initial=0.0) == 0.0
        return np.clip(amount[:, :1] if constant else amount, 0.0, 1.0)


class ColorSettings(Section):
    """Colour of the hair, by its pigments. Renderers and the review page show it; it changes no shape."""

    preset: Preset | None = Field(default=None, description="natural hair colour; fills what is not given here")
    melanin: Annotated[Ramped, Quantity("", 0.0, 1.0)] = Field(
        default=Ramped(value=HAIR_COLORS[DEFAULT_COLOR].melanin),
        description="amount of pigment: 0 white, 0.3 blond, 0.8 brown, 1 black; `vary` and `noise` change its "
        "concentration",
    )
    redness: Annotated[Ramped, Quantity("", 0.0, 1.0)] = Field(
        default=Ramped(value=HAIR_COLORS[DEFAULT_COLOR].redness),
        description="share of the melanin that is pheomelanin: 0 ashen, 0.9 ginger",
    )
    vary_hairs: Annotated[float, Quantity("", 0.0, 1.0)] = Field(
        default=0.2, description="random change of the concentration from hair to hair: 0.2 is ±20 %"
    )
    gray: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.0), description="fraction of the hairs that are white"
    )
    dye: Dye | None = Field(default=None, description="dyed hair; none when absent")
    dyes: list[Dye] = Field(
        default=[], max_length=MOST_DYES, description="further dyes, each over those before it: `[[color.dyes]]`"
    )
    seed: int = Field(default=1, ge=0, le=2**31, description="another seed varies other locks and hairs")

    @classmethod
    def defaults(cls, data: dict[str, Any]) -> dict[str, Any]:
        """Defaults of the class, overridden by those of the preset."""
        named = HAIR_COLORS.get(str(data.get("preset")))
        preset = {name: {"value": getattr(named, name)} for name in (MELANIN, REDNESS, GRAY)} if named else {}
        return {**super().defaults(data), **preset}

    def dye_layers(self) -> dict[str, Dye]:
        """All dyes by the name of their tables, the lowest first."""
        first = {"color.dye": self.dye} if self.dye is not None else {}
        return {**first, **{f"color.dyes[{k}]": dye for k, dye in enumerate(self.dyes)}}

    def dyed_at(self, locks: Curves, scalp: Mesh) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Linear color of all dyes together and their amount at the points of locks: (locks, k, 3), (locks, k).

        k is 1 where one is the same along all. Each dye covers what is below it by its amount (Porter and Duff 1984).
        """
        color, amount = np.zeros((len(locks), 1, 3)), np.zeros((len(locks), 1))
        for number, (name, dye) in enumerate(self.dye_layers().items()):
            own, over = dye.amounts(locks, scalp, self.seed, name), linear_color(dye.color)
            amount = 1.0 - (1.0 - own) * (1.0 - amount)
            share = np.where(amount > 0.0, own / np.maximum(amount, 1e-12), 1.0)[:, :, None]
            color = color + share * (over - color) if number else np.broadcast_to(over, color.shape)
        return color, amount

    def melanin_at(self, locks: Curves, scalp: Mesh) -> NDArray[np.float64]:
        """Melanin at the points of locks, shape (locks, points), or (locks, 1) where it is the same along all.

        Variation acts on the concentration, so that it is as visible in dark hair as in light hair.
        """
        random = Random(self.seed, "color/melanin")
        even = self.model_copy(update={MELANIN: self.melanin.model_copy(update={"vary": 0.0, "noise": 0.0})})
        value = per_lock(even, MELANIN, random, locks, scalp, "color.melanin")
        factors = self.melanin.factors(random, locks.ids, locks.roots)
        factors[np.isin(locks.ids, list(self.melanin.lock))] = 1.0  # values of single locks count as they are
        return melanin_of(factors[:, None] * concentration(value[:, None] * _along(self.melanin, locks)))

    def redness_at(self, locks: Curves, scalp: Mesh) -> NDArray[np.float64]:
        """Redness at the points of locks, shape as of ``melanin_at``."""
        value = per_lock(self, REDNESS, Random(self.seed, "color/redness"), locks, scalp, "color.redness")
        return np.clip(value[:, None] * _along(self.redness, locks), 0.0, 1.0)


def colored(locks: Curves, color: ColorSettings | None, fiber: FiberSettings | None, scalp: Mesh) -> Curves:
    """Adds the attributes of colour and fibre to locks, float32: for each point what varies along the locks, else for
    each lock. Without settings the locks stay as they are.

    Raises UserError for maps and regions that are not there.
    """
    if color is None and fiber is None:
        return locks
    curve, point = dict(locks.curve), dict(locks.point)
    if color is not None:
        found = {MELANIN: color.melanin_at(locks, scalp), REDNESS: color.redness_at(locks, scalp)}
        if color.dye_layers():
            found[DYE], found[DYE_AMOUNT] = color.dyed_at(locks, scalp)
        for name, values in found.items():
            rows = values.reshape(-1, *values.shape[2:]).astype(np.float32)
            (curve if values.shape[1] == 1 else point)[name] = rows
        random = Random(color.seed, "color/gray")
        curve[GRAY] = per_lock(color, GRAY, random, locks, scalp, "color.gray").astype(np.float32)
    named = HAIR_COLORS[(color and color.preset) or DEFAULT_COLOR]
    usual = {ROUGHNESS: named.roughness, AZIMUTHAL_ROUGHNESS: named.azimuthal_roughness}
    curve |= (fiber or FiberSettings()).optics(locks, scalp, usual)
    return Curves(locks.points, locks.offsets, locks.ids, curve, point)


def hair_colors(groom: Groom, hairs: Curves) -> Curves:
    """Adds the attributes of colour and fibre to hairs, by their locks, with the variation from hair to hair.

    hairs: curves with the attribute ``lock``, of equal point counts
    """
    locks, lock = groom.locks, hairs.curve["lock"]
    curve, point = dict(hairs.curve), dict(hairs.point)
    fiber = fiber_settings(groom)
    for name in FIBER:
        if (values := locks.curve.get(name)) is not None and len(values):
            same = not fiber.vary_hairs and (values == values[0]).all()
            curve[name] = _same(values[0], len(hairs)) if same else fiber.of_hairs(name, values, lock, hairs.ids)
    for name in (REDNESS, DYE, DYE_AMOUNT):
        if name in locks.point:
            carried = _carried(locks, name, lock, hairs)
            point[name] = carried.reshape(-1, *carried.shape[2:])
        elif name in locks.curve:
            curve[name] = locks.curve[name][lock]
    if MELANIN in locks.point or MELANIN in locks.curve:
        melanin = _hair_melanin(groom, hairs)
        (curve if melanin.shape[1] == 1 else point)[MELANIN] = melanin.ravel()
    return Curves(hairs.points, hairs.offsets, hairs.ids, curve, point)


def _hair_melanin(groom: Groom, hairs: Curves) -> NDArray[np.float32]:
    """Melanin of hairs, shape (hairs, points) or (hairs, 1)."""
    color, locks, lock, ids = groom.color or {}, groom.locks, hairs.curve["lock"], hairs.ids
    melanin = _carried(locks, MELANIN, lock, hairs) if MELANIN in locks.point else locks.curve[MELANIN][lock][:, None]
    if vary := color.get("vary_hairs", 0.0):
        chance = Random(color.get("seed", 1), "color/hairs")
        factor = Varied(value=1.0, vary=vary).factors(chance, ids, ids).astype(np.float32)
        melanin = melanin_of(factor[:, None] * concentration(melanin))
    if (gray := locks.curve.get(GRAY)) is not None and gray.any():
        white = soft_threshold(gray[lock], Random(color.get("seed", 1), "color/white").uniform(ids))[:, None]
        melanin = (1.0 - white) * melanin + white * WHITE
    return np.asarray(melanin, np.float32)


def _carried(locks: Curves, name: str, lock: NDArray[np.int32], hairs: Curves) -> NDArray[np.float32]:
    """Values at the points of locks at those of their hairs, shape (hairs, points, …), linear between them."""
    points = int(hairs.counts[0]) if len(hairs) else 0
    u = np.linspace(0.0, 1.0, points)
    values, first, last = locks.point[name], locks.offsets[:-1, None], locks.counts[:, None] - 1
    at = u * last
    below = np.minimum(at.astype(np.int64), np.maximum(last - 1, 0))
    row, t = first + below, at - below
    t = t.reshape(*t.shape, *[1] * (values.ndim - 1))
    sampled = (1.0 - t) * values[row] + t * values[np.minimum(row + 1, first + last)]
    return sampled.astype(np.float32)[lock]


def _along(setting: Ramped, locks: Curves) -> NDArray[np.float64]:
    """The ramp of a setting at the points of locks, or at one where it is constant."""
    constant = len({factor for _, factor in setting.ramp}) == 1
    return setting.along(np.linspace(0.0, 1.0, 1 if constant else int(locks.counts[0])))


def _same(value: Any, count: int) -> NDArray[np.float32]:
    """One value for each of ``count`` curves, without memory for each."""
    row = np.asarray(value, np.float32)
    return np.broadcast_to(row, (count, *row.shape))
