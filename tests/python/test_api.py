"""The public API, and the program of the README."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from small_example import write_example

import ringlet

ROOT = Path(__file__).parents[2]


def test_the_program_of_the_readme_runs(tmp_path, monkeypatch):
    program = re.search(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)[1]
    lines = [line for line in program.splitlines() if line.strip()]
    assert len(lines) <= 12

    # The same program on a small head and for a small picture.
    small = write_example(tmp_path / "examples/child")
    (small / "small.recipe.toml").rename(small / "curls.recipe.toml")
    (small / "small.shot.toml").rename(small / "nod.shot.toml")
    monkeypatch.chdir(tmp_path)
    assert '"still.png", frame=24' in program
    exec(program.replace('"still.png", frame=24', '"still.png", frame=24, width=48, height=64, samples=1'), {})

    assert {"groom.usdc", "cache.usdc", "hair.usdc", "still.png"} <= {file.name for file in tmp_path.iterdir()}


def test_every_public_name_is_there_and_documented():
    for name in ringlet.__all__:
        assert name == "__version__" or getattr(ringlet, name).__doc__, name


def test_progress_ends_at_the_whole(tmp_path):
    heard = []
    ringlet.build_groom(write_example(tmp_path) / "small.recipe.toml", progress=lambda *step: heard.append(step))
    ended = {stage: done == total for stage, done, total in heard}
    assert {"guides", "locks", "curl", "clean"} <= ended.keys() and all(ended.values())


def test_a_groom_made_in_memory_says_what_a_simulation_lacks(tmp_path):
    example = write_example(tmp_path)
    groom = ringlet.build_groom(example / "small.recipe.toml")
    groom.scalp_file = None
    with pytest.raises(ringlet.UserError, match="scalp"):
        ringlet.simulate(example / "small.shot.toml", groom)


def test_a_run_times_its_stages_and_refuses_a_bad_place_before_the_work(tmp_path):
    (tmp_path / "file").touch()
    with ringlet.Run("test") as run:
        with run.stage("one"):
            pass
        with pytest.raises(ringlet.UserError, match="cannot be written"), run.stage("two", tmp_path / "file/out.usdc"):
            raise AssertionError("the work was begun")
    assert [stage.name for stage in run.stages] == ["one"]
    assert run.stages[0].wall >= 0


def test_checking_a_place_leaves_nothing_behind(tmp_path):
    with ringlet.Run("test") as run, pytest.raises(ZeroDivisionError), run.stage("one", tmp_path / "a/b/c.usdc"):
        raise ZeroDivisionError
    assert list(tmp_path.iterdir()) == []
