"""Cloth in files: caches, hairs, heads and refusals."""

import json

import numpy as np
import pytest
from commands import refused, run
from pxr import Gf, Sdf, Usd, UsdGeom, Vt
from small_example import FRAMES, RADIUS, write_example
from wear import SCARF, define, quads, sim, write_roofed, write_wear

import ringlet
from ringlet import io


def test_the_cache_animates_the_cloth_of_another_file_in_valid_usd(cloth_example):
    result = sim(cloth_example, "small.shot.toml", "--json", "--report", cloth_example / "report")
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["cloths"] == 1
    assert io.problems(cloth_example / "cache.usdc") == []
    stage = Usd.Stage.Open(str(cloth_example / "cache.usdc"))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/groom/cloths/wear/scarf"))
    assert len(mesh.GetFaceVertexCountsAttr().Get()) == 64
    assert mesh.GetNormalsAttr().Get(2.0) is None
    assert mesh.GetPointsAttr().GetTimeSamples() == [float(f) for f in range(1, FRAMES + 1)]
    world = np.array(UsdGeom.XformCache(2.0).GetLocalToWorldTransform(mesh.GetPrim()))
    assert np.allclose(world, np.eye(4))
    heights = np.array(mesh.GetPointsAttr().Get(2.0))[:, 1]  # in centimetres, the unit of the head's file
    assert heights.min() > 14 and heights.max() < 14.5  # one implicit step of free fall, g t², below 16

    cache = ringlet.read_cache(cloth_example / "cache.usdc")
    (cloth,) = cache.cloths
    assert (cloth.name, cloth.prim) == ("scarf", "/wear/scarf")
    assert cloth.file.resolve() == (cloth_example / "wear.usda").resolve()
    assert cloth.points.shape == (FRAMES, 81, 3)
    assert np.allclose(cloth.points[1, :, 1] * 100, heights, atol=1e-3)
    html = (cloth_example / "report/report.html").read_text()
    assert "Cloth" in html and "scarf" in html


def test_cloth_is_referenced_by_hairs(cloth_example):
    assert sim(cloth_example).exit_code == 0
    groom, hair = cloth_example / "groom.usdc", cloth_example / "hair.usdc"
    ringlet.write_hairs(groom, hair, cache=cloth_example / "cache.usdc", frames=(2, 4))
    bodies, _, _ = io.read_stage(hair, 4)
    (scarf,) = [body for body in bodies if body.mesh.name.endswith("scarf")]
    kept = ringlet.read_cache(cloth_example / "cache.usdc").cloths[0]
    assert np.abs(scarf.clip.at(4) - kept.points[-1]).max() < 1e-6
    assert io.problems(hair) == []


def test_hairs_stay_below_a_cloth_that_their_locks_are_below(tmp_path):
    folder = write_example(tmp_path)
    top = write_roofed(folder)
    ringlet.write_hairs(folder / "groom.usdc", folder / "rest.usdc")
    assert io.read_hairs(folder / "rest.usdc").points[:, 1].max() > top + 1e-3
    assert io.read_hairs(folder / "hair.usdc").points[:, 1].max() < top - 0.9e-4


def test_hairs_at_rest_stay_below_visible_meshes_of_the_head(tmp_path):
    folder = write_example(tmp_path)
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text() + 'lock_radius = "6 mm"\n')
    top = 100 * ringlet.build_groom(recipe).locks.points[:, 1].max()  # in centimetres, the unit of the head's file
    at = np.linspace(-20, 20, 9)
    x, z = np.meshgrid(at, at)
    stage = Usd.Stage.Open(str(folder / "head.usda"))
    for name in ("hood", "unseen"):
        roof = np.stack([x, 0 * x + top + 0.1, z], axis=-1).reshape(-1, 3)
        mesh = define(stage, f"/ball/{name}", roof, quads(9, 9))
        if name == "unseen":
            mesh.MakeInvisible()
        stage.Save()
        ringlet.write_groom(ringlet.build_groom(recipe), folder / "groom.usda")
        ringlet.write_hairs(folder / "groom.usda", folder / "hair.usda")
        highest = 100 * io.read_hairs(folder / "hair.usda").points[:, 1].max()
        assert highest < top + 0.091 if name == "hood" else highest > top + 0.2
        stage.RemovePrim(mesh.GetPath())


def test_cloth_of_the_head_file_is_no_collider_and_is_animated_there(cloth_example, tmp_path):
    folder = write_example(tmp_path)
    stage = Usd.Stage.Open(str(folder / "head.usda"))
    at = np.linspace(-4, 4, 9)
    x, z = np.meshgrid(at, at)
    define(stage, "/ball/cap", np.stack([x, 0 * x + RADIUS + 6, z], axis=-1).reshape(-1, 3), quads(9, 9))
    stage.Save()
    (folder / "small.shot.toml").write_text(
        (folder / "small.shot.toml").read_text() + '[contact]\n[[cloth]]\nmesh = "/ball/cap"\n'
    )
    assert run("groom", folder / "small.recipe.toml", "-o", folder / "groom.usdc").exit_code == 0
    result = sim(folder)
    assert result.exit_code == 0, result.output
    assert io.problems(folder / "cache.usdc") == []
    stage = Usd.Stage.Open(str(folder / "cache.usdc"))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/groom/body/cap"))
    points = [np.array(mesh.GetPointsAttr().Get(float(f))) for f in (1, FRAMES)]
    assert points[1][:, 1].mean() < points[0][:, 1].mean() - 0.05  # it falls
    assert not stage.GetPrimAtPath("/groom/cloths")


def lose_area(mesh):
    points = np.array(mesh.GetPointsAttr().Get())
    points[:2] = points[10]
    mesh.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(points))


def lose_a_number(mesh):
    points = np.array(mesh.GetPointsAttr().Get())
    points[3] = np.nan
    mesh.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(points))


def lower(mesh, height):
    UsdGeom.Xformable(mesh).AddTranslateOp().Set(Gf.Vec3d(0, -height, 0))


def paint(mesh):
    UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("pin", Sdf.ValueTypeNames.FloatArray, "vertex").Set([0.0] * 81)


@pytest.mark.parametrize(
    ("change", "text", "words"),
    [
        (lambda mesh: None, SCARF.replace("wear/scarf", "wear/scraf"), ["/wear/scraf", "did you mean /wear/scarf?"]),
        (lambda mesh: None, SCARF.replace("wear.usda", "ware.usda"), ["ware.usda", "no such file"]),
        (lambda mesh: mesh.GetPrim().SetTypeName("Xform"), SCARF, ["wear.usda", "no Mesh"]),
        (lose_area, SCARF, ["/wear/scarf", "triangle", "no area"]),
        (lose_a_number, SCARF, ["/wear/scarf", "point 3", "finite"]),
        (lambda mesh: lower(mesh, 0.1), SCARF, ["'scarf'", "begins inside 'skin'"]),
        (lambda mesh: lower(mesh, 0.075), SCARF, ["'scarf'", "begins through 'skin'"]),
        (paint, SCARF + '[[cloth.pin]]\nmap = "pin"\n', ["'scarf'", "pin[0]", "no vertex"]),
        (lambda mesh: None, SCARF + '[[cloth.pin]]\nto = "skin"\nwithin = 0.01\n', ["pin[0].within", "0.01 m"]),
        (
            lambda mesh: None,
            SCARF + SCARF.replace("[contact]", ""),
            ["cloth[1].mesh is /wear/scarf", "is a cloth already"],
        ),
    ],
)
def test_unusable_cloth_is_refused_and_leaves_no_file(cloth_example, tmp_path, change, text, words):
    folder = write_example(tmp_path)
    write_wear(folder, change)
    (folder / "small.shot.toml").write_text((folder / "small.shot.toml").read_text() + text)
    result = run(
        "sim", folder / "small.shot.toml", "--groom", cloth_example / "groom.usdc", "-o", tmp_path / "cache.usdc"
    )
    refused(result, *words)
    assert not (tmp_path / "cache.usdc").exists()


@pytest.mark.parametrize(
    ("cloth", "words"),
    [
        ('[[cloth]]\nmesh = "/ball/skin"\n', "cloth[0].mesh is /ball/skin, the scalp that hair grows on"),
        (SCARF.removeprefix("\n[contact]\n") + '[[cloth]]\nname = "two"\nfile = "wear.usda"\n', "is a cloth already"),
    ],
)
def test_a_mesh_is_not_the_scalp_and_a_cloth_at_once_nor_two_cloths(tmp_path, cloth, words):
    write_wear(write_example(tmp_path))
    shot = tmp_path / "small.shot.toml"
    shot.write_text(f"{shot.read_text()}[contact]\n{cloth}")
    refused(run("sim", shot, "-o", tmp_path / "cache.usdc"), words)
