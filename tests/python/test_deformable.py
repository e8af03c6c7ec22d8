"""``ringlet convert --deformable``: locks as elastic rods of the AOUSD proposal, and as Newton imports them."""

from __future__ import annotations

import importlib.util
import warnings

import numpy as np
import pytest
from commands import refused, run
from pxr import Usd, UsdGeom, UsdPhysics, UsdShade
from ringlet.io import read_groom, write_groom
from usd_scenes import make_groom, write_head

from ringlet import Material, convert

SHOT = """ringlet = 2
groom = "groom.usdc"
frames = [1, 4]

[strands]
radius = 5e-5
density = 1200.0
twist_ratio = 0.5
"""
MATERIAL = Material(radius=5e-5, density=1200.0, twist_ratio=0.5)


@pytest.fixture
def groom(tmp_path):
    """Five locks of seven points on a cube of 0.1 m, in centimetres."""
    write_groom(make_groom(write_head(tmp_path / "head.usdc")), tmp_path / "groom.usdc")
    (tmp_path / "a.shot.toml").write_text(SHOT)
    return tmp_path / "groom.usdc"


@pytest.fixture(params=[1.0, 0.01], ids=["m", "cm"])
def rods(groom, tmp_path, request):
    convert(groom, tmp_path / "rods.usdc", deformable=tmp_path / "a.shot.toml", unit=request.param)
    return tmp_path / "rods.usdc"


def physics(prim, name):
    return prim.GetAttribute(f"physics:{name}").Get()


def test_locks_are_linear_rods_with_the_stiffnesses_of_the_shot(rods, groom):
    stage = Usd.Stage.Open(str(rods))
    unit, prim = UsdGeom.GetStageMetersPerUnit(stage), stage.GetPrimAtPath("/groom/guides")
    locks = read_groom(groom).locks
    assert {"PhysicsDeformableBodyAPI", "PhysicsCurvesDeformableSimAPI"} <= set(
        prim.GetPrimTypeInfo().GetAppliedAPISchemas()
    )
    curves = UsdGeom.BasisCurves(prim)
    assert (curves.GetTypeAttr().Get(), list(curves.GetCurveVertexCountsAttr().Get())) == ("linear", [7] * 5)
    np.testing.assert_allclose(np.array(curves.GetPointsAttr().Get()) * unit, locks.points, atol=1e-7)
    assert physics(prim, "restShapePoints") == curves.GetPointsAttr().Get()
    np.testing.assert_allclose(np.array(physics(prim, "thicknesses")) * unit, [1e-4], rtol=1e-6)

    material, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial("physics")
    force, area = 1.0 / unit, np.pi * 5e-5**2  # 1 N and 1 N m² in kilograms, seconds and the unit of the stage
    bend = MATERIAL.youngs_modulus * area * 5e-5**2 / 4
    expected = {
        "curvesStretchStiffness": MATERIAL.stretch_scale * MATERIAL.youngs_modulus * area * force,
        "curvesBendStiffness": bend * force / unit**2,
        "curvesTwistStiffness": 0.5 * bend * force / unit**2,
        "density": 1200.0 * unit**3,
    }
    for name, value in expected.items():
        assert physics(material.GetPrim(), name) == pytest.approx(value, rel=1e-6), name


def test_roots_are_fixed_and_the_head_is_a_collider(rods, groom):
    stage = Usd.Stage.Open(str(rods))
    roots, unit = stage.GetPrimAtPath("/groom/guides_roots"), UsdGeom.GetStageMetersPerUnit(stage)
    rows = np.array(physics(roots, "indices0"))
    np.testing.assert_array_equal(rows, [row for first in range(0, 35, 7) for row in (first, first + 1)])
    places = np.array(physics(roots, "coords1")) * unit
    np.testing.assert_allclose(places, read_groom(groom).locks.points[rows], atol=1e-7)
    assert UsdPhysics.CollisionAPI(stage.GetPrimAtPath("/groom/skin")).GetCollisionEnabledAttr().Get()


@pytest.mark.parametrize(
    ("target", "options", "words"),
    [
        ("rods.abc", [], "must be a .usdc"),
        ("rods.usdc", ["--frames", "1:2"], "leave them out"),
        ("rods.usdc", ["--deformable", "none.shot.toml"], "none.shot.toml"),
    ],
)
def test_rods_that_cannot_be_written_are_refused(groom, tmp_path, target, options, words):
    shot = [] if "--deformable" in options else ["--deformable", str(tmp_path / "a.shot.toml")]
    refused(run("convert", groom, tmp_path / target, *shot, *options), words)
    assert not (tmp_path / target).exists()


@pytest.fixture
def newton():
    if any(importlib.util.find_spec(name) is None for name in ("newton", "newton_usd_schemas")):
        pytest.skip("newton is not installed: pip install newton newton-usd-schemas")
    return importlib.import_module("newton")


def test_newton_imports_a_rod_for_each_lock_with_its_mass_and_stiffness(newton, groom, tmp_path):
    convert(groom, tmp_path / "rods.usdc", deformable=tmp_path / "a.shot.toml")
    builder = newton.ModelBuilder()
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        imported = builder.add_usd(str(tmp_path / "rods.usdc"), return_deformable_results=True)
    # The rods of one prim are floating bodies to Newton before the joints of their roots are added.
    assert [str(one.message) for one in said if "FREE joint" not in str(one.message)] == []

    locks = read_groom(groom).locks
    bodies, _ = imported["path_cable_map"]["/groom/guides"]
    assert len(bodies) == len(locks.points) - len(locks)
    assert len(imported["path_attachment_map"]["/groom/guides_roots"]) == 2 * len(locks)
    assert len(imported["path_shape_map"]) == 1  # the head
    lengths = np.linalg.norm(np.diff(locks.points.reshape(5, 7, 3), axis=1), axis=2)
    masses = np.array(builder.body_mass)[list(bodies)]
    np.testing.assert_allclose(masses, 1200.0 * np.pi * 5e-5**2 * lengths.ravel(), rtol=1e-4)
