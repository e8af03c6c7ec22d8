"""The command ``loft``, its file, and when the file is stale."""

import json
from functools import partial

import numpy as np
import pytest
from ringlet.cli.app import app
from ringlet.io import read_rest
from small_example import write_example
from typer.testing import CliRunner

import ringlet
from ringlet import picture

LOFTED = "\n[rest]\nmode = 'lofted'\niterations = 6\n"


@pytest.fixture
def folder(tmp_path):
    """The small example with a lofted rest shape."""
    write_example(tmp_path)
    shot = tmp_path / "small.shot.toml"
    shot.write_text(shot.read_text() + LOFTED)
    return tmp_path


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def change(folder, old, new, file="small.shot.toml"):
    text = (folder / file).read_text()
    assert old in text
    (folder / file).write_text(text.replace(old, new))


def drift(folder):
    """Distance of lock vertices from the groomed shape after preroll and the first frame, shape (n,) [m]."""
    shot = folder / "small.shot.toml"
    cache = ringlet.simulate(shot, frames=(1, 1))
    groomed = ringlet.build_groom(folder / "small.recipe.toml").locks.points
    return np.linalg.norm(cache.points[0] - groomed, axis=1)


def test_a_lofted_shot_begins_nearer_to_its_groom(folder):
    change(folder, "preroll = 0", "preroll = 30")
    assert run("loft", folder / "small.shot.toml").exit_code == 0
    assert (folder / "small.rest.usdc").exists()
    lofted = drift(folder)
    change(folder, "mode = 'lofted'", "mode = 'none'")
    assert lofted.mean() < 0.2 * drift(folder).mean()


@pytest.mark.parametrize(("mode", "used"), [("none", False), ("lofted", True)])
def test_an_unused_rest_shape_is_reported(folder, mode, used):
    change(folder, "mode = 'lofted'", f"mode = '{mode}'")
    result = run("loft", folder / "small.shot.toml")
    assert result.exit_code == 0 and ("does not use this shape" in result.stdout) is not used


def test_the_report_compares_the_sag_with_and_without_loft(folder, monkeypatch):
    monkeypatch.setattr(picture, "compare", partial(picture.compare, tile=(140, 160), samples=2))
    result = run("loft", folder / "small.shot.toml", "-o", folder / "a.usdc", "--json", "--report", folder / "out")
    output = json.loads(result.stdout)
    assert output["locks"] == 8 and output["lost"]["away"]["with mean"] < output["lost"]["away"]["without mean"]
    report = json.loads((folder / "out/report.json").read_text())
    assert [len(row) for row in report["tables"][0]["rows"]] == [4] * 6
    assert "What gravity takes" in (folder / "out/report.html").read_text()
    assert (folder / "out/loft.png").stat().st_size > 20_000


def test_a_missing_loft_is_refused_with_the_command_that_makes_it(folder):
    result = run("sim", folder / "small.shot.toml", "-o", folder / "cache.usdc")
    assert result.exit_code == 2
    assert "small.rest.usdc" in result.stderr and "ringlet loft" in result.stderr
    assert not (folder / "cache.usdc").exists()


@pytest.mark.parametrize(
    ("old", "new", "file", "words"),
    [
        (
            "preroll = 0",
            "preroll = 0\nstrands = { bend_scale = 2 }",
            "small.shot.toml",
            ["strands.bend_scale", "1.0", "2"],
        ),
        ("preroll = 0", "preroll = 0\nforces = { gravity = [0, -5, 0] }", "small.shot.toml", ["forces.gravity", "-5"]),
        ("preroll = 0", "preroll = 0\nvariation = { bend = 2 }", "small.shot.toml", ["8 of 8 locks"]),
        ("width = 1.0", "width = 1.1", "small.recipe.toml", ["8 of 8 locks"]),
    ],
)
def test_a_stale_loft_is_refused_in_one_line_unless_allowed(folder, old, new, file, words):
    shot = folder / "small.shot.toml"
    assert run("loft", shot).exit_code == 0
    change(folder, old, new, file)
    result = run("sim", shot, "-o", folder / "cache.usdc")
    message = result.stderr.strip().splitlines()[-1]
    assert result.exit_code == 2
    for word in ["is stale", "ringlet loft", "--allow-stale", *words]:
        assert word in message
    assert run("sim", shot, "-o", folder / "cache.usdc", "--allow-stale").exit_code == 0


def test_unrelated_settings_do_not_make_a_loft_stale(folder):
    shot = folder / "small.shot.toml"
    assert run("loft", shot).exit_code == 0
    change(
        folder,
        "preroll = 0",
        "preroll = 2\nname = 'other'\nsolver = { newton = 7, substeps = 2, linear_tolerance = 0.02 }",
    )
    assert run("sim", shot, "-o", folder / "cache.usdc").exit_code == 0
    assert run("groom", folder / "small.recipe.toml", "-o", folder / "groom.usdc").exit_code == 0  # in single precision
    assert run("sim", shot, "--groom", folder / "groom.usdc", "-o", folder / "cache.usdc").exit_code == 0


def test_a_loft_of_other_locks_is_always_refused(folder):
    shot = folder / "small.shot.toml"
    assert run("loft", shot).exit_code == 0
    change(folder, "count = 8", "count = 9", "small.recipe.toml")
    result = run("sim", shot, "-o", folder / "cache.usdc", "--allow-stale")
    assert result.exit_code == 2 and "other locks" in result.stderr


def test_only_changed_locks_are_lofted_again(folder):
    shot, file = ringlet.read_shot(folder / "small.shot.toml"), folder / "small.rest.usdc"
    groom = ringlet.build_groom(folder / "small.recipe.toml")
    ringlet.write_loft(ringlet.loft(shot, groom), shot, file)
    before, _ = read_rest(file)
    rows = slice(groom.locks.offsets[3] + 3, groom.locks.offsets[4])
    groom.locks.points[rows] += np.linspace(0, 2e-3, rows.stop - rows.start)[:, None]
    steps = []
    again = ringlet.loft(shot, groom, known=file, progress=lambda *step: steps.append(step))
    complete = ringlet.loft(shot, groom)
    assert steps
    same = np.ones(len(groom.locks.points), bool)
    same[groom.locks.offsets[3] : groom.locks.offsets[4]] = False
    assert (again.rest.points[same] == before.points[same]).all()
    assert np.abs(again.rest.points - complete.rest.points).max() < 1e-5
    assert np.abs(complete.rest.points - before.points)[~same].max() > 1e-4
    ringlet.write_loft(again, shot, file)
    steps.clear()
    ringlet.loft(shot, groom, known=file, progress=lambda *step: steps.append(step))
    assert not steps


def test_a_shot_in_equilibrium_stays_as_groomed_and_stores_its_stiffening(folder):
    change(folder, "preroll = 0", "preroll = 24\nstrands = { bend_scale = 0.2 }")
    change(folder, "mode = 'lofted'", "mode = 'equilibrium'")
    assert run("loft", folder / "small.shot.toml").exit_code == 0
    rest, _ = read_rest(folder / "small.rest.usdc")
    assert rest.curve["stiffened"].max() > 1.0
    assert drift(folder).max() < 1e-5
    change(folder, "mode = 'equilibrium'", "mode = 'lofted'")
    result = run("sim", folder / "small.shot.toml", "-o", folder / "cache.usdc")
    assert result.exit_code == 2 and "rest.mode was equilibrium and is lofted" in result.stderr


def test_a_rest_shape_in_contact_is_stale_after_a_change_of_contact(folder):
    change(folder, "mode = 'lofted'", "mode = 'equilibrium'")
    shot = folder / "small.shot.toml"
    shot.write_text(shot.read_text() + "[contact]\nradius = 1e-3\n")
    assert run("loft", shot).exit_code == 0
    assert run("sim", shot, "-o", folder / "cache.usdc").exit_code == 0
    change(folder, "radius = 1e-3", "radius = 2e-3")
    result = run("sim", shot, "-o", folder / "cache.usdc")
    assert result.exit_code == 2 and "contact.radius was 0.001 and is 0.002" in result.stderr
