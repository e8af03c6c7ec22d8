"""A whole shot as a job of Open Job Description, run here."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from commands import refused, run
from pxr import Gf, Usd, UsdGeom
from small_example import write_example

import ringlet

RINGLET = Path(sys.executable).with_name("ringlet")
OPENJD = Path(sys.executable).with_name("openjd")
CAMERA = "/groom/body/camera"  # in the stage of the hairs


@pytest.fixture
def shot(tmp_path) -> Path:
    """The small example, seen by a camera of the head's file."""
    folder = tmp_path / "project"
    folder.mkdir()
    write_example(folder)
    stage = Usd.Stage.Open(str(folder / "head.usda"))
    UsdGeom.Camera.Define(stage, "/ball/camera").AddTranslateOp().Set(Gf.Vec3d(0.0, 0.0, 60.0))
    stage.Save()
    return folder / "small.shot.toml"


def openjd(*words: object) -> subprocess.CompletedProcess[str]:
    if not OPENJD.exists():
        pytest.skip("openjd-cli is not installed")
    return subprocess.run([OPENJD, *map(str, words)], capture_output=True, text=True)


def test_a_shot_runs_from_its_recipe_to_pictures_of_its_frames(shot, tmp_path):
    job, folder = tmp_path / "shot.template.json", tmp_path / "out"
    shot.write_text(shot.read_text() + '\n[rest]\nmode = "lofted"\n')
    folder.mkdir()
    assert "Groom, Rest, Simulate, Hair, Render" in run("sim", shot, "--openjd", job).output
    assert (check := openjd("check", job)).returncode == 0, check.stdout
    given = {"Shot": shot, "Groom": shot.with_name("small.recipe.toml"), "Folder": folder, "Ringlet": RINGLET}
    given |= {"Camera": CAMERA, "Frames": "1-3:2", "Width": 60, "Samples": 1}
    done = openjd("run", job, *(f"-p{name}={value}" for name, value in given.items()))
    assert done.returncode == 0, done.stdout[-3000:]
    assert sorted(one.name for one in (folder / "frames").iterdir()) == ["1.png", "3.png"]
    assert "openjd_progress: 100.0" in done.stdout
    with ringlet.open_cache(folder / "cache.usdc") as cache:
        assert cache.frames.tolist() == [1, 2, 3, 4]


def test_a_shot_of_a_groom_without_rest_shapes_has_no_steps_for_them(shot, tmp_path):
    assert run("groom", shot.with_name("small.recipe.toml"), "-o", shot.with_name("groom.usdc")).exit_code == 0
    shot.write_text(shot.read_text().replace("small.recipe.toml", "groom.usdc"))
    assert ringlet.write_shot_template(tmp_path / "a.json", shot) == ["Simulate", "Hair", "Render"]
    refused(run("sim", shot, "--openjd", tmp_path / "a.yaml"), "a.yaml", ".json")
