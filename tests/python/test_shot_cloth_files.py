"""Cloth in files: in the cache, in hairs and pictures, and what touches it; what cannot be used is refused."""

import json

import numpy as np
import pytest
from pxr import Gf, Sdf, Usd, UsdGeom, Vt
from ringlet.data.cache import Cache, CachedCloth, Touches
from ringlet.shot import parse_shot
from ringlet.sim import Obstacle, simulate
from small_example import FRAMES, RADIUS, write_example
from test_cli import refused, run
from test_shot_cloth import LONG, garment, simulated
from test_shot_contact import floor, groom, still

import ringlet
from ringlet import io

SCARF = """
[contact]
[[cloth]]
file = "wear.usda"
mesh = "/wear/scarf"
[cloth.material]
thickness = 2e-3
"""


def define(stage, path, points, faces):
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(np.asarray(points, np.float32)))
    mesh.CreateExtentAttr(UsdGeom.PointBased.ComputeExtent(mesh.GetPointsAttr().Get()))
    mesh.CreateFaceVertexCountsAttr([len(face) for face in faces])
    mesh.CreateFaceVertexIndicesAttr([corner for face in faces for corner in face])
    mesh.CreateSubdivisionSchemeAttr("none")
    return mesh


def quads(columns, rows):
    return [[k + columns * j for k, j in ((i, r), (i + 1, r), (i + 1, r + 1), (i, r + 1))]
            for r in range(rows - 1) for i in range(columns - 1)]  # fmt: skip


def write_wear(folder, change=lambda mesh: None):
    """A sheet of quads over the ball, in metres, under a transform; the ball is in centimetres."""
    stage = Usd.Stage.CreateNew(str(folder / "wear.usda"))
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdGeom.SetStageUpAxis(stage, "Y")
    stage.SetTimeCodesPerSecond(24)
    top = UsdGeom.Xform.Define(stage, "/wear")
    stage.SetDefaultPrim(top.GetPrim())
    top.AddTranslateOp().Set(Gf.Vec3d(0, 0.16, 0))
    at = np.linspace(-0.04, 0.04, 9)
    x, z = np.meshgrid(at, at)
    points = np.stack([x, 0 * x, z], axis=-1).reshape(-1, 3)
    mesh = define(stage, "/wear/scarf", points, quads(9, 9))
    mesh.CreateNormalsAttr(Vt.Vec3fArray.FromNumpy(np.tile(np.float32([0, 1, 0]), (81, 1))))
    change(mesh)
    stage.Save()


@pytest.fixture(scope="module")
def example(tmp_path_factory):
    """The small example with a sheet over its head, with its groom."""
    folder = write_example(tmp_path_factory.mktemp("cloth"))
    write_wear(folder)
    shot = folder / "small.shot.toml"
    shot.write_text(shot.read_text() + SCARF)
    assert run("groom", folder / "small.recipe.toml", "-o", folder / "groom.usdc").exit_code == 0
    return folder


def sim(folder, shot="small.shot.toml", *more):
    return run("sim", folder / shot, "--groom", folder / "groom.usdc", "-o", folder / "cache.usdc", *more)


def test_the_cache_moves_the_cloth_of_another_file_and_keeps_the_rules_of_usd(example):
    result = sim(example, "small.shot.toml", "--json", "--report", example / "report")
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["cloths"] == 1
    assert io.problems(example / "cache.usdc") == []
    stage = Usd.Stage.Open(str(example / "cache.usdc"))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/groom/cloths/wear/scarf"))
    assert len(mesh.GetFaceVertexCountsAttr().Get()) == 64
    assert mesh.GetNormalsAttr().Get(2.0) is None
    assert mesh.GetPointsAttr().GetTimeSamples() == [float(f) for f in range(1, FRAMES + 1)]
    world = np.array(UsdGeom.XformCache(2.0).GetLocalToWorldTransform(mesh.GetPrim()))
    assert np.allclose(world, np.eye(4))
    heights = np.array(mesh.GetPointsAttr().Get(1.0))[:, 1]  # in centimetres, as the head's file has it
    assert heights.min() > 14 and heights.max() < 14.5  # g t² below 16: it has fallen for one implicit step

    cache = ringlet.read_cache(example / "cache.usdc")
    (cloth,) = cache.cloths
    assert (cloth.name, cloth.prim) == ("scarf", "/wear/scarf")
    assert cloth.file.resolve() == (example / "wear.usda").resolve()
    assert cloth.points.shape == (FRAMES, 81, 3)
    assert np.allclose(cloth.points[0, :, 1] * 100, heights, atol=1e-3)
    html = (example / "report/report.html").read_text()
    assert "Cloth" in html and "scarf" in html


def test_cloth_is_in_the_hairs_and_in_pictures(example):
    assert sim(example).exit_code == 0
    groom, hair = example / "groom.usdc", example / "hair.usdc"
    ringlet.write_hairs(groom, hair, cache=example / "cache.usdc", frames=(2, 4))
    bodies, _, _ = io.read_stage(hair, 4)
    (scarf,) = [body for body in bodies if body.mesh.name.endswith("scarf")]
    kept = ringlet.read_cache(example / "cache.usdc").cloths[0]
    assert np.abs(scarf.clip.at(4) - kept.points[-1]).max() < 1e-6
    assert io.problems(hair) == []


def write_roofed(folder):
    """Wide locks of the small example at rest, with the sheet as a roof just above them; the height of that [m]."""
    write_wear(folder)
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text() + 'radius = "6 mm"\n')
    groom = ringlet.build_groom(recipe)
    ringlet.write_groom(groom, folder / "groom.usdc")
    locks = groom.locks.points
    at = np.linspace(-0.2, 0.2, 9)
    x, z = np.meshgrid(at, at)
    top = float(locks[:, 1].max()) + 1e-3
    roof = np.stack([x, 0 * x + top, z], axis=-1).reshape(1, -1, 3).astype(np.float32)
    cloth = CachedCloth("scarf", folder / "wear.usda", "/wear/scarf", roof)
    cache = Cache(np.array([1.0]), locks[None].astype(np.float32), cloths=[cloth])
    ringlet.write_cache(cache, folder / "groom.usdc", folder / "cache.usdc")
    ringlet.write_hairs(folder / "groom.usdc", folder / "hair.usdc", cache=folder / "cache.usdc")
    return top


def test_hairs_stay_below_a_cloth_that_their_locks_are_below(tmp_path):
    folder = write_example(tmp_path)
    top = write_roofed(folder)
    ringlet.write_hairs(folder / "groom.usdc", folder / "rest.usdc")
    assert io.read_hairs(folder / "rest.usdc").points[:, 1].max() > top + 1e-3
    assert io.read_hairs(folder / "hair.usdc").points[:, 1].max() < top - 0.9e-4


def test_hairs_at_rest_stay_below_what_is_visible_with_the_head(tmp_path):
    folder = write_example(tmp_path)
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text() + 'radius = "6 mm"\n')
    top = 100 * ringlet.build_groom(recipe).locks.points[:, 1].max()  # the head's file is in centimetres
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
        reached = 100 * io.read_hairs(folder / "hair.usda").points[:, 1].max()
        assert reached < top + 0.091 if name == "hood" else reached > top + 0.2
        stage.RemovePrim(mesh.GetPath())


def test_cloth_of_the_heads_own_file_is_no_collider_and_moves_there(example, tmp_path):
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


def sink(mesh, way):
    UsdGeom.Xformable(mesh).AddTranslateOp().Set(Gf.Vec3d(0, way, 0))


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
        (lambda mesh: sink(mesh, -0.1), SCARF, ["'scarf'", "begins inside 'skin'"]),
        (lambda mesh: sink(mesh, -0.075), SCARF, ["'scarf'", "begins through 'skin'"]),
        (paint, SCARF + '[[cloth.pin]]\nmap = "pin"\n', ["'scarf'", "pin[0]", "no vertex"]),
        (lambda mesh: None, SCARF + '[[cloth.pin]]\nto = "skin"\nwithin = 0.01\n', ["pin[0].within", "0.01 m"]),
        (lambda mesh: None, SCARF + SCARF.replace("[contact]", ""), ["two cloths", "'scarf'"]),
    ],
)
def test_cloth_that_cannot_be_used_is_refused_and_leaves_nothing(example, tmp_path, change, text, words):
    folder = write_example(tmp_path)
    write_wear(folder, change)
    (folder / "small.shot.toml").write_text((folder / "small.shot.toml").read_text() + text)
    result = run("sim", folder / "small.shot.toml", "--groom", example / "groom.usdc", "-o", tmp_path / "cache.usdc")
    refused(result, *words)
    assert not (tmp_path / "cache.usdc").exists()


# What touches, to be looked at


@pytest.fixture(scope="module")
def touched(example):
    """The example's contacts, with a sheet that begins on the scalp's locks."""
    result = sim(example, "small.shot.toml", "--contacts", example / "contacts.usdc")
    assert result.exit_code == 0, result.output
    return example / "contacts.usdc"


def test_what_touches_is_written_as_points_that_keep_the_rules_of_usd(touched):
    assert io.problems(touched) == []
    stage = Usd.Stage.Open(str(touched))
    points = UsdGeom.Points(stage.GetPrimAtPath("/groom/touches"))
    assert points.GetPointsAttr().GetTimeSamples() == [float(f) for f in range(1, FRAMES + 1)]
    counts = [frame["contact"]["contacts"] for frame in ringlet.read_cache(touched).statistics]
    assert max(counts) > 0
    for frame, count in enumerate(counts, 1):
        assert len(points.GetPointsAttr().Get(float(frame))) == count
    touches, colors = io.read_touches(touched, 4)
    assert touches.places.shape == colors.shape == (counts[3], 3)
    assert (touches.gap > 0).all() and (touches.gap < 1.001).all() and (touches.force >= 0).all()
    head = np.linalg.norm(touches.places - [0, 0, 0], axis=1)
    assert (head < 0.2).all()  # metres, on and around the ball of 9 cm


def test_a_force_that_is_far_stronger_leaves_the_colours_of_the_others(touched):
    cache = ringlet.read_cache(touched)
    force = np.full(200, 1e-3, np.float32)
    force[:100], force[0] = 1e-4, 1e3
    touches = Touches(np.zeros((200, 3), np.float32), force, np.ones(200, np.float32))
    cache.touches = [touches for _ in cache.frames]
    ringlet.write_touches(cache, touched.with_name("cache.usdc"), touched.with_name("strong.usdc"))
    _, colors = io.read_touches(touched.with_name("strong.usdc"))
    assert np.allclose(colors[0], colors[-1])  # both red, though one is a million times the other
    assert colors[-1, 1] < 0.1 and colors[1, 1] > 0.5  # a decade below them: yellow


def test_colours_tell_forces_apart():
    warm = io.heat(np.array([0.0, 0.5, 1.0]))
    assert warm[0, 2] > warm[0, 0] and warm[2, 0] > warm[2, 2]  # blue, red
    touches = simulated(garment(), text=LONG).touches
    assert touches == []  # only when asked for
    made = groom()
    obstacle = Obstacle(floor(), still(floor()))
    cache = simulate(parse_shot(LONG), made, still(floor()), obstacles=[obstacle], garments=[garment()], touches=True)
    last = cache.touches[-1]
    # In the end it lies still: contacts with the floor bear the weight of the sheet.
    on_floor = last.places[:, 1] < 1e-3
    weight = 9.81 * 0.15 * 0.08**2
    assert 0.3 * weight < last.force[on_floor].sum() < 3 * weight


def test_a_picture_shows_what_touches_and_where_the_start_was_worst(touched, tmp_path):
    pictures = {}
    for what in ("force", "gap", "start"):
        path = tmp_path / f"{what}.png"
        small = ("--samples", 2, "--width", 180, "--height", 200)
        result = run("picture", touched, "--contacts", what, "--frame", 4, "-o", path, *small)
        assert result.exit_code == 0, result.output
        pictures[what] = path.read_bytes()
    assert len(set(pictures.values())) == 3
    refused(run("picture", touched, "--contacts", "forse", "-o", tmp_path / "a.png"), "forse", "did you mean 'force'?")
    refused(run("picture", touched, "--contacts", "gap", "--frame", 40, "-o", tmp_path / "a.png"), "frame 40", "1 to 4")


def test_a_picture_of_what_touches_sees_through_cloth_and_nothing_else(touched, tmp_path, monkeypatch):
    drawn = []
    monkeypatch.setattr(ringlet.picture, "still", lambda bodies, *rest, **options: drawn.extend(bodies))
    ringlet.write_touches_picture(touched, tmp_path / "a.png", frame=4)
    seen_through = {body.mesh.name.split()[-1] for body in drawn if body.opacity < 1}
    assert seen_through == {"/groom/cloths/wear/scarf"}
    assert len(drawn) > 2


def test_a_stage_without_contacts_is_refused(example, tmp_path):
    assert sim(example).exit_code == 0
    refused(
        run("picture", example / "cache.usdc", "--contacts", "gap", "-o", tmp_path / "a.png"),
        "no contacts",
        "--contacts",
    )


def test_beads_are_round_and_face_outwards():
    from ringlet.picture import beads

    made = beads(np.array([[0.0, 0, 0], [1, 2, 3]]), np.array([[1.0, 0, 0], [0, 1, 0]]), 0.1)
    assert len(made.mesh.triangles) == 40
    assert np.allclose(np.linalg.norm(made.points[12:] - [1, 2, 3], axis=1), 0.1)
    corners = made.points[made.mesh.triangles]
    centres = np.repeat([[0.0, 0, 0], [1, 2, 3]], 20, axis=0)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("ni,ni->n", normals, corners.mean(axis=1) - centres) > 0).all()
    assert np.allclose(made.mesh.colors[12:], [0, 1, 0])
