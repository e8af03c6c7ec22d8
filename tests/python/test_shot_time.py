"""Time codes of a shot: its frames are read from every file, at any range and rate of the stages."""

from __future__ import annotations

import math

import numpy as np
import pytest
from commands import edit, made, run
from pxr import Gf, Usd, UsdGeom
from ringlet.api.shots import cloths_and_colliders
from small_example import FRAMES
from usd_scenes import add_cube, new_stage

import ringlet
from ringlet import io

RANGES = [(1, 1), (FRAMES, 1), (100, 200), (-1e12, 1e12)]


def turned(points: np.ndarray, frame: float) -> np.ndarray:
    """Points on the head of the example at a frame, which turns 5° about the vertical a frame from frame 1."""
    angle = np.radians(5.0 * (np.clip(frame, 1, FRAMES) - 1))
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T


def set_range(head, start, end):
    stage = Usd.Stage.Open(str(head))
    stage.SetStartTimeCode(start)
    stage.SetEndTimeCode(end)
    stage.Save()


@pytest.mark.parametrize("span", RANGES)
def test_roots_stay_on_the_head_in_every_frame_whatever_the_range_of_its_stage(folder, span):
    set_range(folder / "head.usda", *span)
    groom = made(folder)
    for command in (
        ("sim", folder / "small.shot.toml", "--groom", groom, "-o", folder / "cache.usdc", "--frames", f"-1:{FRAMES}"),
        ("hair", groom, "--cache", folder / "cache.usdc", "-o", folder / "hair.usdc"),
    ):
        result = run(*command)
        assert result.exit_code == 0, result.output
    cache, locks = ringlet.read_cache(folder / "cache.usdc"), ringlet.read_groom(groom).locks
    roots = locks.offsets[:-1]
    for frame, points in zip(cache.frames, cache.points, strict=True):
        np.testing.assert_allclose(points[roots], turned(locks.points[roots], frame), atol=1e-6)
    rest = io.read_hairs(folder / "hair.usdc", 1.0)
    hairs = io.read_hairs(folder / "hair.usdc", FRAMES)
    np.testing.assert_allclose(
        hairs.points[hairs.offsets[:-1]], turned(rest.points[rest.offsets[:-1]], FRAMES), atol=1e-5
    )


def test_colliders_of_another_rate_move_at_the_seconds_of_the_shot(folder):
    """A cube at 48 time codes a second that moves at 1 m/s; the head has 24."""
    stage = new_stage(folder / "cube.usda", unit=1.0)
    stage.SetTimeCodesPerSecond(48)
    slide = add_cube(stage).AddTranslateOp()
    for code in (0, 48):
        slide.Set(Gf.Vec3d(5.0 + code / 48, 0, 0), code)
    stage.Save()
    edit(folder / "small.shot.toml", "preroll = 0", 'preroll = 0\n[contact]\n[[collider]]\nfile = "cube.usda"')
    shot, groom = ringlet.read_shot(folder / "small.shot.toml"), ringlet.load_groom(folder / "small.recipe.toml")
    _, (cube,) = cloths_and_colliders(shot, groom)
    speed = (cube.at(FRAMES)[0] - cube.at(1)[0]) * 24 / (FRAMES - 1)
    np.testing.assert_allclose(speed, [1.0, 0.0, 0.0], atol=1e-5)


def test_the_head_has_the_rate_of_its_groom(folder):
    """The groom was made at 24 time codes a second; USD maps those of its head, now at 48, to the same seconds."""
    groom = made(folder)
    stage = Usd.Stage.Open(str(folder / "head.usda"))
    stage.SetTimeCodesPerSecond(48)
    stage.Save()
    result = run("sim", folder / "small.shot.toml", "--groom", groom, "-o", folder / "cache.usdc")
    assert result.exit_code == 0, result.output
    cache, locks = ringlet.read_cache(folder / "cache.usdc"), ringlet.read_groom(groom).locks
    stage = Usd.Stage.Open(str(folder / "cache.usdc"))
    body = UsdGeom.Xformable(stage.GetPrimAtPath("/groom/body"))
    roots = locks.offsets[:-1]
    for frame, points in zip(cache.frames, cache.points, strict=True):
        axis = body.ComputeLocalToWorldTransform(frame).TransformDir(Gf.Vec3d(1, 0, 0))
        angle = math.degrees(math.atan2(-axis[2], axis[0]))
        np.testing.assert_allclose(points[roots], turned(locks.points[roots], 1 + angle / 5), atol=1e-6)
