"""The public API and the program of the README."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from small_example import write_example, write_head

import ringlet
from ringlet import io

ROOT = Path(__file__).parents[2]


def test_the_program_of_the_readme_runs(tmp_path, monkeypatch):
    program = re.search(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)[1]
    lines = [line for line in program.splitlines() if line.strip()]
    assert len(lines) <= 12

    # The program on the small example, with a smaller picture.
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


def test_progress_ends_at_its_total(tmp_path):
    steps = []
    ringlet.build_groom(write_example(tmp_path) / "small.recipe.toml", progress=lambda *step: steps.append(step))
    ended = {stage: done == total for stage, done, total in steps}
    assert {"guides", "locks", "curl", "collide"} <= ended.keys() and all(ended.values())


def test_a_groom_in_memory_reports_what_a_simulation_lacks(tmp_path):
    example = write_example(tmp_path)
    groom = ringlet.build_groom(example / "small.recipe.toml")
    groom.scalp_file = None
    with pytest.raises(ringlet.UserError, match="scalp"):
        ringlet.simulate(example / "small.shot.toml", groom)


@pytest.mark.parametrize(("unit", "up", "head"), [(0.01, "Y", "usda"), (0.0254, "Z", "usda"), (1.0, "Z", "obj")])
def test_a_recipe_and_its_written_groom_simulate_bit_identically(tmp_path, unit, up, head):
    example = write_example(tmp_path)
    write_head(example / "head.usda", unit=unit, up=up)
    if head == "obj":
        write_obj(example, unit, up)
    shot = example / "small.shot.toml"
    ringlet.write_groom(ringlet.build_groom(example / "small.recipe.toml"), example / "groom.usdc")

    made = [ringlet.simulate(shot, example / name).points for name in ("small.recipe.toml", "groom.usdc")]
    assert made[0].shape[0] > 1 and np.array_equal(*made)
    recipe, groom = (ringlet.load_groom(example / name) for name in ("small.recipe.toml", "groom.usdc"))
    lofts = [ringlet.loft(shot, groom).rest.points for groom in (recipe, groom)]
    assert not np.array_equal(recipe.locks.points, groom.locks.points) and np.array_equal(*lofts)


def write_obj(example, unit, up):
    """Replaces the USD head by an OBJ with coordinates that single precision cannot represent."""
    head = io.read_mesh(example / "head.usda")
    points = head.points * (1.0 + 1e-9) / unit
    if up == "Z":
        points = points[:, [0, 2, 1]] * (1, -1, 1)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    lines += ["f " + " ".join(map(str, triangle + 1)) for triangle in head.triangles]
    (example / "head.obj").write_text("\n".join(lines))
    recipe = (example / "small.recipe.toml").read_text().replace('region = "scalp"', f'unit = "m"\nup = "{up}"')
    (example / "small.recipe.toml").write_text(recipe.replace("head.usda", "head.obj"))


def test_a_run_times_its_stages_and_refuses_an_unwritable_path_first(tmp_path):
    (tmp_path / "file").touch()
    with ringlet.Run("test") as run:
        with run.stage("one"):
            pass
        with pytest.raises(ringlet.UserError, match="cannot be written"), run.stage("two", tmp_path / "file/out.usdc"):
            raise AssertionError("the stage has run")
    assert [stage.name for stage in run.stages] == ["one"]
    assert run.stages[0].wall >= 0


def test_checking_an_output_path_leaves_no_file(tmp_path):
    with ringlet.Run("test") as run, pytest.raises(ZeroDivisionError), run.stage("one", tmp_path / "a/b/c.usdc"):
        raise ZeroDivisionError
    assert list(tmp_path.iterdir()) == []


def test_the_scripts_find_the_modules_that_they_import():
    for script in (ROOT / "tools").glob("*.sh"):
        for line in set(re.findall(r"from ringlet[\w.]* import [\w, ]+", script.read_text())):
            exec(line, {})
