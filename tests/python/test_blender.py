"""Exchange with Blender in both directions.

Needs bpy in a separate environment, since it is large and pins libraries: make blender.
"""

from __future__ import annotations

import os
import sys
import zipfile
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from blender import MISSING, PYTHON, build_extension, run
from ringlet.io import HairWriter, read_curves, read_hairs, read_space, write_cache, write_groom
from usd_scenes import hairs_of, make_groom, write_head

from ringlet import Cache, convert, write_hairs

pytestmark = pytest.mark.skipif(not PYTHON.exists(), reason=MISSING)


@pytest.fixture(params=[(0.01, "Y"), (1.0, "Z")], ids=["cm-Y", "m-Z"])
def groom(tmp_path, request):
    """A groom, a cache in which the locks rise 0.01 m a frame, and hairs of the cache."""
    unit, axis = request.param
    head = write_head(tmp_path / "head.usdc", unit=unit, axis=axis)
    groom = make_groom(head)
    groom.guides.ids[:] = 4_711_000_003, -1 - 4_711_000_003  # Blender has no 64-bit integer attributes
    write_groom(groom, tmp_path / "groom.usdc")
    rise = np.array([[0, 0.01 * k, 0] for k in range(3)], np.float32)
    moved = (groom.locks.points + rise[:, None]).astype(np.float32)
    cache = Cache(np.array([1.0, 2.0, 3.0]), moved)
    write_cache(cache, tmp_path / "groom.usdc", tmp_path / "cache.usdc", read_space(head))
    hairs = hairs_of(groom)
    with HairWriter(tmp_path / "hair.usdc", groom, hairs, tmp_path / "cache.usdc") as writer:
        for k in range(3):
            writer.add(k + 1.0, hairs.points + rise[k])
    return groom


@pytest.fixture(scope="module")
def extension(tmp_path_factory) -> Path:
    """A folder with the extension as a package."""
    folder = tmp_path_factory.mktemp("extension")
    with zipfile.ZipFile(build_extension(folder)) as file:
        file.extractall(folder / "ringlet_groom")
    return folder


@pytest.fixture
def blender(extension, tmp_path):
    """Returns the Blender scene after an action on files (tests/python/in_blender.py)."""
    return lambda *arguments: run("in_blender.py", tmp_path / "scene.json", extension, *arguments)


def z_up(points: np.ndarray) -> np.ndarray:
    """Points with Y up in the Z-up frame of Blender."""
    return np.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1)


def test_blender_reads_curves_attributes_units_and_motion(groom, blender, tmp_path):
    scene, hairs = blender("plain", tmp_path / "hair.usdc"), hairs_of(groom)
    assert (scene["fps"], scene["range"]) == (24, [1, 3])
    for name, curves in (("locks", groom.locks), ("hairs", hairs)):
        seen = scene["objects"][name]
        assert seen["counts"] == curves.counts.tolist()
        assert seen["kinds"] == [0]  # Catmull-Rom
        for k in range(3):
            there = z_up(curves.points + [0, 0.01 * k, 0])
            np.testing.assert_allclose(seen["frames"][str(k + 1)], there, atol=1e-6)
        radius = np.array(seen["attributes"]["radius"][1]) * seen["scale"][0]
        np.testing.assert_allclose(radius, curves.point["width"] / 2, rtol=1e-4)
        uv = np.einsum("kc,kcx->kx", curves.curve["root_barycentric"], groom.scalp.uv[curves.curve["root_triangle"]])
        for attribute, expected in {
            "groom_id": curves.ids if name == "hairs" else np.arange(5),
            "skinprim": groom.scalp.faces[curves.curve["root_triangle"]],
            "st": uv,
            "surface_uv_coordinate": uv,
            "groom_guide": np.full(len(curves), name == "locks"),
        }.items():
            domain, values = seen["attributes"][attribute]
            assert domain == "CURVE"
            np.testing.assert_allclose(values, expected, atol=1e-6, err_msg=attribute)
    domain, rest = scene["objects"]["locks"]["attributes"]["rest"]
    assert domain == "POINT" and len(rest) == len(groom.locks.points)
    domain, lock = scene["objects"]["hairs"]["attributes"]["guide_curve_index"]
    assert domain == "CURVE" and lock == hairs.curve["lock"].tolist()


@pytest.mark.skipif(find_spec("alembic3d") is None, reason="alembic3d is not installed: pip install 'ringlet[alembic]'")
def test_blender_reads_curves_head_and_motion_of_alembic(groom, blender, tmp_path):
    convert(tmp_path / "hair.usdc", tmp_path / "hair.abc")
    objects, hairs = blender("alembic", tmp_path / "hair.abc")["objects"], hairs_of(groom)
    for name, curves in (("guides", groom.locks), ("hairs", hairs)):
        for k in range(3):
            there = 100.0 * z_up(curves.points + [0, 0.01 * k, 0])  # Blender takes centimetres as its units
            np.testing.assert_allclose(objects[name]["frames"][str(k + 1)], there, atol=1e-4)
    slid = np.array(objects["skin"]["frames"]["3"]) - objects["skin"]["frames"]["1"]
    np.testing.assert_allclose(slid, np.tile([2.0, 0, 0], (len(slid), 1)), atol=1e-4)


def test_the_add_on_sets_the_surface_and_plays_the_file(groom, blender, tmp_path):
    objects = blender("add-on", tmp_path / "hair.usdc")["objects"]
    for name in ("locks", "guides", "hairs"):
        assert (objects[name]["surface"], objects[name]["uv_map"]) == ("skin", "st")
    assert [objects[name]["hidden"] for name in ("locks", "guides", "hairs")] == [True, True, False]
    first, last = (np.array(objects["hairs"]["frames"][frame]) for frame in ("1", "3"))
    np.testing.assert_allclose(last - first, np.tile([0, 0, 0.02], (len(first), 1)), atol=1e-6)


def test_the_add_on_expands_hairs_on_demand(pipeline, extension, tmp_path):
    made = tmp_path / "demand.usdc"
    write_hairs(pipeline / "cache.usdc", made, on_demand=True)
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    objects = run("in_blender.py", tmp_path / "scene.json", extension, "add-on", made, PATH=path)["objects"]
    assert [objects[name]["hidden"] for name in ("locks", "guides", "hairs")] == [True, True, False]
    for frame in (1, 3):
        points = z_up(read_hairs(pipeline / "hair.usdc", frame).points)
        np.testing.assert_allclose(objects["hairs"]["frames"][str(frame)], points, atol=1e-5)


def test_the_add_on_plays_a_cache_on_a_groom(groom, blender, tmp_path):
    still = blender("add-on", tmp_path / "groom.usdc")["objects"]
    moving = blender("add-on", tmp_path / "groom.usdc", tmp_path / "cache.usdc")["objects"]
    assert not moving["locks"]["hidden"]
    for frame in (1, 2, 3):
        np.testing.assert_allclose(still["locks"]["frames"][str(frame)], z_up(groom.locks.points), atol=1e-6)
        risen = z_up(groom.locks.points + [0, 0.01 * (frame - 1), 0])
        np.testing.assert_allclose(moving["locks"]["frames"][str(frame)], risen, atol=1e-6)
        slid = np.array(moving["skin"]["frames"][str(frame)]) - moving["skin"]["frames"]["1"]
        np.testing.assert_allclose(slid, np.tile([0.01 * (frame - 1), 0, 0], (len(slid), 1)), atol=1e-6)


def test_the_add_on_refuses_other_files_and_leaves_the_scene_unchanged(groom, blender, tmp_path):
    scene = blender("refused", tmp_path / "nowhere.usdc", tmp_path / "head.usdc")
    assert "there is no such file" in scene["no file"]
    assert "head.usdc: is not a Ringlet groom" in scene["no groom"]
    assert "There is no groom in the scene" in scene["no groom to play"]
    assert "use 99.1 or later" in scene["too old"]
    assert scene["objects"] == 0


def test_guides_return_from_blender_with_their_names(groom, blender, tmp_path):
    blender("back", tmp_path / "groom.usdc", tmp_path / "edited.usdc")
    back = read_curves(tmp_path / "edited.usdc")
    assert back.ids.tolist() == groom.guides.ids.tolist()
    assert back.counts.tolist() == groom.guides.counts.tolist()
    moved = groom.guides.points + np.array([read_space(tmp_path / "groom.usdc").meters_per_unit, 0, 0])
    np.testing.assert_allclose(back.points, moved, atol=1e-6)
