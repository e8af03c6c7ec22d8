"""A groom file that strands or hairs cannot be made of is refused in one line, with the place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from commands import refused, run
from pxr import Usd, UsdGeom, Vt
from ringlet.data.curves import Curves

from ringlet import UserError


def coincide(folder: Path) -> None:
    stage = Usd.Stage.Open(str(folder / "groom.usdc"))
    attribute = UsdGeom.BasisCurves(stage.GetPrimAtPath("/groom/locks")).GetPointsAttr()
    points = np.array(attribute.Get())
    points[5] = points[4]
    attribute.Set(Vt.Vec3fArray.FromNumpy(points))
    stage.Save()


def remove(name: str):
    def spoil(folder: Path) -> None:
        stage = Usd.Stage.Open(str(folder / "groom.usdc"))
        for prim in ("/groom/locks", "/groom/guides"):
            assert stage.GetPrimAtPath(prim).RemoveProperty(name)
        stage.Save()

    return spoil


def empty_region(folder: Path) -> None:
    stage = Usd.Stage.Open(str(folder / "head.usda"))
    UsdGeom.Subset(stage.GetPrimAtPath("/ball/skin/scalp")).GetIndicesAttr().Set(Vt.IntArray())
    stage.Save()


def flatten(folder: Path) -> None:
    stage = Usd.Stage.Open(str(folder / "head.usda"))
    attribute = UsdGeom.Mesh(stage.GetPrimAtPath("/ball/skin")).GetPointsAttr()
    attribute.Set(Vt.Vec3fArray(len(attribute.Get())))
    stage.Save()


@pytest.fixture
def groomed(copy):
    assert run("groom", copy / "small.recipe.toml", "-o", copy / "groom.usdc").exit_code == 0
    return copy


@pytest.mark.parametrize(
    ("spoil", "command", "words"),
    [
        (coincide, "sim", ["points 4 and 5 of curve", "coincide at (", "m; move them apart"]),
        (coincide, "loft", ["points 4 and 5 of curve", "coincide"]),
        (remove("ringlet:id"), "sim", ["/groom/guides", "ringlet:id"]),
        (remove("primvars:ringlet:root_triangle"), "hair", ["not bound", "make the groom again"]),
        (remove("ringlet:root_barycentric"), "hair", ["not bound", "make the groom again"]),
        (empty_region, "hair", ["region 'scalp'", "no faces"]),
        (flatten, "hair", ["head.usda", "roots are off the scalp", "make the groom again"]),
    ],
)
def test_a_groom_file_without_strands_is_refused(groomed, spoil, command, words):
    spoil(groomed)
    if command == "hair":
        result = run("hair", groomed / "groom.usdc", "-o", groomed / "out.usdc")
    else:
        result = run(
            command, groomed / "small.shot.toml", "--groom", groomed / "groom.usdc", "-o", groomed / "out.usdc"
        )
    refused(result, *words)
    assert not (groomed / "out.usdc").exists()


def test_strands_name_the_curve_that_is_too_short_or_has_coincident_points():
    line = np.linspace(0, 1, 5)[:, None] * [0.0, 0.1, 0.0]
    with pytest.raises(UserError, match=r"here: curve 8 has 2 points; must have at least 3"):
        Curves.from_list([line, line[:2]], ids=[7, 8]).check_strands("here")
    again = line[[0, 1, 2, 2, 4]]
    with pytest.raises(UserError, match=r"here: points 2 and 3 of curve 8 coincide at \(0, 0.05, 0\) m"):
        Curves.from_list([line, again], ids=[7, 8]).check_strands("here")
    Curves.from_list([line, line], ids=[7, 8]).check_strands("here")  # one may begin where the other ends
    Curves.from_list([line, line[::-1]], ids=[7, 8]).check_strands("here")
