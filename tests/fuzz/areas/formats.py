"""Curves that pass through a format come back, or what is lost is reported."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from judged import same
from numpy.random import Generator
from pxr import Usd, UsdGeom, Vt
from ringlet.io import read_curves

import ringlet
from ringlet import Curves


def attempt(random: Generator, folder: Path) -> None:
    suffix = str(random.choice([".abc", ".hair", ".tfx", ".obj", ".usda", ".usdc"]))
    unit = float(random.choice([1.0, 0.01, 0.001, 0.0254]))
    up = str(random.choice(["Y", "Z"]))
    stage = Usd.Stage.CreateNew(str(folder / "a.usda"))
    UsdGeom.SetStageMetersPerUnit(stage, unit)
    UsdGeom.SetStageUpAxis(stage, up)
    curves = UsdGeom.BasisCurves.Define(stage, "/hair")
    stage.SetDefaultPrim(curves.GetPrim())
    even = random.random() < 0.4
    counts = (
        np.full(random.integers(1, 12), random.choice([4, 8, 16, 32]))
        if even
        else random.integers(2, 40, random.integers(1, 12))
    )
    points = (random.normal(0, 0.2, (counts.sum(), 3)) + random.uniform(-1, 1, 3)) / unit
    curves.CreateTypeAttr("linear")
    curves.CreateCurveVertexCountsAttr(counts.tolist())
    curves.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(points.astype(np.float32)))
    kinds = {"constant": 1, "uniform": len(counts), "vertex": counts.sum()}
    kind = str(random.choice(list(kinds)))
    curves.CreateWidthsAttr((1e-4 / unit * random.uniform(0.5, 2.0, kinds[kind])).tolist())
    curves.SetWidthsInterpolation(kind)
    stage.Save()
    report = ringlet.convert(folder / "a.usda", folder / f"b{suffix}")
    space = {} if suffix.startswith(".usd") else {"source_unit": report["unit"], "source_up": report["up"]}
    ringlet.convert(folder / f"b{suffix}", folder / "c.usdc", **space)
    before, after = (read_curves(folder / name) for name in ("a.usda", "c.usdc"))
    lost = " ".join(report["lost"])
    if len(after) != len(before) or (after.counts != before.counts).any():
        assert "point" in lost, f"{suffix}: counts changed, lost: {lost}"
        return
    same(after.points, before.points, 2e-6 * np.abs(before.points).max(), f"{suffix} points")
    if "width" not in lost:
        wide, was = (_widths(of) for of in (after, before))
        same(wide, was, 2e-3 * was.max(), f"{suffix} widths")


def _widths(curves: Curves) -> np.ndarray:
    """Width at each point [m]; nan where there is none."""
    of_curve = curves.curve.get("width", np.full(len(curves), np.nan))
    return curves.point.get("width", np.repeat(of_curve, curves.counts))
