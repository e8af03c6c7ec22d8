"""A groom is bound to its head by geometry: a head that has changed is refused, and rebound where that is asked for."""

from __future__ import annotations

import numpy as np
import pytest
from commands import made, refused, run
from pxr import Usd, UsdGeom, Vt
from ringlet.data.binding import root_places
from shapes import rotation
from wear import SCARF, quads, write_wear

import ringlet

TURN = rotation((1.0, 2.0, 0.5), 40.0)
CHANGES = {
    "moved": (lambda p: p + [10.0, 0, 0], np.eye(3)),
    "turned": (lambda p: p @ TURN.T, TURN),
    "doubled": (lambda p: 2.0 * p, np.eye(3)),
    "sculpted": (lambda p: p * [1.0, 1.05, 1.0], np.eye(3)),
}


def change_points(file, prim, change):
    stage = Usd.Stage.Open(str(file))
    points = UsdGeom.PointBased(stage.GetPrimAtPath(prim)).GetPointsAttr()
    value = np.asarray(change(np.array(points.Get(), np.float64)), np.float32)
    points.Set(Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(value)))
    stage.Save()


def sim(folder, *more):
    shot = folder / "small.shot.toml"
    return run("sim", shot, "--groom", folder / "groom.usdc", "-o", folder / "cache.usdc", *more)


@pytest.mark.parametrize("name", CHANGES)
def test_a_changed_head_is_refused_and_the_groom_rebound_on_demand(copy, name):
    change, turn = CHANGES[name]
    before = ringlet.read_groom(made(copy)).locks
    change_points(copy / "head.usda", "/ball/skin", change)
    for command in (("check", copy / "groom.usdc"), ("hair", copy / "groom.usdc", "-o", copy / "hair.usdc")):
        refused(run(*command), "groom.usdc on head.usda", "roots are off the scalp", " mm; the head has changed")
    refused(sim(copy), "--rebind")
    assert not (copy / "cache.usdc").exists()

    assert sim(copy, "--rebind").exit_code == 0
    assert run("hair", copy / "cache.usdc", "-o", copy / "hair.usdc").exit_code == 0
    groom = ringlet.read_groom(copy / "cache.usdc")
    locks = groom.locks
    assert np.abs(locks.roots - root_places(locks, groom.scalp.points, groom.scalp.triangles)).max() < 1e-7
    assert (locks.curve["root_triangle"] == before.curve["root_triangle"]).all()
    for was, now in zip(map(before.__getitem__, range(len(before))), map(locks.__getitem__, range(8)), strict=True):
        assert np.abs((was - was[0]) @ turn.T - (now - now[0])).max() < (1e-7 if name != "sculpted" else 1e-3)


def test_drawn_guides_without_roots_move_with_the_locks_of_a_rebound_groom(copy):
    before = ringlet.read_groom(made(copy))
    stage = Usd.Stage.Open(str(copy / "groom.usdc"))
    guides = stage.GetPrimAtPath("/groom/guides")
    for name in ("primvars:ringlet:root_triangle", "ringlet:root_barycentric"):
        assert guides.RemoveProperty(name)
    stage.Save()
    change_points(copy / "head.usda", "/ball/skin", lambda p: 2.0 * p @ TURN.T + [10.0, 0, 0])
    assert sim(copy, "--rebind").exit_code == 0
    after = ringlet.read_groom(copy / "cache.usdc")
    expected = 2.0 * before.guides.roots @ TURN.T + [0.1, 0, 0]
    assert np.abs(after.guides.roots - expected).max() < 1e-6


@pytest.mark.parametrize("damage", ["none", "negative"])
def test_locks_with_damaged_roots_are_rebound_by_nearness(copy, damage):
    before = ringlet.read_groom(made(copy)).locks
    stage = Usd.Stage.Open(str(copy / "groom.usdc"))
    locks = UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/groom/locks"))
    if damage == "none":
        assert locks.GetPrim().RemoveProperty("primvars:ringlet:root_triangle")
    else:
        locks.GetPrimvar("ringlet:root_triangle").Set(Vt.IntArray([-7] * 8))
    stage.Save()
    rebound = ringlet.rebind_groom(copy / "groom.usdc").locks
    assert np.abs(rebound.points - before.points).max() < 1e-6
    assert (rebound.curve["root_triangle"] >= 0).all()


def test_another_mesh_of_the_same_shape_is_bound_by_nearness(copy):
    locks = ringlet.read_groom(made(copy)).locks
    stage = Usd.Stage.Open(str(copy / "head.usda"))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/ball/skin"))
    faces = np.array(mesh.GetFaceVertexIndicesAttr().Get()).reshape(-1, 3)
    mesh.GetFaceVertexIndicesAttr().Set(faces[::-1].ravel().tolist())
    UsdGeom.Subset(stage.GetPrimAtPath("/ball/skin/scalp")).GetIndicesAttr().Set(list(range(len(faces))))
    stage.Save()
    refused(sim(copy), "the head has changed")
    rebound = ringlet.rebind_groom(copy / "groom.usdc").locks
    assert np.abs(rebound.points - locks.points).max() < 1e-6
    assert (rebound.curve["root_triangle"] != locks.curve["root_triangle"]).any()

    change_points(copy / "head.usda", "/ball/skin", lambda p: p + [10.0, 0, 0])
    refused(sim(copy, "--rebind"), "which is another mesh", "make the groom again")


def test_a_recipe_is_not_rebound(copy):
    refused(run("sim", copy / "small.shot.toml", "-o", copy / "cache.usdc", "--rebind"), "is a recipe")


def test_hairs_are_not_made_of_a_cache_whose_head_moves_otherwise_since(copy):
    made(copy)
    assert sim(copy).exit_code == 0
    stage = Usd.Stage.Open(str(copy / "head.usda"))
    turn = UsdGeom.Xformable(stage.GetPrimAtPath("/ball")).GetOrderedXformOps()[0]
    turn.Set(90.0, 3)
    stage.Save()
    command = ("hair", copy / "groom.usdc", "--cache", copy / "cache.usdc", "-o", copy / "hair.usdc")
    refused(run(*command), "cache.usdc at frame 3", "off the scalp", "simulate again")
    assert run(*command, "--frames", "1:2").exit_code == 0


def test_hairs_are_not_made_beside_a_cloth_whose_mesh_has_changed_since(copy):
    write_wear(copy)
    shot = copy / "small.shot.toml"
    shot.write_text(shot.read_text() + SCARF)
    made(copy)
    assert sim(copy).exit_code == 0
    stage = Usd.Stage.Open(str(copy / "wear.usda"))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/wear/scarf"))
    mesh.GetPointsAttr().Set([(x, 0.0, z) for z in (0.0, 0.1) for x in (0.0, 0.1)])
    mesh.GetFaceVertexCountsAttr().Set([4])
    mesh.GetFaceVertexIndicesAttr().Set(quads(2, 2)[0])
    stage.Save()
    refused(run("hair", copy / "cache.usdc", "-o", copy / "hair.usdc"), "/groom/cloths/wear/scarf", "simulate again")
