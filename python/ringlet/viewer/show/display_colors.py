"""Colours of hairs for display: the reflectance by their pigments, at few places along each hair."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.digest import digest
from ringlet.data.groom import Groom
from ringlet.data.pigment import (
    AZIMUTHAL_ROUGHNESS,
    DYE,
    DYE_AMOUNT,
    FIBER,
    GRAY,
    HAIR_COLORS,
    MELANIN,
    REDNESS,
    ROUGHNESS,
    TILT,
    curve_reflectance,
    of_fiber,
)
from ringlet.groom import AnyHairs, JoinedHairs, grooms_of, hair_colors
from ringlet.groom.joined_hairs import IDS_PER_GROOM
from ringlet.groom.several import WITHOUT
from ringlet.groom.thinning import spread
from ringlet.viewer import protocol
from ringlet.viewer.show.display_groom import shuffled_order
from ringlet.viewer.wire import pack

STATIONS = 24  # of a hair whose colour varies along it


def named() -> dict[str, tuple[float, ...]]:
    """Reflectance, three channels, and both roughnesses of the named hair colors."""
    return {
        name: (*color.reflectance, color.roughness, color.azimuthal_roughness) for name, color in HAIR_COLORS.items()
    }


def inputs(groom: Groom) -> str:
    """Digest of what the colours of hairs depend on, their layout aside."""
    locks, names = groom.locks, (MELANIN, REDNESS, GRAY, DYE, DYE_AMOUNT, *FIBER)
    values = [kind[name] for name in names for kind in (locks.curve, locks.point) if name in kind]
    return digest(groom.color, groom.fiber, groom.grooms, *values)


def message(side: str, groom: Groom, hairs: AnyHairs | None) -> bytes:
    """Message with the colours of hairs, or of the locks where these are the hairs."""
    if hairs is None:
        curves, order = groom.locks, shuffled_order(len(groom.locks))
        colors = _at_stations(curves, curve_reflectance(curves, "hairs"))
    else:
        order = spread(np.bincount(hairs.curves.curve["lock"], minlength=len(groom.locks)))
        curves, colors = _hair_reflectances(groom, hairs)
    stations = 0 if colors is None else len(colors) // max(len(curves), 1)
    values = np.empty(0) if colors is None else colors.reshape(len(curves), stations, 3)[order]
    return pack(
        protocol.Colors.model_validate(
            {
                "side": side,
                "stations": stations,
                "roughness": of_fiber(curves, ROUGHNESS),
                "azimuthal_roughness": of_fiber(curves, AZIMUTHAL_ROUGHNESS),
                "tilt": of_fiber(curves, TILT),
            }
        ),
        reflectance=np.rint(255.0 * np.sqrt(np.sqrt(values))),
    )


def _hair_reflectances(groom: Groom, hairs: AnyHairs) -> tuple[Curves, NDArray[np.float64] | None]:
    """Hairs with their colours, and these at their stations, or one for each hair; None for hairs without any."""
    if not isinstance(hairs, JoinedHairs):
        curves = hair_colors(groom, _stations(hairs.curves))
        return curves, curve_reflectance(curves, "hairs")
    each = [hair_colors(one, _stations(hairs.members[name].curves)) for name, one in grooms_of(groom).items()]
    curves = Curves.joined([replace(one, ids=one.ids + k * IDS_PER_GROOM) for k, one in enumerate(each)], WITHOUT)
    return curves, curve_reflectance(curves, "hairs")


def _stations(hairs: Curves) -> Curves:
    """Hairs with as few points as colours need, without positions."""
    count = len(hairs)
    offsets = offsets_from_counts(np.full(count, STATIONS))
    return Curves(np.empty((count * STATIONS, 0)), offsets, hairs.ids, {"lock": hairs.curve["lock"]})


def _at_stations(curves: Curves, colors: NDArray[np.float64] | None) -> NDArray[np.float64] | None:
    """Colours at the stations of curves of any point counts, from those of their points; one colour a curve stays."""
    if colors is None or len(colors) == len(curves):
        return colors
    u = np.linspace(0.0, 1.0, STATIONS)
    rows = curves.offsets[:-1, None] + np.rint(u * (curves.counts[:, None] - 1)).astype(np.int64)
    return colors[rows.ravel()]
