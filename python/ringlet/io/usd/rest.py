"""A rest shape as USD: ``/groom/locks`` as strands remember it, with what it was made from."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from pxr import Usd, UsdGeom

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.stage import StageSpace
from ringlet.io.usd.curves import define_curves, own_curves, set_points
from ringlet.io.usd.groom import GROOM, LOCKS, VERSION, check_version
from ringlet.io.usd.stage import new_stage, parse_json, reading, writing


def write_rest(rest: Curves, made_from: dict[str, Any], path: Path | str, space: StageSpace) -> None:
    """Writes a rest shape and the settings that it was made from, as plain values."""
    with writing(path) as aside:
        stage = new_stage(aside, space)
        UsdGeom.Xform.Define(stage, GROOM)
        set_points(define_curves(stage, LOCKS, rest, space, guide=True), rest.points, space, Usd.TimeCode.Default())
        kept = {"version": VERSION, "made_from": json.dumps(made_from, sort_keys=True)}
        stage.GetRootLayer().customLayerData = {"ringlet": kept}
        stage.Save()


def read_rest(path: Path | str) -> tuple[Curves, dict[str, Any]]:
    """Reads a rest shape and the settings that it was made from."""
    with reading(path) as source:
        told = source.stage.GetRootLayer().customLayerData.get("ringlet") or {}
        check_version(source, told.get("version", VERSION))
        made_from = told.get("made_from")
        prim = source.stage.GetPrimAtPath(LOCKS)
        if made_from is None or not prim:
            raise UserError(f"{path}: is no lofted shape; make one with: ringlet loft SHOT.toml")
        rest = own_curves(source, prim).check(source.where(prim))
        return rest, parse_json(source, made_from, "ringlet:made_from")
