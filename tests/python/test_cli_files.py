"""Commands on files, from a recipe to hairs."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from commands import edit, made, refused, run
from pxr import Usd, UsdGeom
from ringlet.api.caches import scalp_clip
from ringlet.api.run import FREE
from ringlet.sim.roots import Roots
from small_example import FRAMES

import ringlet


@pytest.mark.parametrize(("unit", "size"), [(1.0, "18 m"), (0.001, "0.018 m")])
def test_a_head_of_implausible_size_is_reported(copy, unit, size):
    stage = Usd.Stage.Open(str(copy / "head.usda"))
    UsdGeom.SetStageMetersPerUnit(stage, unit)
    stage.Save()
    result = run("groom", copy / "small.recipe.toml", "-o", copy / "groom.usdc")
    assert result.exit_code == 0
    assert f"warning: the scalp is {size} across" in result.stderr and "metersPerUnit" in result.stderr


def printed(pipeline: Path, name: str) -> dict:
    return json.loads((pipeline / f"{name}.json").read_text())


def test_hairs_of_a_long_cache_are_made_with_a_few_frames_in_memory(pipeline, tmp_path):
    groom, frames, hair = ringlet.read_groom(pipeline / "groom.usdc"), 500, tmp_path / "hair.usdc"
    points = carried(groom, FRAMES).astype(np.float32)  # the head stands still from there on
    shapes = np.broadcast_to(points, (frames, *points.shape))
    cache = ringlet.Cache(np.arange(FRAMES, FRAMES + frames, dtype=np.float64), shapes)
    ringlet.write_cache(cache, pipeline / "groom.usdc", pipeline / "long.usdc")
    tracemalloc.start()
    counts = ringlet.write_hairs(pipeline / "groom.usdc", hair, cache=pipeline / "long.usdc")
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert counts["frames"] == frames
    assert peak < 0.5 * shapes.nbytes
    with ringlet.open_cache(hair) as back:  # a layer over the cache
        assert back.points(frames).shape == points.shape


def carried(groom, frame):
    """The groomed locks on the head at a frame."""
    return Roots(groom).carry(scalp_clip(groom).at(frame), frame)


def hairs_at(file, frame):
    """Points of the hairs of a file at a frame, shape (n, 3)."""
    stage = Usd.Stage.Open(str(file))
    return np.array(UsdGeom.BasisCurves(stage.GetPrimAtPath("/groom/hairs")).GetPointsAttr().Get(frame))


def test_hairs_of_a_cache_alone_equal_those_of_groom_and_cache(pipeline, tmp_path):
    groom, cache = pipeline / "groom.usdc", tmp_path / "cache.usdc"
    points = [carried(ringlet.read_groom(groom), frame) for frame in (1, 2, 3)]
    ringlet.write_cache(ringlet.Cache(np.arange(1.0, 4), np.stack(points)), groom, cache)
    alone, by_both = tmp_path / "alone.usdc", tmp_path / "both.usdc"
    assert run("hair", str(cache), "-o", str(alone), "--frames", "2:3").exit_code == 0
    assert run("hair", str(groom), "--cache", str(cache), "-o", str(by_both), "--frames", "2:3").exit_code == 0
    second, third = ([hairs_at(file, frame) for file in (alone, by_both)] for frame in (2, 3))
    assert np.array_equal(*second) and np.array_equal(*third)
    assert not np.array_equal(second[0], third[0])


def test_frames_of_static_hairs_are_refused(pipeline, tmp_path):
    result = run("hair", str(pipeline / "groom.usdc"), "-o", str(tmp_path / "hair.usdc"), "--frames", "2:3")
    refused(result, "groom.usdc", "2:3", "cache")
    assert not (tmp_path / "hair.usdc").exists()


def test_groom_reports_its_output(pipeline):
    groom = ringlet.read_groom(pipeline / "groom.usdc")
    assert printed(pipeline, "groom") == {
        "path": str(pipeline / "groom.usdc"),
        "bytes": (pipeline / "groom.usdc").stat().st_size,
        "guides": 6,
        "locks": len(groom.locks),
        "points": len(groom.locks.points),
        "conflicts": [],
    }
    assert len(groom.locks) == 8


def test_an_obj_head_is_static_and_locks_touch_it(copy):
    mesh = ringlet.read_groom(made(copy)).scalp
    corners = [f"f {a} {b} {c}" for a, b, c in (mesh.triangles + 1).tolist()]
    lines = [f"v {x} {y} {z}" for x, y, z in (100 * mesh.points).tolist()] + corners  # in centimetres
    (copy / "head.obj").write_text("\n".join(lines))
    edit(copy / "small.recipe.toml", 'file = "head.usda"\nregion = "scalp"', 'file = "head.obj"\nunit = "cm"')
    (copy / "small.shot.toml").write_text((copy / "small.shot.toml").read_text() + "[contact]\nradius = 2e-3\n")
    result = run("sim", copy / "small.shot.toml", "-o", copy / "cache.usdc")
    assert result.exit_code == 0, result.output
    cache, groom = ringlet.read_cache(copy / "cache.usdc"), ringlet.read_groom(copy / "cache.groom.usdc")
    roots = cache.points[:, groom.locks.offsets[:-1]]
    assert np.abs(roots - roots[0]).max() < 1e-6 and np.abs(np.linalg.norm(roots, axis=2) - 0.09).max() < 0.01
    assert np.linalg.norm(cache.points[-1], axis=1).min() > 0.085  # no lock penetrates the ball


def test_sim_writes_every_frame_and_the_locks_follow_the_scalp(pipeline):
    cache, groom = ringlet.read_cache(pipeline / "cache.usdc"), ringlet.read_groom(pipeline / "groom.usdc")
    assert printed(pipeline, "cache")["frames"] == FRAMES
    assert cache.frames.tolist() == list(range(1, FRAMES + 1))
    roots = cache.points[:, groom.locks.offsets[:-1]]
    # The head rotates by 5° a frame about the vertical, so roots keep their height.
    angle = np.radians(5 * (FRAMES - 1))
    x, z = roots[0, :, 0], roots[0, :, 2]
    turned = np.stack([np.cos(angle) * x + np.sin(angle) * z, -np.sin(angle) * x + np.cos(angle) * z], axis=1)
    np.testing.assert_allclose(roots[-1][:, [0, 2]], turned, atol=1e-5)
    np.testing.assert_allclose(roots[-1][:, 1], roots[0][:, 1], atol=1e-5)


def test_hair_has_the_hairs_of_every_lock_in_every_frame(pipeline):
    assert printed(pipeline, "hair")["hairs"] == 3 * 8
    stage = Usd.Stage.Open(str(pipeline / "hair.usdc"))
    points = UsdGeom.BasisCurves(stage.GetPrimAtPath("/groom/hairs")).GetPointsAttr()
    assert points.GetTimeSamples() == list(range(1, FRAMES + 1))


def test_frames_can_be_chosen(pipeline, tmp_path):
    result = run("sim", pipeline / "small.shot.toml", "-o", tmp_path / "cache.usdc", "--frames", "2:3", "--json")
    assert result.exit_code == 0, result.output
    assert ringlet.read_cache(tmp_path / "cache.usdc").frames.tolist() == [2, 3]


def test_every_cache_of_a_recipe_has_a_groom_beside_it(copy):
    shot, recipe = copy / "small.shot.toml", copy / "small.recipe.toml"
    for suffix, points in (("usda", 40), ("usdc", 36), ("usd", 32)):
        edit(recipe, "points = 40", f"points = {points}")
        assert run("sim", shot, "-o", copy / f"cache.{suffix}", "--frames", "1:2").exit_code == 0
        edit(recipe, f"points = {points}", "points = 40")
    for suffix, points in (("usda", 40), ("usdc", 36), ("usd", 32)):
        made = ["hair", copy / f"cache.groom.{suffix}", "--cache", copy / f"cache.{suffix}", "-o", copy / "h.usdc"]
        assert run(*made).exit_code == 0
        assert ringlet.read_cache(copy / f"cache.{suffix}").points.shape == (2, 8 * points, 3)


def test_without_json_the_output_is_one_line(pipeline, tmp_path):
    result = run("groom", pipeline / "small.recipe.toml", "-o", tmp_path / "groom.usdc")
    assert len(result.stdout.splitlines()) == 1
    assert "8 locks" in result.stdout


def test_a_report_is_written_to_the_requested_folder(pipeline, tmp_path):
    result = run("sim", pipeline / "small.shot.toml", "-o", tmp_path / "cache.usdc", "--report", tmp_path / "report")
    assert result.exit_code == 0, result.output
    report = json.loads((tmp_path / "report/report.json").read_text())
    assert report["name"] == "sim"
    assert len(report["statistics"]) == FRAMES
    assert [stage["name"] for stage in report["stages"]] == ["groom", "simulate"]
    assert "<html" in (tmp_path / "report/report.html").read_text()
    assert report["limits"] == [FREE]


def test_a_report_without_a_simulation_states_no_limit_of_contact(pipeline, tmp_path):
    result = run(
        "groom", pipeline / "small.recipe.toml", "-o", tmp_path / "groom.usdc", "--report", tmp_path / "report"
    )
    assert result.exit_code == 0, result.output
    assert json.loads((tmp_path / "report/report.json").read_text())["limits"] == []


def test_the_installed_command_writes_a_groom_and_refuses_a_missing_file(copy):
    command = Path(sys.executable).with_name("ringlet")
    done = subprocess.run([command, "groom", "small.recipe.toml"], cwd=copy, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert (copy / "groom.usdc").exists()
    failed = subprocess.run([command, "groom", "none.toml"], cwd=copy, capture_output=True, text=True)
    assert failed.returncode == 2
    assert failed.stdout == ""
    assert len(failed.stderr.splitlines()) == 1


@pytest.mark.parametrize("place", ["small.recipe.toml", "out.usdc"])
@pytest.mark.parametrize(
    ("name", "words"),
    [
        (os.fsdecode(b"caf\xe9"), ": has a name that is not in UTF-8; rename the file"),
        ("n" * 300, "File name too long"),
        (f"{'d' * 250}/" * 20 + "x", "File name too long"),
        ("loop/a", "cannot be written (File exists)"),
    ],
)
def test_a_name_that_no_file_can_have_is_refused_with_a_remedy(copy, monkeypatch, place, name, words):
    monkeypatch.chdir(copy)
    (copy / "loop").symlink_to("loop")
    paths = {"small.recipe.toml": "small.recipe.toml", "out.usdc": "out.usdc", place: f"{name}{Path(place).suffix}"}
    message = refused(run("groom", paths["small.recipe.toml"], "-o", paths["out.usdc"]))
    assert words in message or (place == "small.recipe.toml" and "cannot be read" in message)
    assert re.search(r"; [a-z ]+$", message) and len(message) < 1100


def test_output_goes_to_a_terminal_without_unicode(copy):
    command = [sys.executable, "-c", "from ringlet.cli.app import main; main()", "schema", "recipe"]
    result = subprocess.run(command, env={**os.environ, "PYTHONIOENCODING": "ascii"}, capture_output=True)
    assert result.returncode == 0 and json.loads(result.stdout)
