"""The bounds of attributes of curves and meshes: numbers are finite, and those with a meaning are within its range."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ringlet.data import limits
from ringlet.data.errors import UserError

SIZE, PART, COLOR = (0.0, np.inf), (0.0, 1.0), (0.0, limits.FARTHEST)
BOUNDS = {
    "width": SIZE,
    "strand_radius": SIZE,
    "pin": PART,
    "tied": PART,
    "displayOpacity": PART,
    "displayColor": COLOR,
    "groom_color": COLOR,
    "color": COLOR,
}
OTHERS = (-limits.FARTHEST, limits.FARTHEST)
ONE_NUMBER = {"width", "strand_radius", "pin", "tied"}  # attributes without several numbers a row


def check_attribute(name: str, values: NDArray, what: str, rows: str, place: Callable[[int], str]) -> None:
    """Refuses numbers that are not finite or out of range; texts pass.

    what:  the curves or the mesh, for the message
    rows:  what has a row of values: ``curve``, ``point``
    place: gives the name of a row
    """
    values = np.asarray(values)
    if name in ONE_NUMBER and (values.dtype.kind not in "biuf" or values.ndim != 1):
        raise UserError(f"{what}: {name} is not one number for each {rows}; write it again")
    if values.dtype.kind not in "biuf" or (name not in BOUNDS and values.dtype.kind != "f"):
        return
    least, most = BOUNDS.get(name, OTHERS)
    bad = np.argwhere(~(np.isfinite(values) & (values >= least) & (values <= most)))
    if len(bad):
        value, bound = values[tuple(bad[0])], f"from {least:g} to {most:g}"
        bound = bound if np.isfinite(most) else f"at least {least:g} and finite"
        raise UserError(f"{what}: {name} is {value:g} on {place(int(bad[0, 0]))}; must be {bound}")


def fits(values: NDArray, row: tuple[int, ...]) -> bool:
    """Whether an attribute has numbers in rows of a shape, such as (3,)."""
    return values.dtype.kind in "biuf" and values.shape[1:] == row
