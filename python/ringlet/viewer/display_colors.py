"""Colours of hairs for display: the reflectance by their pigments, at few places along each hair."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.digest import digest
from ringlet.data.groom import Groom
from ringlet.data.pigment import (
    DYE,
    DYE_AMOUNT,
    FIBER,
    GRAY,
    MELANIN,
    REDNESS,
    ROUGHNESS,
    TILT,
    curve_reflectance,
    of_fiber,
)
from ringlet.groom import Hairs, hair_colors
from ringlet.viewer import protocol
from ringlet.viewer.display_groom import shuffled_order, spread_order
from ringlet.viewer.wire import pack

STATIONS = 24  # of a hair whose colour varies along it


def inputs(groom: Groom) -> str:
    """Digest of what the colours of hairs depend on, their layout aside."""
    locks, names = groom.locks, (MELANIN, REDNESS, GRAY, DYE, DYE_AMOUNT, *FIBER)
    values = [kind[name] for name in names for kind in (locks.curve, locks.point) if name in kind]
    return digest(groom.color, groom.fiber, *values)


def message(side: str, groom: Groom, hairs: Hairs | None) -> bytes:
    """Message with the colours of hairs, or of the locks where these are the hairs."""
    if hairs is None:
        curves, order = groom.locks, shuffled_order(len(groom.locks))
        colors = _at_stations(curves, curve_reflectance(curves, "hairs"))
    else:
        order = spread_order(offsets_from_counts(np.bincount(hairs.curves.curve["lock"], minlength=len(groom.locks))))
        curves = hair_colors(groom, _stations(hairs.curves))
        colors = curve_reflectance(curves, "hairs")
    stations = 0 if colors is None else len(colors) // max(len(curves), 1)
    values = np.empty(0) if colors is None else colors.reshape(len(curves), stations, 3)[order]
    return pack(
        protocol.Colors.model_validate(
            {
                "side": side,
                "stations": stations,
                "roughness": of_fiber(curves, ROUGHNESS),
                "tilt": of_fiber(curves, TILT),
            }
        ),
        reflectance=np.rint(255.0 * np.sqrt(np.sqrt(values))),
    )


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
