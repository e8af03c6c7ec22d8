"""A head of another unit and axis, with unused points, has the same groom; one of another winding, none inside."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import small_example
from judged import check_curves, same
from numpy.random import Generator
from pxr import Usd, UsdGeom, Vt
from random_recipe import Settings
from ringlet.data.toml import to_toml

import ringlet


def attempt(random: Generator, folder: Path) -> None:
    recipe = to_toml(Settings(random, "recipe").recipe(1) | {"scalp": {"file": "head.usda", "region": "scalp"}})
    grooms = []
    kinds = random.permutation(["flat faces", "turned", "left handed", "unused"])[: random.integers(3)]
    units = (0.01, float(random.choice([1.0, 0.001, 0.0254, 0.1])))
    for place, (unit, up) in enumerate(zip(units, ("Y", str(random.choice(["Y", "Z"]))), strict=True)):
        here = folder / str(place)
        here.mkdir()
        small_example.write_head(here / "head.usda", unit=unit, up=up)
        (here / "r.recipe.toml").write_text(recipe)
        if place == 1:
            for kind in kinds:
                _spoil(here / "head.usda", str(kind))
        grooms.append(ringlet.build_groom(here / "r.recipe.toml"))
    first, other = grooms
    check_curves(other.locks, other.scalp, "locks")
    inside = [np.linalg.norm(of.locks.points.astype(float), axis=1).min() < 0.085 for of in grooms]
    assert inside[0] or not inside[1] or other.conflicts, "hair inside"
    for name in ("guides", "locks"):
        counts = [len(getattr(of, name)) for of in grooms]
        assert counts[0] == counts[1], f"{counts[1]} {name} instead of {counts[0]}"
    # Points of a file are single: those of another unit differ by 4e-9 m, which decides among samples of equal worth.
    if not set(kinds) & {"turned", "flat faces"} and np.array_equal(other.guides.ids, first.guides.ids):
        _, rows, others = np.intersect1d(first.locks.ids, other.locks.ids, return_indices=True)
        found, wanted = (of.locks.take(which).points for of, which in ((other, others), (first, rows)))
        same(found, wanted, 2e-6, f"unit and axis, {', '.join(kinds)}")


def _spoil(path: Path, kind: str) -> None:
    """Changes a head in a way that leaves its surface as it is."""
    stage = Usd.Stage.Open(str(path))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/ball/skin"))
    points = np.array(mesh.GetPointsAttr().Get())
    counts, corners = (np.array(of.Get()) for of in (mesh.GetFaceVertexCountsAttr(), mesh.GetFaceVertexIndicesAttr()))
    if kind == "turned":
        corners = corners.reshape(-1, 3)[:, ::-1].ravel()
    elif kind == "left handed":
        corners = corners.reshape(-1, 3)[:, [0, 2, 1]].ravel()
        left = mesh.GetOrientationAttr().Get() == "leftHanded"
        mesh.CreateOrientationAttr("rightHanded" if left else "leftHanded")
    elif kind == "unused":
        points = np.concatenate([points, points[:1] * 3.0])
    elif kind == "flat faces":
        counts, corners = np.append(counts, 3), np.append(corners, [0, 0, 1])
    mesh.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(points.astype(np.float32)))
    mesh.GetFaceVertexCountsAttr().Set(counts.tolist())
    mesh.GetFaceVertexIndicesAttr().Set(corners.tolist())
    stage.Save()
