"""Curves from USD of every type, basis and wrap, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from pxr import Gf, Sdf, UsdGeom, Vt
from ringlet.io import read_curves
from usd_scenes import new_stage

from ringlet import UserError


def write(path, counts, points, kind="cubic", basis="bezier", wrap="nonperiodic", *, unit=1.0, axis="Y"):
    stage = new_stage(path, unit=unit, axis=axis)
    curves = UsdGeom.BasisCurves.Define(stage, "/head/hair")
    curves.CreateTypeAttr(kind)
    curves.CreateBasisAttr(basis)
    curves.CreateWrapAttr(wrap)
    curves.CreateCurveVertexCountsAttr(counts)
    curves.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(np.asarray(points, np.float32)))
    stage.Save()
    return stage, curves


def cubic(t):
    """A cubic polynomial curve over t in [0, 3]."""
    t = np.asarray(t, float)
    return np.stack([t, t**2 / 4, t**3 / 8 - t], axis=-1)


def bezier_controls():
    """Control points of three Bézier segments of the cubic."""
    derivative = lambda t: np.stack([1.0, t / 2, 3 * t**2 / 8 - 1], axis=-1)  # noqa: E731
    rows = [cubic(0.0)]
    for t in (0.0, 1.0, 2.0):
        rows += [cubic(t) + derivative(t) / 3, cubic(t + 1) - derivative(t + 1) / 3, cubic(t + 1)]
    return np.array(rows)


def bspline_controls():
    """Control points of a uniform cubic B-spline of the cubic: its blossom at three successive knots."""
    blossom = lambda a, b, c: np.array([(a + b + c) / 3, (a * b + b * c + a * c) / 12, a * b * c / 8 - (a + b + c) / 3])  # noqa: E731
    return np.array([blossom(k - 1.0, float(k), k + 1.0) for k in range(-1, 5)])


def on_cubic(points):
    return np.abs(points - cubic(points[:, 0])).max()


def primvar(curves, name, interpolation):
    return UsdGeom.PrimvarsAPI(curves).CreatePrimvar(name, Sdf.ValueTypeNames.FloatArray, interpolation)


@pytest.mark.parametrize("basis", ["bezier", "bspline"])
def test_cubic_curves_are_evaluated_exactly(tmp_path, basis):
    controls = bezier_controls() if basis == "bezier" else bspline_controls()
    write(tmp_path / "a.usda", [len(controls)] * 2, np.concatenate([controls, controls]), basis=basis)
    curves = read_curves(tmp_path / "a.usda")
    for curve in curves:
        assert len(curve) > 12
        assert on_cubic(curve) < 1e-6
        np.testing.assert_allclose(curve[[0, -1]], cubic([0.0, 3.0]), atol=1e-6)


def test_catmull_rom_curves_go_through_their_inner_vertices(tmp_path):
    vertices = cubic(np.arange(5.0))
    write(tmp_path / "a.usda", [5], vertices, basis="catmullRom")
    (curve,) = read_curves(tmp_path / "a.usda")
    np.testing.assert_allclose(curve[[0, 6, 12]], vertices[1:4], atol=1e-6)
    middle = (-vertices[0] + 9 * vertices[1] + 9 * vertices[2] - vertices[3]) / 16
    np.testing.assert_allclose(curve[3], middle, atol=1e-6)


def test_pinned_catmull_rom_and_linear_curves_keep_their_vertices(tmp_path):
    vertices = np.random.default_rng(0).random((9, 3))
    for kind, basis, wrap in (
        ("cubic", "catmullRom", "pinned"),
        ("linear", "bezier", "nonperiodic"),
        ("linear", "bspline", "pinned"),
    ):
        write(tmp_path / f"{kind}{wrap}.usda", [5, 4], vertices, kind, basis, wrap)
        curves = read_curves(tmp_path / f"{kind}{wrap}.usda")
        np.testing.assert_array_equal(curves.offsets, [0, 5, 9])
        np.testing.assert_allclose(curves.points, vertices, atol=1e-7)


def test_pinned_b_splines_reach_their_end_vertices(tmp_path):
    vertices = np.random.default_rng(1).random((9, 3))
    write(tmp_path / "a.usda", [5, 4], vertices, "cubic", "bspline", "pinned")
    curves = read_curves(tmp_path / "a.usda")
    np.testing.assert_allclose(curves[0][[0, -1]], vertices[[0, 4]], atol=1e-6)
    np.testing.assert_allclose(curves[1][[0, -1]], vertices[[5, 8]], atol=1e-6)
    np.testing.assert_allclose(curves[0][6], (vertices[0] + 4 * vertices[1] + vertices[2]) / 6, atol=1e-6)


def test_curves_are_read_in_metres_with_y_up_and_their_transform(tmp_path):
    stage, curves = write(tmp_path / "a.usda", [2], [[0, 0, 0], [0, 0, 10]], "linear", unit=0.01, axis="Z")
    curves.AddTranslateOp().Set(Gf.Vec3d(5, 0, 0))
    stage.Save()
    np.testing.assert_allclose(read_curves(tmp_path / "a.usda").points, [[0.05, 0, 0], [0.05, 0.1, 0]], atol=1e-9)


def test_names_widths_and_primvars_are_read(tmp_path):
    stage, curves = write(tmp_path / "a.usda", [4, 4], np.random.default_rng(2).random((8, 3)), unit=0.01)
    api = UsdGeom.PrimvarsAPI(curves)
    types = Sdf.ValueTypeNames
    api.CreatePrimvar("groom_id", types.IntArray, "uniform").Set([41, 7])
    api.CreatePrimvar("clumpid", types.IntArray, "uniform").Set([1, 1])
    primvar(curves, "along", "varying").Set([0, 1, 0, 2])
    primvar(curves, "stiff", "vertex").Set([3] * 8)
    curves.CreateWidthsAttr([0.02])
    curves.SetWidthsInterpolation(UsdGeom.Tokens.constant)
    stage.Save()
    read = read_curves(tmp_path / "a.usda")
    np.testing.assert_array_equal(read.ids, [41, 7])
    np.testing.assert_array_equal(read.curve["clumpid"], [1, 1])
    np.testing.assert_allclose(read.curve["width"], 0.0002)
    np.testing.assert_allclose(read.point["stiff"], 3)
    np.testing.assert_allclose(read.point["along"], np.concatenate([np.linspace(0, 1, 7), np.linspace(0, 2, 7)]))


def only_sampled(attribute, first, second):
    """Replaces the default value of an attribute by two time samples."""
    attribute.Clear()
    attribute.Set(first, 1)
    attribute.Set(second, 2)


def test_the_first_sample_is_the_value_of_an_attribute_without_default(tmp_path):
    """Points have a default here; each other attribute has samples alone."""
    points = np.random.default_rng(2).random((8, 3))
    stage, curves = write(tmp_path / "a.usda", [4, 4], points, "linear", unit=0.01)
    curves.CreateWidthsAttr()
    curves.SetWidthsInterpolation(UsdGeom.Tokens.vertex)
    only_sampled(curves.GetWidthsAttr(), [0.1] * 8, [0.2] * 8)
    only_sampled(curves.GetCurveVertexCountsAttr(), [4, 4], [5, 3])
    only_sampled(primvar(curves, "stiff", "uniform").GetAttr(), [3.0, 4.0], [5.0, 5.0])
    indexed = primvar(curves, "part", "uniform")
    indexed.Set([7.0, 8.0])
    indexed.SetIndices([1, 0])
    only_sampled(indexed.GetIndicesAttr(), [1, 0], [0, 0])
    stage.Save()
    notes = []
    read = read_curves(tmp_path / "a.usda", notes=notes)
    np.testing.assert_allclose(read.points, 0.01 * points, atol=1e-9)
    np.testing.assert_array_equal(read.offsets, [0, 4, 8])
    np.testing.assert_allclose(read.point["width"], 0.001)
    np.testing.assert_array_equal(read.curve["stiff"], [3, 4])
    np.testing.assert_array_equal(read.curve["part"], [8, 7])
    assert len(notes) == 1 and "curveVertexCounts change over time" in notes[0]


def test_curves_with_samples_alone_are_those_of_the_first_sample(tmp_path):
    points = np.random.default_rng(2).random((8, 3)).astype(np.float32)
    stage, curves = write(tmp_path / "a.usda", [4, 4], points, "linear", unit=1.0)
    only_sampled(curves.GetPointsAttr(), points, 2 * points)
    curves.CreateWidthsAttr([0.1] * 8).Set([0.3] * 8, 1)
    curves.SetWidthsInterpolation(UsdGeom.Tokens.vertex)
    stage.Save()
    read = read_curves(tmp_path / "a.usda")
    np.testing.assert_allclose(read.points, points)
    np.testing.assert_allclose(read.point["width"], 0.3)  # of the same time as the points


@pytest.mark.parametrize("both", [False, True])
def test_the_primvar_widths_has_precedence_and_is_scaled_with_the_points(tmp_path, both):
    stage, curves = write(tmp_path / "a.usda", [4, 4], np.random.default_rng(2).random((8, 3)), "linear", unit=0.01)
    curves.AddScaleOp().Set(Gf.Vec3f(10))
    if both:
        curves.CreateWidthsAttr([1.0])
        curves.SetWidthsInterpolation(UsdGeom.Tokens.constant)
    primvar(curves, "widths", "uniform").Set([0.02, 0.04])
    stage.Save()
    read = read_curves(tmp_path / "a.usda")
    np.testing.assert_allclose(read.curve["width"], [0.002, 0.004])
    assert "widths" not in read.curve


@pytest.mark.parametrize("twin", [False, True])
def test_normals_of_curves_are_reported_as_unused(tmp_path, twin):
    stage, curves = write(tmp_path / "a.usda", [4, 4], np.random.default_rng(2).random((8, 3)), "linear")
    values = [Gf.Vec3f(0, 1, 0)] * 8
    if twin:
        UsdGeom.PrimvarsAPI(curves).CreatePrimvar("normals", Sdf.ValueTypeNames.Normal3fArray, "vertex").Set(values)
    else:
        curves.CreateNormalsAttr(values)
    stage.Save()
    notes = []
    assert "normals" not in read_curves(tmp_path / "a.usda", notes=notes).point
    (note,) = notes
    assert "a.usda /" in note and "normals are not used" in note


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda c: c.CreateWrapAttr("periodic"), "wrap is periodic"),
        (lambda c: c.CreateBasisAttr("hermite"), "basis is hermite; must be bezier, bspline or catmullRom"),
        (lambda c: c.CreateCurveVertexCountsAttr([4, 5]), "add up to 9, but there are 8 points"),
        (
            lambda c: c.CreateCurveVertexCountsAttr([5, 3]),
            "curve 0 has 5 points; nonperiodic bezier curves must have 4, 7, 10",
        ),
        (lambda c: c.CreateCurveVertexCountsAttr([7, 1]), "curve 1 has 1 point"),
        (lambda c: c.CreateCurveVertexCountsAttr([]), "there are no curves"),
        (lambda c: c.CreateCurveVertexCountsAttr([12, -4]), "curve 1 has -4 point"),
        (lambda c: c.CreatePointsAttr([]), "has no points"),
        (lambda c: c.CreatePointsAttr([Gf.Vec3f(float("nan"), 0, 0)] * 8), "point 0 is .*; must be finite"),
        (lambda c: c.CreatePointsAttr([Gf.Vec3f(1, 1, 1)] * 8), "curve 0 has length 0"),
        (
            lambda c: (
                UsdGeom.PrimvarsAPI(c).CreatePrimvar("a", Sdf.ValueTypeNames.FloatArray, "vertex").Set([1.0, 2.0])
            ),
            "primvars:a has 2 values; must have 8",
        ),
        (
            lambda c: (c.CreateWidthsAttr([1.0, 2.0]), c.SetWidthsInterpolation("constant")),
            "widths has 2 values; must have 1, being constant",
        ),
    ],
)
def test_broken_curves_are_refused_in_one_line(tmp_path, change, message):
    stage, curves = write(tmp_path / "a.usda", [4, 4], np.random.default_rng(2).random((8, 3)))
    change(curves)
    stage.Save()
    with pytest.raises(UserError, match=message) as caught:
        read_curves(tmp_path / "a.usda")
    assert "a.usda" in str(caught.value) and "\n" not in str(caught.value)
