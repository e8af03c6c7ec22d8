"""A shot frame by frame in Python: frames as arrays, progress that is cancelled, and what notebooks show."""

from __future__ import annotations

import re
import threading
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest
from ringlet.data.curves import Curves
from ringlet.data.sketch import CURVES, sketch
from ringlet.data.toml import tables_of
from small_example import FRAMES, write_example

import ringlet

ROOT = Path(__file__).parents[2]
PACKAGE = Path(ringlet.__file__).parent


@pytest.fixture(scope="module")
def example(tmp_path_factory):
    return write_example(tmp_path_factory.mktemp("example"))


def test_the_program_of_the_notebook_page_runs(example, tmp_path, monkeypatch, capsys):
    program = re.search(r"```python\n(.*?)```", (ROOT / "docs/notebook.md").read_text(), re.DOTALL)[1]
    assert len([line for line in program.splitlines() if line.strip()]) <= 40
    monkeypatch.setenv("MPLBACKEND", "agg")
    monkeypatch.chdir(tmp_path)
    program = program.replace("examples/child/ringlets", str(example / "small"))
    program = program.replace("[1, 24]", "[1, 3]").replace("26 mm", "8 mm")
    made = {}
    exec(program, made)
    assert (tmp_path / "hang.png").stat().st_size > 1000
    written = ringlet.read_cache(tmp_path / "wide_moves.usdc")
    np.testing.assert_allclose(written.points, made["simulation"].cache.points, atol=1e-6)
    assert np.ptp(made["hang"], axis=0).max() > 1e-4  # it moves
    assert "Groom(8 locks and 6 guides" in capsys.readouterr().out


def test_frames_one_by_one_are_those_of_a_whole_run(example):
    whole = ringlet.simulate(example / "small.shot.toml")
    simulation = ringlet.Simulation(example / "small.shot.toml")
    np.testing.assert_array_equal(simulation.positions, simulation.groom.locks.points)
    assert len(simulation.cache.frames) == 0
    first = next(simulation)
    np.testing.assert_array_equal(simulation.positions, whole.points[0])
    assert (first.number, len(simulation.cache.frames)) == (1.0, 1)
    rest = [frame.number for frame in simulation]  # goes on where it was
    assert rest == [2.0, 3.0, 4.0] and next(simulation, None) is None
    np.testing.assert_array_equal(simulation.cache.points, whole.points)
    assert simulation.cache.frames.tolist() == whole.frames.tolist()
    assert len(simulation.cache.statistics) == FRAMES


def test_a_cancelled_job_ends_the_work_and_leaves_the_frames_before(example):
    job = ringlet.Job()
    simulation = ringlet.Simulation(example / "small.shot.toml", progress=job)
    next(simulation)
    assert (job.stage, job.done, job.total, job.fraction) == ("sim", 1, FRAMES, 0.25)
    assert repr(job) == "Job(sim: 1 of 4)" and 'value="1" max="4"' in job._repr_html_()
    job.cancel()
    with pytest.raises(ringlet.Cancelled, match="cancelled in sim, after 2 of 4"):
        next(simulation)
    assert simulation.cache.frames.tolist() == [1.0]


def test_a_job_is_cancelled_from_another_thread(example):
    job, ended = ringlet.Job(), []

    def work():
        try:
            ringlet.simulate(example / "small.shot.toml", frames=(1, 400), progress=job)
        except ringlet.Cancelled as error:
            ended.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    while job.stage != "sim" and thread.is_alive():
        thread.join(0.01)
    job.cancel()
    thread.join(60)
    assert len(ended) == 1 and job.done < 400


def test_settings_by_name_take_the_place_of_those_of_the_file(example):
    recipe, shot = example / "small.recipe.toml", example / "small.shot.toml"
    changed = ringlet.read_recipe(recipe, {"curl.width": "8 mm", "locks.count": np.int64(5)})
    assert changed.curl.width.value == 0.008 and changed.curl.pitch.value == 0.015
    assert len(ringlet.build_groom(changed).locks) == 5
    assert ringlet.read_recipe(recipe, {}).curl.width.value == 0.01
    moved = ringlet.read_shot(shot, {"strands.damping": np.float64(0.3), "frames": [1, 2]})
    assert (moved.strands.damping, moved.frames, moved.groom) == (0.3, (1, 2), example / "small.recipe.toml")
    assert ringlet.read_shot(shot).frames == (1, FRAMES)
    for read, file in ((ringlet.read_recipe, recipe), (ringlet.read_shot, shot)):
        with pytest.raises(ringlet.UserError, match="is not a setting"):
            read(file, {"nonsense.width": 1})
    assert tables_of({"a.b": 1, "a.c": 2, "d": 3}) == {"a": {"b": 1, "c": 2}, "d": 3}


def test_reprs_are_short_and_say_what_is_there(example):
    groom = ringlet.build_groom(example / "small.recipe.toml")
    simulation = ringlet.Simulation(example / "small.shot.toml", groom)
    frame, clip = next(simulation), ringlet.Clip(np.array([1.0, 2.0]), np.zeros((2, 5, 3)), 24.0)
    assert repr(groom) == "Groom(8 locks and 6 guides on head.usda /ball/skin)"
    assert repr(groom.locks) == "Curves(8 curves, 320 points; curve: root_barycentric, root_triangle)"
    assert repr(groom.scalp).startswith("Mesh('head.usda /ball/skin', ") and len(repr(groom.scalp)) < 80
    assert repr(frame) == "Frame(1, 320 points)" and repr(clip) == "Clip(frames 1 to 2, 5 points, 24 fps)"
    assert repr(simulation) == "Simulation(8 locks, frames 1 to 4, 1 done)"
    assert repr(simulation.cache) == "Cache(frames 1 to 1, 320 points)"


def test_a_notebook_draws_each_curve_where_it_is():
    curves = Curves.from_list([np.array([[0.0, 0, 0], [0, -0.1, 0]]), np.array([[0.2, 0, 0.1], [0.2, -0.1, 0.1]])])
    html = curves._repr_html_()
    assert html.startswith("<p>Curves(2 curves, 4 points)</p><svg")
    drawing = ElementTree.fromstring(html[html.index("<svg") :])
    paths = [path.get("d") for path in drawing.iter("{http://www.w3.org/2000/svg}path") if path.get("d")]
    assert paths[:2] == ["M1.0 1.0L1.0 121.0", "M241.0 1.0L241.0 121.0"]  # far, then near, from the front
    many = np.zeros((2 * 5000, 3)) + np.repeat(np.arange(5000.0), 2)[:, None]
    assert sketch(many, np.arange(0, 10001, 2)).count("M") == 2 * CURVES  # both views
    assert sketch(np.empty((0, 3)), np.zeros(1, np.int32)) == ""


def test_the_package_is_typed_and_its_names_are_the_public_ones():
    assert (PACKAGE / "py.typed").exists()
    assert set(dir(ringlet)) | {"__version__"} == set(ringlet.__all__)
    assert not [name for name in dir(ringlet) if name.startswith("_")]
