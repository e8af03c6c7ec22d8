"""Different names stay different where they are made valid."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from commands import refused, run
from pxr import Usd, UsdGeom
from ringlet.data.accessory import Accessory
from ringlet.data.curves import Curves
from ringlet.data.hair_scene import CurveSet, HairScene
from ringlet.data.mesh import Mesh
from ringlet.data.names import distinct, file_name, folded, identifier, unique
from ringlet.data.stage import StageSpace
from ringlet.farm.grid import Choice, folder_name
from ringlet.farm.openjd import template
from ringlet.farm.task import TaskOptions
from ringlet.groom.several import grooms_of, join_grooms
from ringlet.io import PolygonMesh, open_scene, read_groom, read_mesh, write_groom, write_polygon_meshes, write_scene
from ringlet.io.usd.deformable import Rod, write_deformable_scene
from similar_names import SIMILAR
from usd_scenes import make_groom, write_head


@pytest.mark.parametrize("one, other", SIMILAR)
def test_similar_names_become_different_identifiers_and_files(one, other):
    for names in ([one, other], [other, one], [one, other, one]):
        made = distinct(names)
        assert len(set(made)) == len(names) and all(name == identifier(name) for name in made)
        files = distinct(names, file_name, folded)
        assert len({folded(name) for name in files}) == len(names)
        assert all(0 < len(name.encode()) < 255 for name in files)
        assert not any(set(name) & set('<>:"/\\|?*\t') for name in files)


def test_a_valid_name_stays_whichever_others_there_are():
    assert distinct(["a.1", "a_1", "a-1", "b"]) == ["a_1_2", "a_1", "a_1_3", "b"]
    assert distinct(["a", "A"], file_name, folded) == ["a", "A_2"]


def test_a_name_that_is_taken_gets_a_number():
    assert unique("a", []) == "a" and unique("a", ["a", "a_2"]) == "a_3"
    assert unique("A", ["a"]) == "A" and unique("A", ["a"], folded) == "A_2"


# Where names become names of something else


def curves(height):
    points = np.array([[0.0, height, 0.0], [0.0, height + 0.1, 0.0], [0.0, height + 0.2, 0.0]])
    return Curves(points, np.array([0, 3]), np.array([1]))


def square(name, **more):
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]], np.float32)
    return PolygonMesh(name, points, np.array([4], np.int32), np.array([0, 1, 2, 3], np.int32), **more)


@pytest.mark.parametrize("one, other", SIMILAR)
def test_meshes_maps_and_regions_of_a_host_stay_apart(tmp_path, one, other):
    maps = {one: np.full(4, 0.25, np.float32), other: np.full(4, 0.75, np.float32), "st": np.zeros(4, np.float32)}
    regions = {one: np.array([0], np.int32), other: np.array([], np.int32)}
    uv = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32)
    meshes = [square(one, maps=maps, regions=regions, uv=uv), square(other)]
    prims = write_polygon_meshes(meshes, tmp_path / "scene.usdc", StageSpace())
    assert len(set(prims)) == 2
    stage = Usd.Stage.Open(str(tmp_path / "scene.usdc"))
    prim = stage.GetPrimAtPath(prims[0])
    values = [UsdGeom.PrimvarsAPI(prim).GetPrimvar(name).Get() for name in distinct(["st", *maps])[1:]]
    assert [value[0] for value in values] == [0.25, 0.75, 0.0]
    mesh = read_mesh(tmp_path / "scene.usdc", prims[0])
    assert mesh.regions[one].size == 2 and mesh.regions[other].size == 0
    assert mesh.uv is not None and mesh.uv.max() == 1.0  # a map called st leaves the texture coordinates alone


@pytest.mark.parametrize("suffix", ["usdc", "abc"])
def test_curves_and_bodies_of_a_scene_stay_apart(tmp_path, suffix):
    if suffix == "abc":
        pytest.importorskip("alembic3d")
    names = [name for name in itertools.chain(*SIMILAR) if name.strip() and not set(name) & set("/\t ")]
    triangle = np.array([[0, 0, 0], [1, 0, 0], [0, 0, 1]], float)
    bodies = [(Mesh(name, triangle + [0, k, 0], np.array([[0, 1, 2]], np.int32)), None) for k, name in enumerate(names)]
    sets = [CurveSet(name, curves(k)) for k, name in enumerate(names)]
    write_scene(HairScene(sets, bodies), tmp_path / f"scene.{suffix}", StageSpace())
    with open_scene(tmp_path / f"scene.{suffix}", StageSpace()) as found:
        heights = sorted(one.curves.points[0, 1] for one in found.sets)
        assert len({one.name for one in found.sets} | {mesh.name for mesh, _ in found.bodies}) == 2 * len(names)
    np.testing.assert_allclose(heights, np.arange(len(names)), atol=1e-5)


@pytest.mark.parametrize("names", [("locks", "locks_roots"), ("locks_roots", "locks"), ("a.1", "a_1")])
def test_rods_and_what_fixes_their_roots_stay_apart(tmp_path, names):
    scene = HairScene([CurveSet(name, curves(k)) for k, name in enumerate(names)])
    write_deformable_scene(scene, Rod(1e-4, 1000.0, 1.0, 1.0, 1.0), tmp_path / "rods.usda", StageSpace())
    stage = Usd.Stage.Open(str(tmp_path / "rods.usda"))
    rods = [prim for prim in stage.Traverse() if prim.IsA(UsdGeom.BasisCurves)]
    fixed = [prim for prim in stage.Traverse() if prim.GetTypeName() == "PhysicsAttachment"]
    of = {prim.GetRelationship("physics:src0").GetTargets()[0] for prim in fixed}
    assert len(rods) == 2 and of == {prim.GetPath() for prim in rods}


@pytest.mark.parametrize("one, other", [*SIMILAR, ("1", 1), ("true", True), ("a,b", "a_b"), ("a=1", "a_1")])
def test_tasks_of_a_wedge_have_folders_of_their_own(one, other):
    folders = [folder_name({"name": one}), folder_name({"name": other})]
    assert len({folded(name) for name in folders}) == 2
    assert all(file_name(name) == name for name in folders)
    assert folder_name({"a": "1,b=2", "b": "3"}) != folder_name({"a": "1", "b": "2,b=3"})


def test_parameters_of_a_farm_job_are_different(tmp_path):
    settings = (
        "strands.bend_scale",
        "strands.bend.scale",
        "strands_bend_scale",
        "\u82b1",
        "\u8349",
        "x" * 90,
        "x" * 91,
    )
    choices = [Choice(name, (name,), (1,)) for name in settings]
    steps = template(tmp_path / "a.shot.toml", choices, TaskOptions())["steps"]
    names = [one["name"] for one in steps[0]["parameterSpace"]["taskParameterDefinitions"]]
    assert names[:3] == ["strands_bend_scale_2", "strands_bend_scale_3", "strands_bend_scale"]
    assert len(set(names)) == len(names) and all(name == identifier(name) and len(name) <= 64 for name in names)


def test_variants_of_one_name_are_refused(copy):
    recipe = copy / "small.recipe.toml"
    (copy / "a").mkdir()
    for file in ("a/thin.recipe.toml", "thin.recipe.toml", "base.recipe.toml"):
        (copy / file).write_text(recipe.read_text().replace('"head.usda"', f'"{copy / "head.usda"}"'))
    given = ["--variant", copy / "a/thin.recipe.toml", "--variant", copy / "thin.recipe.toml"]
    refused(run("groom", recipe, *given, "-o", copy / "out.usdc"), "thin", "both called", "rename")
    given = ["--variant", copy / "base.recipe.toml"]
    refused(run("groom", recipe, *given, "-o", copy / "out.usdc"), "variant 'base'", "another name")


def test_what_several_grooms_wear_stays_apart(tmp_path):
    groom = make_groom(write_head(tmp_path / "head.usdc"))
    triangle = np.array([[0, 0, 0], [1, 0, 0], [0, 0, 1]], float)

    def wearing(*names):
        meshes = [Mesh(name, triangle, np.array([[0, 1, 2]], np.int32)) for name in names]
        return replace(groom, accessories=[Accessory(mesh, np.array([0])) for mesh in meshes])

    joined = join_grooms({"a": wearing("b_c", "b c"), "a_b": wearing("c")})
    assert len({one.mesh.name for one in joined.accessories}) == 3
    write_groom(joined, tmp_path / "groom.usdc")
    found = grooms_of(read_groom(tmp_path / "groom.usdc"))
    assert [len(one.accessories) for one in found.values()] == [2, 1]
