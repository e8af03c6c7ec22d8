"""Wedges: every combination of settings runs once, survives killed workers and is compared."""

from __future__ import annotations

import json
import logging
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from commands import refused, run
from distributed import LocalCluster
from ringlet.farm.cluster import _client
from ringlet.farm.grid import choose, folder_name, make_tasks
from ringlet.farm.openjd import template
from ringlet.farm.page import distances, read_results
from ringlet.farm.task import Result, TaskOptions, run_task, write_result
from small_example import write_example

import ringlet

CONTACT = "\n[contact]\nradius = 1e-3\n"


@pytest.fixture
def shot(tmp_path) -> Path:
    """The small example with contact."""
    write_example(tmp_path)
    path = tmp_path / "small.shot.toml"
    path.write_text(path.read_text() + CONTACT)
    return path


def longer(shot: Path, frames: int) -> Path:
    shot.write_text(shot.read_text().replace("[1, 4]", f"[1, {frames}]"))
    return shot


def log_of(folder: Path) -> str:
    return (folder / "log.txt").read_text()


def test_unambiguous_names_of_settings_may_be_abbreviated():
    assert choose("strands.bend", "1,2").name == "strands.bend_scale"
    assert choose("contact.fric", [0.1]).place == ("contact", "friction")
    assert choose("collider[0].friction", [0.1]).place == ("collider", 0, "friction")
    with pytest.raises(ringlet.UserError, match="bend_scael is not a setting; did you mean 'bend_scale'"):
        choose("strands.bend_scael", [1])
    with pytest.raises(ringlet.UserError, match="s is not a setting"):
        choose("s.bend", [1])


def test_values_are_parsed_as_toml_or_text():
    assert choose("rest.mode", "none, lofted").values == ("none", "lofted")
    assert choose("forces.wind", "[0,0,0],[0,0,2.5]").values == ([0, 0, 0], [0, 0, 2.5])
    assert choose("contact.on", "true,false").values == (True, False)
    assert choose("name", '"a,b",c').values == ("a,b", "c")


def test_a_task_is_the_shot_with_its_settings_in_its_own_folder(shot, tmp_path):
    tasks = make_tasks(shot, [choose("strands.bend", "1,2"), choose("contact.friction", "0.1,0.3")], tmp_path / "out")
    assert [list(task.settings.values()) for task in tasks] == [[1, 0.1], [1, 0.3], [2, 0.1], [2, 0.3]]
    tasks[3].folder.mkdir(parents=True)
    (tasks[3].folder / "shot.toml").write_text(tasks[3].shot)
    read = ringlet.read_shot(tasks[3].folder / "shot.toml")
    assert (read.strands.bend_scale, read.contact.friction) == (2.0, 0.3)
    assert read.groom.resolve() == (tmp_path / "small.recipe.toml").resolve()


@pytest.mark.parametrize("value", ["../../x", "/etc/passwd", "..", "a\nb", "x" * 300, "\0", "ñ"])
def test_no_value_escapes_the_folder(value, tmp_path):
    name = folder_name({"name": value})
    assert (tmp_path / name).resolve().parent == tmp_path.resolve()
    assert len(name) <= 100 and name.isascii()
    assert folder_name({"name": value + "y"}) != name


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--set", "strands.bend"], ["strands.bend", "SETTING=VALUE"]),
        (["--set", "strands.bnd=1"], ["strands.bnd"]),
        (["--set", "strands.bend=1,-2"], ["small.shot.toml", "strands.bend_scale", "-2"]),
        (["--set", "collider[3].friction=1"], ["collider[3].friction", "3"]),
        (["--set", "strands.bend=1", "--set", "strands.bend_scale=2"], ["strands.bend_scale", "twice"]),
        (["--set", "strands.bend=1", "--scheduler", "tcp://127.0.0.1:1"], ["tcp://127.0.0.1:1", "dask scheduler"]),
        (["--compare"], ["no results"]),
        (["--set", "strands.bend=1", "--openjd", "x.yaml"], ["x.yaml", ".json"]),
    ],
)
def test_an_invalid_wedge_is_refused_before_a_task_runs(shot, tmp_path, monkeypatch, options, words):
    monkeypatch.setattr("ringlet.farm.cluster.PATIENCE", "1s")
    before = sorted(tmp_path.iterdir())
    refused(run("wedge", shot, *options, "-o", tmp_path / "out"), *words)
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize("here", [[], ["--here"]])
def test_an_unwritable_folder_is_refused_before_workers_start(shot, tmp_path, monkeypatch, here):
    for work in ("run_on_workers", "run_task"):
        monkeypatch.setattr(sys.modules["ringlet.farm.wedge"], work, lambda *_, **__: pytest.fail("work has started"))
    (tmp_path / "file").write_text("precious")
    before = sorted(tmp_path.iterdir())
    options = ["--set", "strands.bend=1", *here, "-o", tmp_path / "file/out"]
    refused(run("wedge", shot, *options), str(tmp_path / "file/out"), "cannot be written", "choose another place")
    assert sorted(tmp_path.iterdir()) == before and (tmp_path / "file").read_text() == "precious"


def test_local_workers_use_a_free_port_of_localhost(recwarn):
    with socket.socket() as taken:
        with suppress(OSError):  # it may be in use already
            taken.bind(("127.0.0.1", 8787))
            taken.listen()
        with _client(None, 1, 0) as client:
            page = client.cluster.scheduler.http_server
            assert page.address == "127.0.0.1" and page.port != 8787
    assert not [warning for warning in recwarn if "8787" in str(warning.message)]


def test_a_worker_that_is_killed_while_it_starts_is_reported_in_one_line(shot, tmp_path, monkeypatch):
    monkeypatch.setattr("multiprocessing.spawn._python_exe", b"/bin/false")  # a worker that ends at once
    result = run("wedge", shot, "--set", "strands.bend_scale=1,2", "-o", tmp_path / "out", "--workers", "1")
    refused(result, "wedge: a worker ended while it started", "--here")


def test_missing_dask_is_refused_with_remedies(shot, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    refused(run("wedge", shot, "--set", "strands.bend=1", "-o", tmp_path / "out"), "ringlet[farm]", "--here")


def test_the_page_compares_tasks_and_finished_tasks_are_kept(shot, tmp_path, monkeypatch):
    monkeypatch.setattr("ringlet.farm.task.PICTURE", {"width": 42, "height": 47, "samples": 1})
    choices = ["--set", "strands.bend=1,8", "--here", "-o", tmp_path / "out"]
    output = json.loads(run("wedge", shot, *choices, "--json").stdout)
    assert [task["state"] for task in output["tasks"]] == ["done", "done"]
    page = Path(output["page"]).read_text()
    assert page.count("data:image/jpeg;base64,") == 2 and "strands.bend_scale = 8" in page
    assert not re.search(r"(src|href)=.(?!data:|#)", page)  # self-contained
    compared = json.loads((tmp_path / "out/wedge.json").read_text())["tasks"]
    assert compared[0]["away"] == 0.0 < compared[1]["away"]
    caches = {path: path.stat().st_mtime_ns for path in (tmp_path / "out").glob("*/cache.usdc")}
    assert len(caches) == 2
    assert run("wedge", shot, "--set", "strands.bend=1,8,2", "--no-picture", *choices[2:]).exit_code == 0
    assert [result.settings["strands.bend_scale"] for result in read_results(tmp_path / "out").values()] == [1, 2, 8]
    again = run("wedge", shot, "--set", "strands.bend=2", "--no-picture", *choices[2:])
    assert again.exit_code == 0 and log_of(tmp_path / "out/strands.bend_scale=2").count("is done already") == 1
    shot.write_text(shot.read_text() + "friction = 0.9\n")
    assert run("wedge", shot, "--set", "strands.bend=2", "--no-picture", *choices[2:]).exit_code == 0
    assert log_of(tmp_path / "out/strands.bend_scale=2").count("simulates frames") == 2  # the shot has changed


def test_a_refused_task_does_not_stop_the_others(shot, tmp_path):
    result = run("wedge", shot, "--set", "held=3,60", "--here", "--no-picture", "-o", tmp_path / "out")
    assert result.exit_code == 1
    states = {result.settings["held"]: result for result in read_results(tmp_path / "out").values()}
    assert states[3].state == "done" and states[60].state == "refused" and "held is 60" in states[60].message
    assert "held is 60" in (tmp_path / "out/wedge.html").read_text()


def test_tasks_keep_the_order_of_texts_and_sort_numbers(shot, tmp_path):
    choices = [choose("rest.mode", "none,lofted,equilibrium"), choose("strands.bend", [2, 10])]
    tasks = make_tasks(shot, choices, tmp_path / "out")
    for task in reversed(tasks):
        task.folder.mkdir(parents=True)
        write_result(task.folder, Result(task.settings, "refused", order=task.order))
    assert list(read_results(tmp_path / "out")) == [task.folder for task in tasks]


def test_positions_are_compared_with_the_first_task(tmp_path):
    for k, shift in enumerate((0.0, 3.0)):
        folder = tmp_path / f"{k}"
        folder.mkdir()
        np.save(folder / "places.npy", np.zeros((5, 3), np.float32) + np.float32([0, shift, 0]))
        write_result(folder, Result({"k": k}, "done"))
    assert distances(read_results(tmp_path)) == {tmp_path / "0": 0.0, tmp_path / "1": pytest.approx(3.0)}


@pytest.mark.parametrize("here", [True, False])
def test_a_task_of_a_concurrent_run_is_refused_and_its_folder_unchanged(shot, tmp_path, here):
    own = tmp_path / "out/strands.bend_scale=1"
    own.mkdir(parents=True)
    with ringlet.hold_checkpoints(own / "cache.usdc.part"):
        for values, done in (("1", []), ("1,2", ["done"])) if here else (("1,2", ["done"]),):  # workers start slowly
            options = ["--set", f"strands.bend={values}", "--no-picture", *(["--here"] if here else ["--workers", "1"])]
            other = run("wedge", shot, "-o", tmp_path / "out", *options)
            assert other.exit_code == 1 and "belongs to a run in progress" in " ".join(other.stdout.split())
            assert [path.name for path in own.rglob("*")] == ["cache.usdc.part", "held"]
            assert [result.state for result in read_results(tmp_path / "out").values()] == done
    last = run("wedge", shot, "--set", "strands.bend=1,2", "--no-picture", "--here", "-o", tmp_path / "out")
    assert last.exit_code == 0


def kill_worker(part: Path, log: Path, killed: list[int]) -> None:
    """Kills the process of a task once it has saved some frames."""
    end = time.monotonic() + 120
    while time.monotonic() < end and not killed:
        if any(int(path.suffix[1:]) >= 20 for path in part.glob("memory.*")):
            killed.append(int(re.findall(r" (\d+) begins", log.read_text())[-1]))
            os.kill(killed[0], signal.SIGKILL)
        time.sleep(0.002)


def test_a_killed_worker_repeats_only_its_task(shot, tmp_path):
    longer(shot, 100)
    folder, killed = tmp_path / "out", []
    victim, other = folder / "strands.bend_scale=1", folder / "strands.bend_scale=2"
    killer = threading.Thread(target=kill_worker, args=(victim / "cache.usdc.part", victim / "log.txt", killed))
    killer.start()
    results = ringlet.wedge(shot, {"strands.bend": [1, 2]}, folder, picture=False, workers=2)
    killer.join()
    assert killed and [result["state"] for result in results] == ["done", "done"]
    processes = re.findall(r" (\d+) begins", log_of(victim))
    assert len(processes) == 2 and int(processes[0]) == killed[0] != int(processes[1])
    assert "goes on with frames 1:100" in log_of(victim)
    assert log_of(other).count("begins") == 1
    expected = tmp_path / "expected"
    alone = make_tasks(shot, [choose("strands.bend", [1])], expected)[0]
    run_task(alone, TaskOptions(picture=False))
    assert (np.load(victim / "places.npy") == np.load(alone.folder / "places.npy")).all()
    assert (
        ringlet.read_cache(victim / "cache.usdc").points == ringlet.read_cache(alone.folder / "cache.usdc").points
    ).all()


def test_an_existing_scheduler_is_used_and_left_running(shot, tmp_path):
    with LocalCluster(
        n_workers=1, threads_per_worker=1, dashboard_address="127.0.0.1:0", silence_logs=logging.ERROR
    ) as cluster:
        address = cluster.scheduler_address
        for value in (1, 2):
            result = run(
                "wedge",
                shot,
                "--set",
                f"strands.bend={value}",
                "--no-picture",
                "--scheduler",
                address,
                "-o",
                tmp_path / "out",
            )
            assert result.exit_code == 0, result.output
    assert [result.state for result in read_results(tmp_path / "out").values()] == ["done", "done"]


def test_a_failing_task_is_abandoned_and_reported(shot, tmp_path):
    (tmp_path / "out/strands.bend_scale=2/log.txt").mkdir(parents=True)  # prevents the log file
    options = ["--no-picture", "--retries", 1, "--workers", 1]
    result = run("wedge", shot, "--set", "strands.bend=1,2", *options, "-o", tmp_path / "out")
    assert result.exit_code == 1
    found = {result.settings["strands.bend_scale"]: result.state for result in read_results(tmp_path / "out").values()}
    assert found == {1: "done", 2: "failed"}


@pytest.fixture
def job(shot, tmp_path) -> Path:
    """An Open Job Description of two combinations."""
    sets = ["--set", "strands.bend=2", "--set", 'name="a, b","c"']
    assert run("wedge", shot, *sets, "--no-picture", "--openjd", tmp_path / "wedge.template.json").exit_code == 0
    return tmp_path / "wedge.template.json"


def openjd(*arguments: object) -> subprocess.CompletedProcess[str]:
    command = shutil.which("openjd", path=str(Path(sys.executable).parent))
    if command is None:
        pytest.skip("openjd-cli is not installed")
    return subprocess.run([command, *map(str, arguments)], capture_output=True, text=True)


def test_open_job_description_is_valid(job):
    check = openjd("check", job)
    assert check.returncode == 0, check.stdout


def test_open_job_description_runs_every_combination(job, shot, tmp_path):
    out = tmp_path / "out"
    ringlet_command = Path(sys.executable).with_name("ringlet")
    parameters = [f"-pShot={shot}", f"-pFolder={out}", f"-pRinglet={ringlet_command}"]
    done = openjd("run", job, *parameters)
    assert done.returncode == 0, done.stdout[-3000:]
    settings = [list(result.settings.values()) for result in read_results(out).values()]
    assert settings == [[2, "a, b"], [2, "c"]]
    assert (out / "wedge.html").exists()


def test_the_template_has_the_options_of_the_command():
    job = template(Path("a.shot.toml"), [choose("strands.bend", "1,2")], TaskOptions((2, 9), 5, False, 4))
    words = job["steps"][0]["script"]["actions"]["onRun"]["args"]
    assert words[-7:] == ["--frames", "2:9", "--frame", "5", "--threads", "4", "--no-picture"]
    assert "--set=strands.bend_scale={{Task.Param.strands_bend_scale}}" in words
    assert job["steps"][1]["dependencies"] == [{"dependsOn": "Simulate"}]
