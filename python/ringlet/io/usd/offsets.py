"""Offsets of adopted hairs from their locks: one prim with an array for each quantity."""

from __future__ import annotations

from math import prod
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Usd, UsdGeom

from ringlet.data.errors import UserError
from ringlet.data.groom import HairOffsets
from ringlet.data.stage import StageSpace
from ringlet.io.usd.stage import new_stage, reading, writing
from ringlet.io.usd.values import Types, to_usd

NAME = "offsets"  # of the prim below /groom
ROWS: dict[str, tuple[int, ...]] = {"across": (2,), "width": ()}  # arrays with several rows a hair; shape of a row
PREFIX = "ringlet:offsets:"


def define_offsets(stage: Usd.Stage, path: str, offsets: HairOffsets) -> None:
    """Writes offsets to a prim [m], whatever the unit of the stage."""
    prim = UsdGeom.Scope.Define(stage, path).GetPrim()
    _set(prim, "root_falloff", Types.Float, offsets.root_falloff)
    for name, values in vars(offsets).items():
        if isinstance(values, np.ndarray):
            kind, value = to_usd(values.reshape(-1, *ROWS[name]) if name in ROWS else values)
            _set(prim, name, kind, value)


def offsets_at(prim: Usd.Prim, where: str) -> HairOffsets:
    """Reads offsets from a prim; raises UserError for missing arrays and for those that do not fit one another."""
    found: dict[str, NDArray] = {}
    for name in ("lock", "tip", "across", "width", "root_triangle", "root_barycentric"):
        attribute = prim.GetAttribute(PREFIX + name)
        value = attribute.Get() if attribute else None
        if value is None:
            raise UserError(f"{where}: has no {PREFIX}{name}; adopt the hair again")
        found[name] = np.array(value)
    count = max(len(found["lock"]), 1)
    for name, row in ROWS.items():
        if found[name].size % (count * prod(row)):
            raise UserError(f"{where}: {PREFIX}{name} does not fit its {count} hairs; adopt the hair again")
        found[name] = found[name].reshape(count, -1, *row)
    named = (prim.GetAttribute(PREFIX + name) for name in ("root_falloff", "gather"))  # the second is its former name
    falloff = next((float(attribute.Get()) for attribute in named if attribute), 0.0)
    return HairOffsets(**found, root_falloff=falloff).check(where)


def write_offsets(offsets: HairOffsets, path: Path | str) -> None:
    """Writes a file of offsets."""
    with writing(path) as aside:
        stage = new_stage(aside, StageSpace())
        UsdGeom.Xform.Define(stage, "/groom")
        define_offsets(stage, f"/groom/{NAME}", offsets)
        stage.Save()


def read_offsets(path: Path | str) -> HairOffsets:
    """Reads a file of offsets; raises UserError for another file."""
    with reading(path) as source:
        prim = source.stage.GetPrimAtPath(f"/groom/{NAME}")
        if not prim:
            raise UserError(f"{path}: holds no offsets of hairs; make it with: ringlet adopt HAIR -o RECIPE.toml")
        return offsets_at(prim, source.where(prim))


def _set(prim: Usd.Prim, name: str, kind: Sdf.ValueTypeName, value: object) -> None:
    attribute = prim.CreateAttribute(PREFIX + name, kind, custom=True, variability=Sdf.VariabilityUniform)
    attribute.Set(value)
