"""Grooms of a host: made of a recipe, as arrays in the unit and axes of its head."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.api.grooms import build_groom, write_groom
from ringlet.api.hairs import build_hairs
from ringlet.api.progress import Progress
from ringlet.data.curves import Curves
from ringlet.data.groom import Groom
from ringlet.data.names import distinct
from ringlet.data.pigment import (
    AZIMUTHAL_ROUGHNESS,
    DEFAULT_COLOR,
    HAIR_COLORS,
    MELANIN,
    REDNESS,
    ROUGHNESS,
    TILT,
    curve_reflectance,
    of_fiber,
)
from ringlet.groom import Memory
from ringlet.host import requests, texts
from ringlet.io.space import from_metres

Arrays = dict[str, NDArray[Any]]


class Groomer:
    """Makes grooms; results of unchanged stages are kept from one to the next, for the folder that was used last."""

    def __init__(self) -> None:
        self._folder: Path | None = None
        self._memory = Memory()

    def make(self, request: requests.Groom, progress: Progress) -> tuple[dict[str, Any], Arrays]:
        """The groom of a recipe, and its hairs where they are asked for."""
        if request.folder != self._folder:
            self._folder, self._memory = request.folder, Memory()
        document = texts.apply("recipe", request.recipe, request.folder)
        groom = build_groom(document.model, progress=progress, memory=self._memory)
        answer: dict[str, Any] = {
            "text": document.text,
            "settings": texts.settings(document.model),
            "conflicts": groom.conflicts,
            "counts": {"guides": len(groom.guides), "locks": len(groom.locks)},
        }
        arrays = _curves("guides", groom.guides, groom) | _curves("locks", groom.locks, groom)
        shown = groom.locks
        if request.hairs is not None:
            made = build_hairs(groom, fraction=request.hairs, wider=True, memory=self._memory)
            shown = made.curves
            arrays |= _curves("hairs", shown, groom)
            answer["counts"]["hairs"] = len(shown)
        usual = HAIR_COLORS[DEFAULT_COLOR]
        answer["fiber"] = {
            ROUGHNESS: of_fiber(shown, ROUGHNESS),
            AZIMUTHAL_ROUGHNESS: of_fiber(shown, AZIMUTHAL_ROUGHNESS),
            TILT: of_fiber(shown, TILT),
            MELANIN: usual.melanin,
            REDNESS: usual.redness,
        }
        return answer, arrays


def _curves(name: str, curves: Curves, groom: Groom) -> Arrays:
    """Arrays of curves: ``points`` (n, 3), ``counts``, ``ids``, ``radius`` of the points, and where there are any
    ``uv`` and ``skinprim`` (the face) of the roots, ``melanin``, ``redness`` and ``color`` (linear), one row a curve or
    a point."""
    unit = groom.space.meters_per_unit
    arrays: Arrays = {
        "points": from_metres(curves.points, groom.space),
        "counts": curves.counts.astype(np.int32),
        "ids": curves.ids,
    }
    if "width" in curves.point:
        arrays["radius"] = (0.5 / unit * curves.point["width"]).astype(np.float32)
    bound = curves.curve
    if groom.scalp.faces is not None and "root_triangle" in bound:
        arrays["skinprim"] = groom.scalp.faces[bound["root_triangle"]].astype(np.int32)
    if groom.scalp.uv is not None and "root_triangle" in bound:
        uv = np.einsum("nk,nkd->nd", bound["root_barycentric"], groom.scalp.uv[bound["root_triangle"]])
        arrays["uv"] = uv.astype(np.float32)
    for pigment in (MELANIN, REDNESS):
        values = curves.point.get(pigment, bound.get(pigment))
        if values is not None:
            arrays[pigment] = values.astype(np.float32)
    if (colors := curve_reflectance(curves, name)) is not None:
        arrays["color"] = colors.astype(np.float32)
    return {f"{name}/{key}": values for key, values in arrays.items()}


def write(request: requests.WriteGroom, progress: Progress) -> dict[str, Any]:
    """Writes the groom of a recipe, with others as its variants, as USD."""
    recipe = texts.apply("recipe", request.recipe, request.folder).model
    made = build_groom(recipe, progress=progress)
    stems = [one.name.removesuffix(".toml").removesuffix(".recipe") for one in request.variants]
    names = distinct(["base", *stems], lambda name: re.sub(r"[^\w-]", "_", name) or "_")[1:]  # as USD takes them
    variants = {
        name: build_groom(texts.apply("recipe", one, request.folder).model, progress=progress)
        for name, one in zip(names, request.variants, strict=True)
    }
    path = request.folder / request.file
    write_groom(made, path, variants=variants)
    return {"path": str(path), "variants": list(variants), "conflicts": made.conflicts}
