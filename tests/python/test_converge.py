"""``ringlet converge``: the same frames at several settings, compared with a run that converges."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from commands import refused, run
from small_example import write_example

import ringlet


@pytest.fixture(scope="module")
def example(tmp_path_factory):
    folder = tmp_path_factory.mktemp("converge")
    write_example(folder)
    return folder


def test_more_iterations_come_nearer_to_the_converged_motion(example):
    found = ringlet.converge(example / "small.shot.toml", frames=(1, 4))
    assert found.frames == (1, 4)
    assert [trial.newton for trial in found.trials] == sorted(trial.newton for trial in found.trials)
    shot = ringlet.read_shot(example / "small.shot.toml")
    assert (found.shipped.newton, found.shipped.linear_tolerance) == (shot.solver.newton, shot.solver.linear_tolerance)
    assert found.converged.kept == 1.0 and found.converged.off == 0.0
    off = [trial.off for trial in found.trials]
    assert off[-1] < off[0] and found.trials[-1].kept == pytest.approx(1.0, abs=0.02)
    assert all(len(trial.motion) == 3 and len(trial.tips) == 4 and trial.tips[0] < 1e-12 for trial in found.trials)
    advised = found.advised
    assert advised is not None and advised.kept >= 0.95
    assert all(trial.kept < 0.95 or trial.cpu_ms >= advised.cpu_ms for trial in found.trials)
    found.enough = 1.5
    assert found.advised is None and "No setting keeps 150 %" in ringlet.convergence_table(found)[2]


def test_every_setting_begins_in_the_same_state(example):
    """Up to the first frame the shot's own setting is used: its trial is the shot."""
    shot, groom = ringlet.read_shot(example / "small.shot.toml"), example / "small.recipe.toml"
    found = ringlet.converge(shot, groom, frames=(2, 4))
    points = ringlet.simulate(shot, groom, frames=(1, 4)).points.astype(np.float64)
    expected = ringlet.lock_motion(points[1:], ringlet.build_groom(groom).locks.offsets)
    assert found.shipped.motion == pytest.approx(expected, rel=1e-3)


def test_strands_that_cores_carry_are_compared_as_they_are_written(tmp_path):
    case = Path(shutil.copytree(Path(__file__).parents[1] / "cases" / "core_braid_stretch", tmp_path / "case"))
    shot, groom = ringlet.read_shot(case / "s.shot.toml"), ringlet.build_groom(case / "r.recipe.toml")
    found = ringlet.converge(shot, groom, frames=(2, 4))
    points = ringlet.simulate(shot, groom, frames=(1, 4)).points.astype(np.float64)
    assert found.shipped.motion == pytest.approx(ringlet.lock_motion(points[1:], groom.locks.offsets), rel=1e-3)
    assert found.shipped.tips == pytest.approx(ringlet.tip_distance(points[1:], groom.locks.offsets), abs=1e-6)


def test_the_command_writes_a_page_and_says_what_to_set(example):
    result = run("converge", example / "small.shot.toml", "--frames", "1:3", "-o", example / "converge.html")
    assert result.exit_code == 0, result.output
    assert "the shot's" in result.stdout and "% of the converged motion" in result.stdout
    html = (example / "converge.html").read_text()
    assert "Tips, from where they began" in html and "<svg" in html
    output = json.loads(run("converge", example / "small.shot.toml", "--frames", "1:3", "--json").stdout)
    assert output["frames"] == [1, 3] and output["shipped"]["kept"] > 0.0 and output["path"] is None


@pytest.mark.parametrize("frames", ["3:3", "0:4", "1:900"])
def test_frames_outside_the_shot_are_refused(example, frames):
    refused(run("converge", example / "small.shot.toml", "--frames", frames), "frames", frames.split(":")[1])
