"""Invalid input in the middle of a shot: recovery, or refusal with frame, prim and lock; written frames stay."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from commands import refused, run
from pxr import Gf, Sdf, Usd, UsdGeom, Vt
from small_example import write_example

import ringlet
from ringlet import Curves

LAST = 30
BAD = 25


@pytest.fixture
def project(tmp_path) -> Path:
    """The small example with contact, with thirty frames of animated head points."""
    write_example(tmp_path)
    shot = tmp_path / "small.shot.toml"
    shot.write_text(shot.read_text().replace("[1, 4]", f"[1, {LAST}]") + "\n[contact]\nradius = 1e-3\n")
    stage = Usd.Stage.Open(str(tmp_path / "head.usda"))
    stage.SetEndTimeCode(LAST)
    points = UsdGeom.Mesh(stage.GetPrimAtPath("/ball/skin")).GetPointsAttr()
    rest = points.Get()
    for frame in range(1, LAST + 1):
        points.Set(rest, frame)
    stage.Save()
    return tmp_path


def spoil(project: Path, frame: int, change) -> None:
    """Changes the points of the head at a frame."""
    stage = Usd.Stage.Open(str(project / "head.usda"))
    attribute = UsdGeom.Mesh(stage.GetPrimAtPath("/ball/skin")).GetPointsAttr()
    points = np.array(attribute.Get(frame))
    change(points)
    attribute.Set(Vt.Vec3fArray.FromNumpy(points), frame)
    stage.Save()


def sim(project: Path, *more: object):
    return run("sim", project / "small.shot.toml", "-o", project / "cache.usdc", *more)


def root_triangle(project: Path) -> tuple[int, np.ndarray]:
    """The first lock and the corners of its root triangle."""
    groom = ringlet.build_groom(project / "small.recipe.toml")
    return int(groom.locks.ids[0]), groom.scalp.triangles[groom.locks.curve["root_triangle"][0]]


def test_non_finite_points_are_refused_with_frame_and_prim(project):
    def invalidate(points):
        points[7] = np.nan

    spoil(project, BAD, invalidate)
    refused(sim(project), "head.usda", "/ball/skin", f"at frame {BAD}", "point 7", "finite")


def test_a_non_finite_transform_is_refused_with_frame_and_prim(project):
    stage = Usd.Stage.Open(str(project / "head.usda"))
    slide = UsdGeom.Xformable(stage.GetPrimAtPath("/ball")).AddTranslateOp()
    for frame in range(1, LAST + 1):
        slide.Set(Gf.Vec3d(0, float("nan") if frame == BAD else 0, 0), frame)
    stage.Save()
    refused(sim(project), "/ball/skin", f"at frame {BAD}", "finite")


def test_a_degenerate_scalp_triangle_is_refused_with_its_lock_and_keeps_earlier_frames(project):
    lock, corners = root_triangle(project)
    shot = project / "small.shot.toml"
    shot.write_text(shot.read_text().partition("\n[contact]")[0])  # without contact the root detects the triangle

    def flatten(points):
        points[corners] = points[corners].mean(axis=0)

    spoil(project, BAD, flatten)
    result = sim(project)
    refused(result, f"frame {BAD}", f"lock {lock}", "no area", "mend")
    assert "--resume" in result.stderr
    assert len(list((project / "cache.usdc.part").glob("step.*"))) == BAD - 1
    assert sim(project, "--resume", "--frames", f"1:{BAD - 1}").exit_code == 0
    assert ringlet.read_cache(project / "cache.usdc").frames.tolist() == list(range(1, BAD))


def test_a_degenerate_collider_triangle_is_refused_with_frame_and_prim(project):
    def flatten(points):
        points[-3:] = points[-1]

    spoil(project, BAD, flatten)
    refused(sim(project), "/ball/skin", f"frame {BAD}", "no area", "colliders")
    assert len(list((project / "cache.usdc.part").glob("step.*"))) == BAD - 1


def test_a_repaired_head_starts_another_run(project):
    def flatten(points):
        points[-3:] = points[-1]

    spoil(project, BAD, flatten)
    sim(project)
    stage = Usd.Stage.Open(str(project / "head.usda"))
    points = UsdGeom.Mesh(stage.GetPrimAtPath("/ball/skin")).GetPointsAttr()
    points.Set(points.Get(1), BAD)
    stage.Save()
    refused(sim(project, "--resume"), "head.usda has changed")  # the whole animation is an input
    assert sim(project).exit_code == 0


def test_a_teleporting_head_is_followed_and_reported(project):
    spoil_all_from(project, BAD, np.array([300.0, 0.0, 0.0]))  # [cm] 3 m within a frame
    assert sim(project).exit_code == 0
    cache, groom = ringlet.read_cache(project / "cache.usdc"), ringlet.build_groom(project / "small.recipe.toml")
    assert np.isfinite(cache.points).all()
    assert all(frame["nan"] == 0 for frame in cache.statistics[1:])
    roots = cache.points[:, groom.locks.offsets[:-1]]
    moved = roots[BAD - 1] - roots[BAD - 2]
    assert (np.linalg.norm(moved, axis=1) > 2.9).all()  # roots follow the head
    length = groom.locks.lengths()
    tips = np.linalg.norm(cache.points[-1, groom.locks.offsets[1:] - 1] - roots[-1], axis=1)
    assert (tips < 1.5 * length).all()  # locks follow their roots
    stretch = [frame.get("max_stretch", 0.0) for frame in cache.statistics]
    assert int(np.argmax(stretch)) + 1 in range(BAD, BAD + 3)  # the stretch marks the frame


def spoil_all_from(project: Path, frame: int, shift: np.ndarray) -> None:
    for k in range(frame, LAST + 1):

        def move(points):
            points += shift.astype(np.float32)

        spoil(project, k, move)


def test_a_collider_teleporting_through_hair_leaves_locks_intact(project):
    stage = Usd.Stage.CreateNew(str(project / "ball.usda"))
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    stage.SetStartTimeCode(1)
    stage.SetEndTimeCode(LAST)
    root = UsdGeom.Xform.Define(stage, "/root")
    stage.SetDefaultPrim(root.GetPrim())
    mesh = UsdGeom.Mesh.Define(stage, "/root/plate")
    mesh.CreatePointsAttr([(-3, 0, -3), (3, 0, -3), (3, 0, 3), (-3, 0, 3)])
    mesh.CreateFaceVertexCountsAttr([3, 3])
    mesh.CreateFaceVertexIndicesAttr([0, 1, 2, 0, 2, 3])
    slide = mesh.AddTranslateOp()
    for frame in range(1, LAST + 1):
        slide.Set(Gf.Vec3d(-60 if frame < BAD else 60, 12, 0), frame)  # crosses the hair within a frame
    stage.Save()
    shot = project / "small.shot.toml"
    shot.write_text(shot.read_text() + '\n[[collider]]\nfile = "ball.usda"\n')
    assert sim(project).exit_code == 0
    cache, groom = ringlet.read_cache(project / "cache.usdc"), ringlet.build_groom(project / "small.recipe.toml")
    assert len(cache.frames) == LAST
    assert all(frame["nan"] == 0 for frame in cache.statistics[1:])
    locks = Curves(cache.points[-1], groom.locks.offsets, groom.locks.ids)
    assert locks.lengths() == pytest.approx(groom.locks.lengths(), rel=0.05)


def test_roots_off_the_scalp_are_refused_with_their_triangle(project):
    assert sim(project).exit_code == 0
    layer = Sdf.Layer.FindOrOpen(str(project / "cache.groom.usdc"))
    attribute = layer.GetAttributeAtPath("/groom/locks.primvars:ringlet:root_triangle")
    triangles = np.array(attribute.default)
    triangles[2] = 99_999
    attribute.default = Vt.IntArray.FromNumpy(triangles)
    layer.Save()
    refused(sim(project, "--groom", project / "cache.groom.usdc"), "/groom/locks", "triangle 99999")


@pytest.mark.parametrize("bad", [np.nan, 50.0])
def test_roots_beside_their_triangle_are_refused_with_their_lock(project, bad):
    assert sim(project).exit_code == 0
    path = project / "cache.groom.usdc"
    layer = Sdf.Layer.FindOrOpen(str(path))
    attribute = layer.GetAttributeAtPath("/groom/locks.ringlet:root_barycentric")
    weights = np.array(attribute.default)
    weights[2] = [bad, 1.0 - bad, 0.0]
    attribute.default = Vt.Vec3dArray.FromNumpy(weights)
    layer.Save()
    ids = ringlet.build_groom(project / "small.recipe.toml").locks.ids
    words = (f"lock {ids[2]}", "scalp") if np.isfinite(bad) else (f"curve {ids[2]}", "root_barycentric is nan")
    refused(sim(project, "--groom", path), "/groom/locks", *words)
