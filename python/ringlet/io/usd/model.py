"""What makes ``/groom`` a model that pipelines find: its kind, its name as an asset, and the extents below it."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable

from pxr import Kind, Usd, UsdGeom

GROOM_API, CURVES_API, WORN_API, HAIRS_API = (f"Ringlet{name}API" for name in ("Groom", "Curves", "Worn", "Hairs"))


def make_model(root: Usd.Prim, recipe: str | None = None) -> None:
    """Gives the prim ``/groom`` a kind, and the name of its recipe as that of the asset.

    It is a component, or an assembly where it holds a head that is a model of its own.
    """
    model = Usd.ModelAPI(root)
    inner = any(Usd.ModelAPI(child).IsModel() or _is_model(child) for child in root.GetChildren())
    model.SetKind(Kind.Tokens.assembly if inner else Kind.Tokens.component)
    name = tomllib.loads(recipe).get("name") if recipe else None
    model.SetAssetName(name if isinstance(name, str) and name else root.GetName())


def _is_model(prim: Usd.Prim) -> bool:
    """Whether a kind of models is authored on a prim; it counts only once the prims above it have one."""
    return Kind.Registry.IsA(Usd.ModelAPI(prim).GetKind(), Kind.Tokens.model)


def set_extents_hint(root: Usd.Prim, frames: Iterable[float] = ()) -> None:
    """Writes the bounds of all that is below a model, for each purpose: at rest, and at frames."""
    model = UsdGeom.ModelAPI.Apply(root)
    purposes = [UsdGeom.Tokens.default_, UsdGeom.Tokens.proxy, UsdGeom.Tokens.render, UsdGeom.Tokens.guide]
    for time in (Usd.TimeCode.Default(), *(Usd.TimeCode(frame) for frame in frames)):
        bounds = UsdGeom.BBoxCache(time, purposes, useExtentsHint=False)
        model.SetExtentsHint(model.ComputeExtentsHint(bounds), time)
