"""Roots stay on a moving head, the first frame is the groom, and edges keep their lengths or are reported."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from judged import same
from moving_scene import moving_scene
from numpy.random import Generator
from pxr import Gf, Usd, UsdGeom
from ringlet.data.binding import root_places

import ringlet


def attempt(random: Generator, folder: Path) -> None:
    shot, groom = moving_scene(random, folder)
    cache = ringlet.simulate(shot, groom)
    clip_stage = Usd.Stage.Open(str(folder / "head.usda"))
    same(cache.points[0], groom.locks.points, 1e-6, "the first frame is the groom")
    assert np.isfinite(cache.points).all(), "not finite"
    first, edges = groom.locks.offsets[:-1], np.ones(len(groom.locks.points) - 1, bool)
    edges[groom.locks.offsets[1:-1] - 1] = False
    local = root_places(groom.locks, groom.scalp.points, groom.scalp.triangles)
    rest = np.linalg.norm(np.diff(groom.locks.points, axis=0), axis=1)[edges]
    for k, frame in enumerate(cache.frames):
        to_world = UsdGeom.Xformable(clip_stage.GetPrimAtPath("/ball/skin")).ComputeLocalToWorldTransform(frame)
        wanted = np.array([to_world.Transform(Gf.Vec3d(*(100.0 * place))) for place in local]) / 100.0
        same(cache.points[k][first], wanted, 2e-6, f"roots at frame {frame}")
        strain = np.linalg.norm(np.diff(cache.points[k], axis=0), axis=1)[edges] / rest
        reported = cache.statistics[k].get("max_strain", cache.statistics[k].get("max_stretch", 0.0))
        assert strain.max() < 1.1 or reported > 0.05, f"STRETCH {strain.max():.2f} at frame {frame}"
