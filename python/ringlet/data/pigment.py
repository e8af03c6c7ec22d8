"""The colour of hair: from melanin and dye to absorption, and from absorption to the colour of dense hair.

One model serves recipes, files, pictures and the review page. A fibre absorbs by its pigments, per radius:
σ = c ((1 - r) σ_eumelanin + r σ_pheomelanin), with the concentration c and the redness r (d'Eon et al., "An
energy-conserving hair reflectance model", 2011). Many scatterings turn absorption into the colour C = exp(-D(β) √σ),
with the azimuthal roughness β (Chiang et al., "A practical and controllable hair and fur model for production path
tracing", 2016).
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.random import Random

# Absorption of pigments in linear red, green and blue, per radius of a fibre, at a concentration of 1.
EUMELANIN = np.array([0.419, 0.697, 1.37])
PHEOMELANIN = np.array([0.187, 0.4, 1.05])

MOST_MELANIN = 0.9999  # is black; 1 would be an infinite concentration
DARKEST = 1e-6  # least colour of a dye: 0 would be an infinite absorption
SURFACE = 0.032  # albedo of dense hair that absorbs all light: what the surfaces of fibres reflect

# Attributes of hairs and locks: parts from 0 to 1, and the linear colour of the dye. One row a curve or a point.
MELANIN, REDNESS, DYE, DYE_AMOUNT, GRAY = "melanin", "redness", "dye", "dye_amount", "gray"

# Attributes of the fiber: roughnesses and flatness from 0 to 1, tilt of the cuticle [degrees]. One row a curve.
FIBER = ROUGHNESS, AZIMUTHAL_ROUGHNESS, TILT, FLATNESS = "roughness", "azimuthal_roughness", "tilt", "flatness"
TWIST = "twist"  # of points: angle of the section's wide axis [degrees]
WHITE = 0.002  # melanin of a gray hair


@dataclass(frozen=True)
class HairColor:
    """A natural hair colour.

    melanin:             amount of pigment, from 0 (white) to 1 (black)
    redness:             fraction of it that is pheomelanin, from 0 to 1
    gray:                fraction of the hairs that are white
    roughness:           of the fiber along it: 0.25 widens the reflection by 13°
    azimuthal_roughness: around it
    """

    melanin: float
    redness: float
    gray: float = 0.0
    roughness: float = 0.25
    azimuthal_roughness: float = 0.38

    @property
    def reflectance(self) -> NDArray[np.float64]:
        """Mean reflectance of the hairs in linear red, green and blue, shape (3,)."""
        dark, white = (
            reflectance(absorption(m, self.redness), self.azimuthal_roughness) for m in (self.melanin, WHITE)
        )
        return (1.0 - self.gray) * dark + self.gray * white

    def reflectances(self, ids: NDArray[np.int64]) -> NDArray[np.float64]:
        """Reflectance of each hair, by its id, shape (hairs, 3)."""
        white = Random(1, "color/white").uniform(ids) < self.gray
        melanin = np.where(white, WHITE, self.melanin)
        return reflectance(absorption(melanin, self.redness), self.azimuthal_roughness)


HAIR_COLORS: dict[str, HairColor] = {
    "black": HairColor(0.998, 0.05, roughness=0.22, azimuthal_roughness=0.28),
    "dark_brown": HairColor(0.9, 0.15),
    "brown": HairColor(0.7, 0.4),
    "auburn": HairColor(0.8, 0.9),
    "ginger": HairColor(0.6, 0.95),
    "blond": HairColor(0.28, 0.5, azimuthal_roughness=0.33),
    "gray": HairColor(0.9, 0.1, gray=0.65, azimuthal_roughness=0.36),
    "white": HairColor(0.01, 0.0, gray=0.8, azimuthal_roughness=0.33),
}
DEFAULT_COLOR = "dark_brown"
USUAL_FIBER = {
    ROUGHNESS: HAIR_COLORS[DEFAULT_COLOR].roughness,
    AZIMUTHAL_ROUGHNESS: HAIR_COLORS[DEFAULT_COLOR].azimuthal_roughness,
    TILT: 2.0,
    FLATNESS: 0.0,
}


def hair_color(name: str | None) -> HairColor | None:
    """Hair colour of a name, None for None; raises UserError for an unknown one."""
    if name is None:
        return None
    if name not in HAIR_COLORS:
        raise UserError(f"picture: there is no hair colour '{name}'; choose one of {', '.join(HAIR_COLORS)}")
    return HAIR_COLORS[name]


def concentration(melanin: ArrayLike) -> NDArray[np.float64]:
    """Concentration of pigment of an amount of melanin from 0 to 1: c = -ln(1 - melanin), of the same shape.

    The amount is in even steps of what is seen; the concentration is not.
    """
    return -np.log1p(-np.clip(melanin, 0.0, MOST_MELANIN))


def melanin_of(concentration: ArrayLike) -> NDArray[np.float64]:
    """Amount of melanin of a concentration, the inverse of ``concentration``."""
    return np.minimum(-np.expm1(-np.asarray(concentration, np.float64)), MOST_MELANIN)


def absorption(melanin: ArrayLike, redness: ArrayLike) -> NDArray[np.float64]:
    """Absorption of melanin in linear red, green and blue, per radius of a fibre, shape (…, 3)."""
    amount, red = concentration(melanin)[..., None], np.clip(redness, 0.0, 1.0)[..., None]
    return amount * ((1.0 - red) * EUMELANIN + red * PHEOMELANIN)


def reflectance(absorption: ArrayLike, roughness: ArrayLike) -> NDArray[np.float64]:
    """Linear colour of dense hair by light that passes through fibres, without what their surfaces reflect.

    absorption: shape (…, 3)
    roughness:  azimuthal roughness of the fiber, from 0 to 1; one, or shape (…)
    """
    return np.exp(-_falloff(roughness) * np.sqrt(absorption))


def absorption_of(reflectance: ArrayLike, roughness: ArrayLike) -> NDArray[np.float64]:
    """Absorption at which dense hair has a colour, the inverse of ``reflectance``."""
    return (np.log(np.clip(reflectance, DARKEST, 1.0)) / _falloff(roughness)) ** 2


def display_color(reflectance: ArrayLike) -> NDArray[np.float64]:
    """Linear colour that dense hair has under white light, the reflection of surfaces included."""
    return SURFACE + (1.0 - SURFACE) * np.asarray(reflectance, np.float64)


def pigments_of_color(color: ArrayLike, roughness: float) -> tuple[float, float, float]:
    """Melanin and redness at which dense hair is nearest to a color: the inverse of ``display_color``.

    color: linear red, green and blue, shape (3,), of hair under white light
    roughness: azimuthal roughness of the fiber

    Also returns the distance of what they give from the color. Differences are between cube roots of the channels,
    which are even steps of lightness (CIE 1976).
    """
    wanted = np.cbrt(np.clip(np.asarray(color, np.float64), 0.0, 1.0))

    def missing(pigments: NDArray[np.float64]) -> NDArray[np.float64]:
        melanin, redness = pigments[..., 0], pigments[..., 1]
        return np.cbrt(display_color(reflectance(absorption(melanin, redness), roughness))) - wanted

    grid = np.stack(np.meshgrid(np.linspace(0.0, 0.999, 64), np.linspace(0.0, 1.0, 17), indexing="ij"), axis=-1)
    first = grid.reshape(-1, 2)[np.argmin((missing(grid) ** 2).sum(axis=-1))]
    bounds = [0.0, 0.0], [MOST_MELANIN, 1.0]
    found = scipy.optimize.least_squares(missing, first, bounds=bounds, xtol=1e-12, ftol=1e-12, gtol=1e-12)
    return float(found.x[0]), float(found.x[1]), float(np.linalg.norm(found.fun))


def dyed(natural: ArrayLike, dye: ArrayLike, amount: ArrayLike) -> NDArray[np.float64]:
    """Mixes the colour of a dye into a natural one, both reflectances of shape (…, 3).

    amount: 0 is natural hair; 1 is hair that was bleached and has the colour of the dye
    """
    part = np.clip(amount, 0.0, 1.0)[..., None]
    return (1.0 - part) * np.asarray(natural) + part * np.asarray(dye)


def linear_color(text: str) -> NDArray[np.float64]:
    """Linear red, green and blue of an sRGB colour ``#rrggbb``, shape (3,); raises ValueError for other text."""
    if not re.fullmatch(r"#[0-9a-fA-F]{6}", text):
        raise ValueError(text)
    encoded = np.array([int(text[k : k + 2], 16) for k in (1, 3, 5)]) / 255.0
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def curve_reflectance(curves: Curves, what: str) -> NDArray[np.float64] | None:
    """Reflectance of curves by their attributes, shape (curves, 3), or (points, 3) where one varies along them.

    None for curves without melanin. Amounts beyond 0 to 1 are clipped. ``what`` names the curves in messages.

    Raises UserError for attributes that are not finite, or not one number for each curve or point.
    """
    found = {name: _attribute(curves, name, what) for name in (MELANIN, REDNESS, DYE_AMOUNT)}
    if found[MELANIN] is None:
        return None
    dye, roughness = _dye(curves), fiber_rows(curves, AZIMUTHAL_ROUGHNESS)
    along = any(values is not None and name in curves.point for name, values in {**found, DYE: dye}.items())
    rows = {name: _spread(curves, name, values, along) for name, values in found.items() if values is not None}
    around = _spread(curves, AZIMUTHAL_ROUGHNESS, roughness, along)
    colors = reflectance(absorption(rows[MELANIN], rows.get(REDNESS, 0.0)), around)
    if dye is not None and DYE_AMOUNT in rows and len(dye):
        colors = dyed(colors, _spread(curves, DYE, dye, along), rows[DYE_AMOUNT])
    return colors


def of_fiber(curves: Curves, name: str, otherwise: float | None = None) -> float:
    """Mean of an attribute of ``FIBER`` over the curves; ``otherwise``, or the usual value, without it."""
    rows = fiber_rows(curves, name, otherwise)
    return float(rows.mean()) if len(rows) else USUAL_FIBER[name] if otherwise is None else otherwise


def fiber_rows(curves: Curves, name: str, otherwise: float | None = None) -> NDArray[np.float64]:
    """Values of an attribute of ``FIBER``, shape (curves,); ``otherwise``, or the usual value, where there are none."""
    usual = USUAL_FIBER[name] if otherwise is None else otherwise
    values = curves.curve.get(name)
    if values is None or values.ndim != 1 or values.dtype.kind not in "biuf":
        return np.broadcast_to(usual, len(curves))
    return np.where(np.isfinite(values), values, usual).astype(np.float64)


def _dye(curves: Curves) -> NDArray[np.float64] | None:
    """Linear colors of the dye, of each curve or of each point, shape (k, 3)."""
    values = curves.point.get(DYE, curves.curve.get(DYE))
    if values is None or values.ndim != 2 or not len(values):
        return None
    return np.clip(np.nan_to_num(np.asarray(values, np.float64)), 0.0, 1.0)


def _attribute(curves: Curves, name: str, what: str) -> NDArray[np.float64] | None:
    values = curves.point.get(name, curves.curve.get(name))
    if values is None:
        return None
    values = np.asarray(values)
    if values.ndim != 1 or values.dtype.kind not in "biuf" or not np.isfinite(values).all():
        raise UserError(f"{what}: {name} is not one finite number for each curve or point; write it again")
    return values


def _spread(curves: Curves, name: str, values: NDArray, along: bool) -> NDArray:
    """Values with a row for each point where ``along``, else for each curve."""
    return np.repeat(values, curves.counts, axis=0) if along and name not in curves.point else values


def _falloff(roughness: ArrayLike) -> NDArray[np.float64]:
    """D(β) of Chiang et al. 2016."""
    b = np.asarray(roughness, np.float64)
    b = b[..., None] if b.ndim else b
    return 5.969 + b * (-0.215 + b * (2.532 + b * (-10.73 + b * (5.574 + b * 0.245))))
