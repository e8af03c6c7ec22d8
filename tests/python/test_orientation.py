"""Orientation: which triangles face the inside of a head, and what is done about it."""

import numpy as np
import pytest
from pxr import UsdGeom, Vt
from ringlet.api.shots import cloths_and_colliders
from ringlet.deform.orientation import facing_inside, outward
from ringlet.shot import parse_shot
from shapes import ball, rotation, sheet
from usd_scenes import new_stage

from ringlet import Mesh, UserError
from ringlet.groom import check_groom, make_groom, parse_recipe

BALL = ball()
RECIPE = "ringlet = 2\n[scalp]\nregion = 'scalp'\n[guides]\ncount = 12\nlength = 6\n[locks]\ncount = 10\npoints = 20\n"


def above(height):
    """The triangles of the ball above a height [m]."""
    return BALL.triangles[BALL.points[BALL.triangles].mean(axis=1)[:, 1] > height]


def turned(mesh, chosen=slice(None)):
    """A mesh with some triangles turned over."""
    triangles = mesh.triangles.copy()
    triangles[chosen] = triangles[chosen][:, ::-1]
    return Mesh(mesh.name, mesh.points, triangles, regions=mesh.regions)


@pytest.mark.parametrize("triangles", [BALL.triangles, above(-0.08), above(-0.06)])
def test_the_inside_of_a_head_is_known_with_an_open_neck_too(triangles):
    assert not facing_inside(BALL.points, triangles).any()
    assert facing_inside(BALL.points, triangles[:, ::-1]).all()


OPEN = [sheet(), Mesh("cap", BALL.points, above(0.0)), Mesh("none", np.zeros((0, 3)), np.zeros((0, 3), np.int32))]


@pytest.mark.parametrize("mesh", OPEN, ids=lambda mesh: mesh.name)
def test_an_open_sheet_has_no_inside(mesh):
    assert not facing_inside(mesh.points, mesh.triangles).any()
    assert not facing_inside(mesh.points, mesh.triangles[:, ::-1]).any()


def test_random_triangles_of_a_closed_surface_that_are_turned_are_found():
    random = np.random.default_rng(53)
    for _ in range(20):
        chosen = random.uniform(size=len(BALL.triangles)) < random.uniform()
        place = BALL.points @ rotation((1, 2, 3), 40.0) + random.normal(size=3)
        assert np.array_equal(facing_inside(place, turned(BALL, chosen).triangles), chosen)


def test_a_surface_with_split_points_is_one():
    corners, rows = BALL.points[BALL.triangles].reshape(-1, 3), np.arange(3 * len(BALL.triangles)).reshape(-1, 3)
    assert facing_inside(corners, rows[:, ::-1]).all() and not facing_inside(corners, rows).any()


def test_each_part_of_a_mesh_has_an_orientation_of_its_own():
    both = np.concatenate([BALL.triangles, len(BALL.points) + BALL.triangles[:, ::-1]])
    found = facing_inside(np.concatenate([BALL.points, BALL.points + 1.0]), both)
    assert np.array_equal(found, np.arange(len(both)) >= len(BALL.triangles))


def test_a_room_about_the_head_stays():
    room = 5.0 * BALL.points, BALL.triangles[:, ::-1]
    assert np.array_equal(outward(*room, BALL.points), room[1])
    assert np.array_equal(outward(*room, BALL.points + 1.0), BALL.triangles)


@pytest.mark.parametrize(("chosen", "count"), [(slice(None), 480), (BALL.regions["scalp"], 480), ([0], 1)])
def test_a_scalp_that_faces_the_inside_of_its_head_is_refused(chosen, count):
    scalp = turned(BALL, chosen)
    scalp.regions = {"scalp": BALL.regions["scalp"] if count > 1 else np.array([0], np.int32)}
    with pytest.raises(UserError, match=f"'scalp': {count} of {count} triangles face the inside of the mesh"):
        make_groom(parse_recipe(RECIPE), scalp)


def test_what_hair_stays_out_of_may_be_wound_either_way():
    ear = Mesh("ear", 0.5 * BALL.points + [0.0, 0.1, 0.0], BALL.triangles)
    assert check_groom(make_groom(parse_recipe(RECIPE), BALL), [ear]).summary()["body"]["places"] > 0
    one, other = (make_groom(parse_recipe(RECIPE), BALL, colliders=[body]).locks for body in (ear, turned(ear)))
    assert np.array_equal(one.points, other.points)
    found = [check_groom(make_groom(parse_recipe(RECIPE), BALL), [body]).summary() for body in (ear, turned(ear))]
    assert found[0] == found[1]


def test_a_helper_mesh_may_be_wound_either_way():
    recipe = parse_recipe(
        RECIPE + "[meshes.round]\nfile = 'x.obj'\n[[shape]]\nop = 'grow_to'\nmesh = 'round'\nspread = 0\n"
    )
    envelope = Mesh("round", 1.3 * BALL.points, BALL.triangles)
    one, other = (make_groom(recipe, BALL, meshes={"round": mesh}).locks for mesh in (envelope, turned(envelope)))
    assert np.array_equal(one.points, other.points)
    tips = np.linalg.norm(one.points[one.offsets[1:] - 1], axis=1)
    np.testing.assert_allclose(tips, 1.3 * 0.09, rtol=0.03)


def test_colliders_of_a_shot_face_outwards_and_rooms_stay(tmp_path):
    stage = new_stage(tmp_path / "bodies.usda", unit=1.0)
    for name, size in (("ball", 0.3), ("room", 20.0)):
        mesh = UsdGeom.Mesh.Define(stage, f"/head/{name}")
        mesh.CreateSubdivisionSchemeAttr("none")
        mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy((size * BALL.points).astype(np.float32)))
        mesh.CreateFaceVertexCountsAttr([3] * len(BALL.triangles))
        mesh.CreateFaceVertexIndicesAttr(BALL.triangles[:, ::-1].ravel().tolist())
    stage.Save()
    text = f"ringlet = 2\ngroom = 'g.usdc'\nframes = [1, 2]\n[contact]\n[[collider]]\nfile = '{tmp_path}/bodies.usda'\n"
    made = make_groom(
        parse_recipe(RECIPE), Mesh("head", BALL.points + [0, 0.3, 0], BALL.triangles, regions=BALL.regions)
    )
    _, (solid, room) = cloths_and_colliders(parse_shot(text), made)
    assert np.array_equal(solid.mesh.triangles, BALL.triangles)
    assert np.array_equal(room.mesh.triangles, BALL.triangles[:, ::-1])
