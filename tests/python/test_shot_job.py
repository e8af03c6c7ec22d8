"""A whole shot as a job of render farms: run here by Open Job Description, and as Tractor and Deadline read it."""

from __future__ import annotations

import json
import shlex
import subprocess
import sys
import time
from pathlib import Path

import pytest
from commands import refused, run
from pxr import Gf, Usd, UsdGeom
from ringlet.farm.job import Job
from ringlet.farm.shot_job import shot_job
from ringlet.farm.tractor import tcl
from small_example import write_example

import ringlet

RINGLET = Path(sys.executable).with_name("ringlet")
OPENJD = Path(sys.executable).with_name("openjd")
CAMERA = "/groom/body/camera"  # in the stage of the hairs
LOOK = {"Camera": CAMERA, "Width": 60, "Samples": 1}


@pytest.fixture
def shot(tmp_path) -> Path:
    """The small example in a folder with a space in its name, seen by a camera of the head's file."""
    folder = tmp_path / "a project"
    folder.mkdir()
    write_example(folder)
    stage = Usd.Stage.Open(str(folder / "head.usda"))
    UsdGeom.Camera.Define(stage, "/ball/camera").AddTranslateOp().Set(Gf.Vec3d(0.0, 0.0, 60.0))
    stage.Save()
    return folder / "small.shot.toml"


@pytest.fixture
def job(shot) -> Job:
    """The job of the small example with lofted rest shapes."""
    shot.write_text(shot.read_text() + '\n[rest]\nmode = "lofted"\n')
    return shot_job(shot, None, shot.parent / "out", (1, 3), LOOK, "png")


def farm(shot: Path, output: Path, *more: object):
    look = ("--camera", CAMERA, "--width", 60, "--samples", 1)
    return run("farm", shot, "-o", output, "--folder", shot.parent / "out", *look, *more)


def commands(job: Job) -> list[tuple[str, list[str]]]:
    """Every task of a job: the name of its step and its words."""
    first, last = job.frames
    return [
        (step.name, step.command(job.texts(str(frame))))
        for step in job.steps
        for frame in (range(first, last + 1) if step.by_frame else [0])
    ]


def openjd(*words: object) -> subprocess.CompletedProcess[str]:
    if not OPENJD.exists():
        pytest.skip("openjd-cli is not installed")
    return subprocess.run([OPENJD, *map(str, words)], capture_output=True, text=True)


def test_a_shot_runs_from_its_recipe_to_hairs_and_pictures_of_its_frames(shot, job):
    template, folder = shot.with_name("shot.json"), shot.parent / "out"
    assert "Groom, Rest, Simulate, Hair, Points, Render" in farm(shot, template).output
    assert (check := openjd("check", template)).returncode == 0, check.stdout
    done = openjd("run", template, f"-pRinglet={RINGLET}", "-pFrames=1-3:2")
    assert done.returncode == 0, done.stdout[-3000:]
    assert sorted(one.name for one in (folder / "pictures").iterdir()) == ["1.png", "3.png"]
    assert sorted(one.name for one in (folder / "points").iterdir()) == ["1.usdc", "3.usdc"]
    with ringlet.open_cache(folder / "cache.usdc") as cache:
        assert cache.frames.tolist() == [1, 2, 3, 4]
    points = Usd.Stage.Open(str(folder / "points/3.usdc"))
    assert UsdGeom.BasisCurves.Get(points, "/groom/hairs").GetPointsAttr().GetTimeSamples() == [3]


def test_the_template_lists_what_a_farm_brings_and_what_it_takes_away(shot, job):
    farm(shot, template := shot.with_name("shot.json"))
    made = json.loads(template.read_text())
    paths = {one["name"]: one for one in made["parameterDefinitions"] if one["type"] == "PATH"}
    flows = {name: (one["default"], one["dataFlow"]) for name, one in paths.items()}
    assert flows == {
        "Shot": ("small.shot.toml", "IN"),
        "Recipe": ("small.recipe.toml", "IN"),
        "head_usda": ("head.usda", "IN"),
        "Rest": ("small.rest.usdc", "OUT"),
        "Groom": ("out/groom.usdc", "OUT"),
        "Cache": ("out/cache.usdc", "OUT"),
        "Hair": ("out/hair.usdc", "OUT"),
        "Points": ("out/points", "OUT"),
        "Pictures": ("out/pictures", "OUT"),
    }
    simulate = next(step for step in made["steps"] if step["name"] == "Simulate")
    assert simulate["description"] == "Reads Shot, Groom, head_usda, Rest. Writes Cache."
    assert simulate["dependencies"] == [{"dependsOn": "Rest"}]


def test_a_step_reads_what_was_given_or_made_before_it(job):
    made = {name for step in job.steps for name in step.writes}
    there = set(job.files) - made
    for step in job.steps:
        assert set(step.reads) <= there, step.name
        there |= set(step.writes)
    assert there == set(job.files)


def test_tractor_reads_the_same_tasks(shot, job):
    farm(shot, script := shot.with_name("shot.alf"), "--frames", "1:3")
    tree = read_tractor(script)
    assert tree["-serialsubtasks"] == "1"
    assert [step["title"] for step in tree["tasks"]] == [step.name for step in job.steps]
    found = [(step["title"], one) for step in tree["tasks"] for one in (step.get("tasks") or [step])]
    assert [(name, one["words"]) for name, one in found] == [
        (name, ["ringlet", *words]) for name, words in commands(job)
    ]
    assert all(one["-maxrunsecs"] == str(7 * 24 * 3600) for name, one in found if name == "Simulate")
    assert "-serialsubtasks" not in tree["tasks"][-1]  # frames are in parallel


@pytest.mark.parametrize("word", ["plain", "a b", "a{b", "a}b c", "$a", "[x]", "a\\b", 'a"b', "", "ä #;"])
def test_words_stay_what_they_are_in_tcl(word):
    interpreter = pytest.importorskip("tkinter").Tcl()
    assert interpreter.splitlist(f"a {tcl(word)} b") == ("a", word, "b")
    assert interpreter.eval(f"set a {tcl(word)}") == word


def test_deadline_reads_the_same_tasks(shot, job):
    farm(shot, folder := shot.with_name("shot.deadline"), "--frames", "1:3")
    first, second, *files = (folder / "submit.txt").read_text().splitlines()
    assert (first, second, len(files)) == ("-SubmitMultipleJobs", "-dependent", 3 * len(job.steps))
    found = []
    for k, step in enumerate(job.steps):
        flag, *pair = files[3 * k : 3 * k + 3]
        info, plugin = (dict(line.split("=", 1) for line in Path(file).read_text().splitlines()) for file in pair)
        assert (flag, info["Plugin"], info["Name"], info["ChunkSize"]) == ("-job", "CommandLine", step.name, "1")
        assert info["TaskTimeoutSeconds"] == str(step.hours * 3600)
        first, _, last = info["Frames"].partition("-")
        for frame in range(int(first), int(last or first) + 1):
            words = shlex.split(plugin["Arguments"].replace("<STARTFRAME>", str(frame)))
            found.append((step.name, words))
    assert found == commands(job)


def test_a_shot_of_a_groom_without_rest_shapes_has_no_steps_for_them(shot):
    assert run("groom", shot.with_name("small.recipe.toml"), "-o", shot.with_name("groom.usdc")).exit_code == 0
    shot.write_text(shot.read_text().replace("small.recipe.toml", "groom.usdc"))
    template = shot.with_name("a.json")
    assert "json: Simulate, Hair, Points, Render." in farm(shot, template).output
    files = [one.get("default") for one in json.loads(template.read_text())["parameterDefinitions"]]
    assert {"groom.usdc", "head.usda"} <= set(files)
    refused(farm(shot, shot.with_name("a.yaml")), "a.yaml", ".json", ".alf", ".deadline")


def test_farms_of_open_job_description_read_the_progress():
    sessions = pytest.importorskip("openjd.sessions")
    heard: list[float] = []

    def hear(_: str, status) -> None:
        if status.progress is not None:
            heard.append(status.progress)

    code = "from ringlet.cli import progress\nprogress.SECONDS_BETWEEN_LINES = 0\nwith progress.in_lines() as report:\n"
    code += "  for done in range(5): report('hairs', done, 4)"
    with sessions.Session(session_id="a", job_parameter_values={}, callback=hear) as session:
        env = {"RINGLET_PROGRESS": "openjd"}
        session.run_subprocess(command=sys.executable, args=["-c", code], os_env_vars=env)
        deadline = time.monotonic() + 60.0
        while session.state == sessions.SessionState.RUNNING and time.monotonic() < deadline:
            time.sleep(0.05)
        assert session.action_status is not None
        assert session.action_status.exit_code == 0
    assert sorted(set(heard)) == [0.0, 25.0, 50.0, 75.0, 100.0]


def read_tractor(path: Path) -> dict:
    """A job of Tractor as Tcl reads it: options by name, tasks within tasks, words of commands."""
    interpreter = pytest.importorskip("tkinter").Tcl()

    def parsed(text: str) -> list[dict]:
        made: list[dict] = []

        def take(*words: str) -> str:
            kind, *rest = words
            values = {} if rest[0].startswith("-") else {"title": rest.pop(0)}
            values |= dict(zip(rest[::2], rest[1::2], strict=True))
            made.append({"kind": kind, **values})
            return ""

        for kind in ("Job", "Task", "RemoteCmd"):
            interpreter.createcommand(kind, lambda *words, kind=kind: take(kind, *words))
        interpreter.eval(text)
        for one in made:
            if one["kind"] == "RemoteCmd":
                one["words"] = list(interpreter.splitlist(one.pop("title")))
            if "-subtasks" in one:
                one["tasks"] = parsed(one["-subtasks"])
            for command in parsed(one.get("-cmds", "")):
                one |= {name: value for name, value in command.items() if name != "kind"}
        return made

    (job,) = parsed(path.read_text())
    return job
