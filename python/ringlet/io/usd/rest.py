"""A rest shape as USD: the rest positions of ``/groom/locks``, with the settings that produced them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.stage import StageSpace
from ringlet.io.usd.curves import define_curves, own_curves, set_points
from ringlet.io.usd.groom import GROOM, LOCKS, VERSION, check_version
from ringlet.io.usd.place import Place
from ringlet.io.usd.stage import new_stage, parse_json, reading, writing


def write_rest(
    rest: Curves, made_from: dict[str, Any], path: Path | str, space: StageSpace, around: NDArray | None = None
) -> None:
    """Writes a rest shape and the settings that produced it, as plain values; ``around`` are points of the head [m]."""
    with writing(path) as aside:
        stage = new_stage(aside, space)
        UsdGeom.Xform.Define(stage, GROOM)
        curves = define_curves(stage, LOCKS, rest, space, guide=True)
        set_points(curves, rest.points, Place(curves.GetPrim(), space, path, rest), Usd.TimeCode.Default(), around)
        metadata = {"version": VERSION, "made_from": json.dumps(made_from, sort_keys=True)}
        stage.GetRootLayer().customLayerData = {"ringlet": metadata}
        stage.Save()


def read_rest(path: Path | str) -> tuple[Curves, dict[str, Any]]:
    """Reads a rest shape and the settings that produced it; raises UserError for another file."""
    with reading(path) as source:
        metadata = source.stage.GetRootLayer().customLayerData.get("ringlet") or {}
        check_version(source, metadata.get("version", VERSION))
        made_from = metadata.get("made_from")
        prim = source.stage.GetPrimAtPath(LOCKS)
        if made_from is None or not prim:
            raise UserError(f"{path}: is not a rest shape; make one with: ringlet loft SHOT.toml")
        rest = own_curves(source, prim).check(source.where(prim))
        return rest, parse_json(source, made_from, "ringlet:made_from")
