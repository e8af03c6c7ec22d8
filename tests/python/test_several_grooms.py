"""Several grooms in one recipe: hair, brows and lashes are groomed, written and simulated together."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from commands import edit, refused, run
from pxr import Usd, UsdGeom
from ringlet.data.accessory import Accessory
from ringlet.data.curves import Curves
from ringlet.data.groom import GROOM, Groom
from ringlet.data.mesh import Mesh
from ringlet.data.pigment import ROUGHNESS, USUAL_FIBER, of_fiber
from ringlet.groom.several import with_each
from ringlet.io import open_scene
from ringlet.io.unreal import closest_guides
from ringlet.picture.strands import split
from small_example import RECIPE, SHOT, write_head

import ringlet
from ringlet import io
from ringlet.groom import grooms_of, join_grooms, make_hairs, parse_recipe

SEVERAL = """
ringlet = 2
name = "several"

[scalp]
file = "head.usda"

[color]
preset = "brown"

[curves.brow]
points = [[-4, 1, 8.1], [-2, 1.5, 8.8], [0, 1, 9]]

[grooms.hair]
extends = "small.recipe.toml"

[grooms.brows]
scalp.edge = { lines = ["brow"], width = 1 }
guides = { count = 10, length = 1, lift = 0.1 }
locks = { count = 30, points = 8 }
pin = [{}]
hairs = { per_lock = 1 }
color = { preset = "black" }
"""


@pytest.fixture
def project(copy):
    (copy / "several.recipe.toml").write_text(SEVERAL)
    (copy / "several.shot.toml").write_text(SHOT.replace("small.recipe.toml", "several.recipe.toml"))
    return copy


@pytest.fixture
def recipe(project):
    return project / "several.recipe.toml"


def test_hair_in_one_of_several_grooms_is_that_of_its_recipe_alone(project, recipe):
    edit(project / "small.recipe.toml", "[hairs]", '[color]\npreset = "brown"\n[hairs]')
    alone, made = ringlet.build_groom(project / "small.recipe.toml"), ringlet.build_groom(recipe)
    one = grooms_of(made)["hair"]
    assert np.array_equal(one.locks.points, alone.locks.points) and np.array_equal(one.locks.ids, alone.locks.ids)
    assert one.hairs == alone.hairs and one.color == alone.color and one.region == alone.region
    assert one.locks.curve.keys() == alone.locks.curve.keys()
    hairs, hairs_alone = make_hairs(made).curves, make_hairs(alone).curves
    np.testing.assert_array_equal(hairs.points[: len(hairs_alone.points)], hairs_alone.points)


def test_a_recipe_with_one_groom_is_written_as_before(project):
    made = ringlet.build_groom(project / "small.recipe.toml")
    assert not made.grooms and GROOM not in made.locks.curve
    ringlet.write_groom(made, project / "one.usda")
    text = (project / "one.usda").read_text()
    assert "ringlet:version = 1" in text and "grooms" not in text and "hidden" not in text and "edge" not in text


def test_ids_are_unique_and_those_of_a_groom_stay_when_another_is_added(project, recipe):
    before = ringlet.build_groom(recipe)
    assert len(np.unique(before.locks.ids)) == len(before.locks)
    edit(
        recipe,
        "[grooms.hair]",
        '[grooms.first]\nscalp.region = "scalp"\nlocks = { count = 5, points = 8 }\n[grooms.hair]',
    )
    after = ringlet.build_groom(recipe)
    assert list(after.grooms) == ["first", "hair", "brows"]
    assert set(before.locks.ids) < set(after.locks.ids) and len(np.unique(after.locks.ids)) == len(after.locks)
    kept = np.isin(after.locks.ids, before.locks.ids)
    np.testing.assert_array_equal(after.locks.take(kept).points, before.locks.points)


def test_what_is_outside_of_the_grooms_is_of_all_and_each_may_differ(recipe):
    read = ringlet.read_recipe(recipe)
    assert read.grooms["hair"].color.preset == "brown" and read.grooms["brows"].color.preset == "black"
    assert read.grooms["hair"].scalp.region == "scalp" and read.grooms["brows"].scalp.region is None
    edit(recipe, "[grooms.hair]", "[grooms.hair]\ncolor = false")
    assert ringlet.read_recipe(recipe).grooms["hair"].color is None


def test_a_variant_changes_one_groom_and_takes_away_another(project, recipe):
    variant = project / "variant.recipe.toml"
    variant.write_text(
        'ringlet = 2\nextends = "several.recipe.toml"\n[color]\npreset = "gray"\n[grooms.hair.locks]\ncount = 5\n'
    )
    read = ringlet.read_recipe(variant)
    assert read.grooms["hair"].locks.count == 5 and read.grooms["hair"].color.preset == "gray"
    assert read.grooms["brows"].model_dump() == ringlet.read_recipe(recipe).grooms["brows"].model_dump()
    variant.write_text('ringlet = 2\nextends = "several.recipe.toml"\ngrooms.brows = false\n')
    assert list(ringlet.read_recipe(variant).grooms) == ["hair"]


def test_the_text_that_a_groom_keeps_is_its_recipe_without_other_files(project, recipe):
    text = ringlet.build_groom(recipe).recipe
    assert "extends" not in text
    again = parse_recipe(text, recipe)
    assert again.grooms.keys() == ringlet.read_recipe(recipe).grooms.keys()
    for name, one in ringlet.read_recipe(recipe).grooms.items():
        assert again.grooms[name].model_dump() == one.model_dump()


def test_a_groom_file_keeps_each_groom_and_hairs_have_a_prim_each(project, recipe):
    groom, hair = project / "groom.usdc", project / "hair.usdc"
    assert run("groom", recipe, "-o", groom).exit_code == 0
    made, read = ringlet.build_groom(recipe), ringlet.read_groom(groom)
    assert list(read.grooms) == ["hair", "brows"] and read.recipe == made.recipe
    for name, one in grooms_of(read).items():
        was = grooms_of(made)[name]
        np.testing.assert_allclose(one.locks.points, was.locks.points, atol=1e-6)
        assert one.locks.curve.keys() == was.locks.curve.keys() and one.hairs == was.hairs and one.edge == was.edge
    assert run("hair", groom, "-o", hair).exit_code == 0
    stage = Usd.Stage.Open(str(hair))
    prims = [prim for prim in stage.GetPrimAtPath("/groom/hairs").GetChildren() if UsdGeom.BasisCurves(prim)]
    assert [prim.GetName() for prim in prims] == ["hair", "brows"]
    groups = [UsdGeom.PrimvarsAPI(prim).GetPrimvar("groom_group_id").Get() for prim in prims]
    assert set(groups[0]) == {0} and set(groups[1]) == {1}
    locks = UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/groom/locks")).GetPrimvar("groom_group_id").Get()
    assert list(np.unique(locks)) == [0, 1]
    np.testing.assert_allclose(io.read_hairs(hair).points, make_hairs(read).curves.points, atol=1e-6)


@pytest.mark.parametrize("on_demand", [False, True])
def test_hairs_of_each_groom_name_a_lock_of_it(project, recipe, tmp_path, on_demand):
    ringlet.write_groom(ringlet.build_groom(recipe), tmp_path / "groom.usdc")
    ringlet.write_hairs(tmp_path / "groom.usdc", tmp_path / "hair.usdc", on_demand=on_demand)
    with open_scene(tmp_path / "hair.usdc") as scene:
        ((guides, ids),) = ((one, ids) for one, ids in zip(scene.sets, scene.groom_ids, strict=True) if one.guide)
        groups = dict(zip(ids.tolist(), guides.group_ids.tolist(), strict=True))
        for one, closest in zip(scene.sets, closest_guides(scene), strict=True):
            if closest is not None:
                assert [groups[id] for id in closest.tolist()] == one.group_ids.tolist()
    assert sorted(set(groups.values())) == [0, 1]


def test_hairs_of_each_groom_have_their_own_fiber_in_pictures(project, recipe):
    edit(recipe, "pin = [{}]", "pin = [{}]\nfiber = { roughness = 0.6 }")
    assert run("groom", recipe, "-o", project / "groom.usdc").exit_code == 0
    assert run("hair", project / "groom.usdc", "-o", project / "hair.usdc").exit_code == 0
    shapes = split(io.read_hairs(project / "hair.usdc"))
    assert len(shapes) == 2
    assert of_fiber(shapes[0], ROUGHNESS) == pytest.approx(USUAL_FIBER[ROUGHNESS])
    assert of_fiber(shapes[1], ROUGHNESS) == pytest.approx(0.6)


def test_all_grooms_are_simulated_and_a_pinned_one_moves_with_the_skin(project):
    cache, hair = project / "cache.usdc", project / "hair.usdc"
    assert run("groom", project / "several.recipe.toml", "-o", project / "several.usdc").exit_code == 0
    assert run("sim", project / "several.shot.toml", "--groom", project / "several.usdc", "-o", cache).exit_code == 0
    groom = ringlet.read_groom(project / "several.usdc")
    with ringlet.open_cache(cache) as moved:
        points, angle = moved.points(4), np.radians(15.0)
    c, s = np.cos(angle), np.sin(angle)
    turned = groom.locks.points @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T
    off = np.linalg.norm(points - turned, axis=1)
    brows = np.repeat(groom.locks.curve[GROOM] == 1, groom.locks.counts)
    assert off[brows].max() < 1e-5 and off[~brows].max() > 1e-4
    assert run("hair", project / "several.usdc", "--cache", cache, "-o", hair).exit_code == 0
    stage = Usd.Stage.Open(str(hair))
    assert stage.GetPrimAtPath("/groom/hairs/brows").GetAttribute("points").GetTimeSamples() == [1.0, 2.0, 3.0, 4.0]


def test_check_measures_each_groom(project, recipe):
    measured = json.loads(run("check", recipe, "--json").stdout)
    assert measured["locks"] == 38 and measured["grooms"]["brows"]["hairs"] == 30
    assert measured["grooms"]["brows"]["hairs_per_cm"] == pytest.approx(30 / 4.3, rel=0.1)
    assert "hairs_per_cm2" in measured["grooms"]["hair"]
    assert "brows: 30 hairs, 7 hairs/cm of its edge" in run("check", recipe).stdout


def test_a_lock_of_several_grooms_is_edited_by_its_id(project, recipe):
    edit(recipe, "hairs = { per_lock = 1 }", 'hairs = { per_lock = 1 }\nedits = "brows.edits.toml"')
    made = ringlet.build_groom(recipe)
    lock = int(made.locks.ids[-1])
    result = run("edit", recipe, "--freeze", lock)
    assert result.exit_code == 0, result.output
    assert [edit["lock"] for edit in ringlet.list_edits(recipe)] == [lock]
    np.testing.assert_allclose(ringlet.build_groom(recipe).locks.points, made.locks.points, atol=1e-4)
    assert run("edit", recipe, "--release", lock).exit_code == 0 and not ringlet.list_edits(recipe)
    refused(run("edit", recipe, "--freeze", 10**15 + 5 * 10**12), "belongs to no groom; there are: hair, brows")


def test_a_modelled_brow_that_hair_replaces_is_neither_shown_nor_touched(project, recipe):
    stage = Usd.Stage.Open(str(project / "head.usda"))
    brow = UsdGeom.Cube.Define(stage, "/ball/other").GetPrim()
    brow.SetTypeName("Mesh")
    mesh = UsdGeom.Mesh(brow)
    mesh.CreatePointsAttr([(0, 2, 8), (1, 2, 9), (0, 3, 9)])
    mesh.CreateFaceVertexCountsAttr([3])
    mesh.CreateFaceVertexIndicesAttr([0, 1, 2])
    stage.Save()
    edit(recipe, 'file = "head.usda"', 'file = "head.usda"\nmesh = "/ball/skin"\nhide = ["/ball/other"]')
    assert run("groom", recipe, "-o", project / "groom.usdc").exit_code == 0
    assert ringlet.read_groom(project / "groom.usdc").hidden == ["/ball/other"]
    assert [mesh.name.split()[-1] for mesh in io.read_meshes(project / "groom.usdc")] == ["/groom/body/skin"]
    assert not ringlet.check_groom(project / "groom.usdc")["found"]["body"]["places"]
    edit(recipe, '"/ball/other"', '"/ball/othr"')
    refused(run("groom", recipe, "-o", project / "groom.usdc"), "scalp.hide", "no prim /ball/othr", "/ball/other")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("[grooms.brows]", "[grooms.hair]", "is not valid TOML"),
        ("[grooms.hair]", "[guides]\ncount = 5\n[grooms.hair]", "guides is outside of the grooms; move it to [grooms"),
        ('name = "several"', 'extends = "small.recipe.toml"', "is outside of the grooms"),
        ("[grooms.brows]", '[grooms."left brow"]', "grooms has the name 'left brow'; use letters"),
        ("[grooms.hair]", "[grooms]\nhair = 3\n[grooms.other]", "grooms.hair is 3; must be a table"),
        ('extends = "small.recipe.toml"', 'unit = "mm"', "grooms.hair.unit cannot be that of one groom"),
        ('extends = "small.recipe.toml"', 'extends = "several.recipe.toml"', "which extends it in turn"),
        ('extends = "small.recipe.toml"', 'scalp.region = "eyes"', "grooms.hair: scalp.region: "),
        ("length = 1,", "lenght = 1,", "grooms.brows.guides.lenght is not a setting; did you mean 'length'?"),
        ('{ lines = ["brow"], width = 1 }', "{}", "grooms.brows.scalp.edge needs either 'lines' or a 'region'"),
        (
            'lines = ["brow"]',
            'lines = ["brows"]',
            "scalp.edge.lines is 'brows', which is no helper curve; did you mean",
        ),
        ('lines = ["brow"]', 'region = "all"', "grooms.brows: scalp.edge.region: "),
        ("[0, 1, 9]", "[0, 1, 14]", "m from head.usda /ball/skin; at most 0.01 m is allowed: draw it on the skin"),
        ("count = 30,", "count = 30, sections = { size = 1 },", "locks.sections needs an area, but scalp.edge"),
        ("per_lock = 1", "density = 40", "hairs.density needs an area, but scalp.edge grows hair on lines"),
    ],
)
def test_what_cannot_be_several_grooms_is_refused_in_one_line(project, recipe, old, new, message):
    edit(recipe, old, new)
    refused(run("groom", recipe, "-o", project / "groom.usdc"), message)
    assert not (project / "groom.usdc").exists()


def test_grooms_on_different_heads_are_refused(project, recipe):
    write_head(project / "other.usda", unit=0.02)
    (project / "other.recipe.toml").write_text(RECIPE.replace("head.usda", "other.usda"))
    edit(recipe, 'file = "head.usda"\n', "")
    edit(recipe, "small.recipe.toml", "other.recipe.toml")
    edit(recipe, "scalp.edge", 'scalp.file = "head.usda"\nscalp.edge')
    refused(run("groom", recipe, "-o", project / "groom.usdc"), "grooms.brows: grows on another scalp")


def test_a_region_without_faces_is_refused_with_its_groom(project, recipe):
    stage = Usd.Stage.Open(str(project / "head.usda"))
    UsdGeom.Subset.CreateGeomSubset(UsdGeom.Mesh(stage.GetPrimAtPath("/ball/skin")), "beard", "face", [], "region")
    stage.Save()
    edit(recipe, "[grooms.hair]", '[grooms.beard]\nscalp.region = "beard"\n[grooms.hair]')
    refused(run("groom", recipe, "-o", project / "groom.usdc"), "grooms.beard: ", "region 'beard'", "no faces")


@pytest.mark.parametrize("damage", ['{"hair": {}, "brows": {}}', "[1, 2]", "{"])
def test_a_file_of_several_grooms_that_was_damaged_is_refused(project, recipe, damage):
    assert run("groom", recipe, "-o", project / "groom.usda").exit_code == 0
    stage = Usd.Stage.Open(str(project / "groom.usda"))
    stage.GetPrimAtPath("/groom").GetAttribute("ringlet:grooms").Set(damage)
    stage.Save()
    refused(run("hair", project / "groom.usda", "-o", project / "hair.usdc"), "ringlet:grooms")


def test_what_locks_wear_stays_on_the_locks_of_its_groom():
    points = np.linspace([0.0, 0.0, 0.0], [0.0, 0.0, 0.1], 5)
    scalp = Mesh("scalp", np.eye(3), np.array([[0, 1, 2]], np.int32))
    bead = Accessory(Mesh("bead 1", points[:3], np.array([[0, 1, 2]], np.int32)), np.array([3, 4]))

    def groom(count, worn):
        locks = Curves.from_list([points + [0.01 * k, 0.0, 0.0] for k in range(count)])
        return Groom(locks, locks, scalp, accessories=worn)

    several = join_grooms({"hair": groom(3, []), "beard": groom(2, [bead])})
    (worn,) = several.accessories
    assert worn.mesh.name == "beard_bead 1" and worn.vertices.tolist() == [18, 19]
    each = grooms_of(several)
    assert each["hair"].accessories == []
    assert each["beard"].accessories[0].vertices.tolist() == [3, 4]
    assert each["beard"].accessories[0].mesh.name == "bead 1"
    shift = np.array([0.0, 1.0, 0.0])

    def shifted(one):
        return replace(
            one, accessories=[of.moved(one.locks.points, one.locks.points + shift) for of in one.accessories]
        )

    (moved,) = with_each(several, shifted).accessories
    assert moved.mesh.name == "beard_bead 1" and moved.vertices.tolist() == [18, 19]
    np.testing.assert_allclose(moved.mesh.points, bead.mesh.points + shift, atol=1e-12)
