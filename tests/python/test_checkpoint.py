"""Checkpoints: a killed run resumes to bit-identical frames; damaged files are detected."""

import os
import shutil
import signal
import subprocess
import sys
import time
from itertools import islice

import numpy as np
import pytest
from commands import edit
from halts import halts
from ringlet.api.shots import can_resume, run_inputs
from ringlet.cli.app import app
from ringlet.io import open_cache, read_cache, read_touches
from ringlet.sim import checkpoint
from small_example import write_example
from typer.testing import CliRunner

import ringlet

CONTACT = "\n[contact]\nradius = 1e-3\n"


def written(folder):
    """The small example with contact and 40 frames."""
    write_example(folder)
    shot = folder / "small.shot.toml"
    shot.write_text(shot.read_text().replace("[1, 4]", "[1, 40]") + CONTACT)
    return folder


@pytest.fixture
def folder(tmp_path):
    return written(tmp_path)


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    """The frames of an uninterrupted run."""
    folder = written(tmp_path_factory.mktemp("uninterrupted"))
    assert sim(folder).exit_code == 0 and not (folder / "cache.usdc.part").exists()
    return read_cache(folder / "cache.usdc").points


def sim(folder, *more):
    return CliRunner().invoke(app, ["sim", str(folder / "small.shot.toml"), "-o", str(folder / "cache.usdc"), *more])


def started(folder):
    """Starts the shot in its own process."""
    command = [
        sys.executable,
        "-c",
        "from ringlet.cli import main; main()",
        "sim",
        "small.shot.toml",
        "-o",
        "cache.usdc",
    ]
    return subprocess.Popen(
        command,
        cwd=folder,
        env={**os.environ, "OMP_NUM_THREADS": "1"},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


def killed(folder, until):
    """Runs the shot and kills it when ``until`` holds."""
    process = started(folder)
    while process.poll() is None and not until():
        time.sleep(0.002)
    assert process.poll() is None, "the run ended before the kill"
    process.send_signal(signal.SIGKILL)
    process.wait()


def test_a_killed_run_resumes_to_bit_identical_frames(folder, expected):
    part = folder / "cache.usdc.part"
    killed(folder, lambda: (part / "memory.000020").exists())
    assert not (folder / "cache.usdc").exists()
    before = {path.name: path.stat().st_mtime_ns for path in part.glob("step.*")}
    result = sim(folder, "--resume")
    assert result.exit_code == 0 and len(before) >= 20
    assert (read_cache(folder / "cache.usdc").points == expected).all()
    assert not part.exists()


def test_another_machine_goes_on_with_a_copy_of_the_folder(folder, tmp_path_factory, expected):
    killed(folder, lambda: (folder / "cache.usdc.part/memory.000020").exists())
    other = tmp_path_factory.mktemp("other") / "place"
    folder.rename(other)
    inputs = run_inputs(ringlet.read_shot(other / "small.shot.toml"), ringlet.load_groom(other / "small.recipe.toml"))
    assert can_resume(other / "cache.usdc.part", inputs)
    assert sim(other, "--resume").exit_code == 0
    assert (read_cache(other / "cache.usdc").points == expected).all()


def test_larger_scenes_are_saved_more_often(folder, monkeypatch):
    groom = ringlet.build_groom(ringlet.read_recipe(folder / "small.recipe.toml"))
    vertices = len(groom.locks.points)
    assert checkpoint.frames_between(0) == checkpoint.frames_between(vertices) == checkpoint.EVERY
    assert checkpoint.frames_between(10_000 * 100) == checkpoint.frames_between(10**8) == 1
    monkeypatch.setattr(checkpoint, "VERTICES", 3 * vertices)
    interrupted(folder, monkeypatch, 8)
    memories = (folder / "cache.usdc.part").glob("memory.*")
    assert sorted(path.name for path in memories) == ["memory.000003", "memory.000006"]


def interrupted(folder, monkeypatch, after, *more):
    """Runs the shot until the disk is full."""
    write_step = checkpoint.Checkpoints.write_step

    def full(self, step, *rest):
        if step >= after:
            raise OSError(28, "No space left on device")
        write_step(self, step, *rest)

    with monkeypatch.context() as patch:
        patch.setattr(checkpoint.Checkpoints, "write_step", full)
        return sim(folder, *more)


def test_a_run_resumes_after_a_full_disk(folder, monkeypatch, expected):
    result = interrupted(folder, monkeypatch, 25)
    assert result.exit_code == 2
    assert "No space left" in result.stderr and "--resume" in result.stderr
    assert sim(folder, "--resume").exit_code == 0
    assert (read_cache(folder / "cache.usdc").points == expected).all()


@pytest.mark.parametrize("damage", ["cut", "changed", "frame", "missing"])
def test_a_damaged_checkpoint_is_detected_and_the_previous_one_used(folder, monkeypatch, damage):
    shot, part = ringlet.read_shot(folder / "small.shot.toml"), folder / "cache.usdc.part"
    expected = ringlet.simulate(shot).points
    interrupted(folder, monkeypatch, 25)
    name = "step.000015" if damage in ("frame", "missing") else "memory.000020"
    content = (part / name).read_bytes()
    middle = len(content) // 2
    flipped = content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :]
    if damage == "missing":
        (part / name).unlink()
    else:
        (part / name).write_bytes(content[:middle] if damage == "cut" else flipped)
        with pytest.raises(checkpoint.DamagedError):
            checkpoint.read(part / name)
    steps = []
    cache = ringlet.simulate(shot, checkpoints=part, resume=True, progress=lambda *step: steps.append(step))
    assert next(done for name, done, _ in steps if name == "sim") == 10
    assert (cache.points == expected).all()


@pytest.fixture
def ended(folder, monkeypatch):
    """The example after a run of 12 frames whose cache is written, with its checkpoints in ``left``."""
    edit(folder / "small.shot.toml", "frames = [1, 40]", "frames = [1, 12]")
    monkeypatch.setattr(checkpoint, "VERTICES", 3 * 8 * 40)
    with monkeypatch.context() as patch:
        patch.setattr("ringlet.sim.discard", lambda folder: None)
        assert sim(folder).exit_code == 0
    (folder / "cache.usdc.part").rename(folder / "left")
    return folder


def end(part):
    with ringlet.hold_checkpoints(part):
        ringlet.discard_checkpoints(part)


def test_a_kill_while_checkpoints_are_removed_leaves_what_its_own_run_alone_resumes(ended):
    part, found = ended / "cache.usdc.part", []
    inputs = checkpoint.left_inputs(ended / "left")
    shutil.copytree(ended / "left", part)
    for _ in halts(lambda: end(part)):
        there = {path.name for path in part.iterdir()}
        assert there <= {"held"} or "made_from" in there
        for run in (inputs, {**inputs, "the first frame": 9}):
            shutil.copytree(part, ended / "copy")
            try:
                state = checkpoint.Checkpoints(ended / "copy", run).begin(resume=True)
            except ringlet.UserError as error:
                assert run is not inputs and "the first frame was 1" in str(error)
            else:
                found += [state[0]] if state else []
                assert state is None or run is inputs
            shutil.rmtree(ended / "copy")
    assert not part.exists() and sorted(found, reverse=True) == found and {*found} == {9, 6}


@pytest.mark.parametrize("has_cache", [True, False])
def test_a_run_killed_while_its_checkpoints_are_removed_is_resumed(ended, has_cache):
    cache, part = ended / "cache.usdc", ended / "cache.usdc.part"
    expected = read_cache(cache).points
    written = cache.stat().st_mtime_ns
    if not has_cache:
        cache.unlink()
    shutil.copytree(ended / "left", part)
    next(islice(halts(lambda: end(part)), 5, None))  # it is killed before its sixth call
    assert 0 < len([*part.glob("step.*")]) < 12
    result = sim(ended, "--resume")
    assert result.exit_code == 0 and not part.exists(), result.output
    assert (read_cache(cache).points == expected).all()
    assert (cache.stat().st_mtime_ns == written) == has_cache  # a cache that is whole is not made again


def test_resume_simulates_what_a_whole_cache_is_not_made_from(ended):
    cache = ended / "cache.usdc"
    written = [cache.stat().st_mtime_ns]
    edit(ended / "small.shot.toml", "frames = [1, 12]", "frames = [1, 10]")
    for _ in range(2):
        result = sim(ended, "--resume", "--json")
        assert result.exit_code == 0 and '"frames": 10' in result.stdout, result.output
        written.append(cache.stat().st_mtime_ns)
    assert written[0] < written[1] == written[2] and len(read_cache(cache).frames) == 10


def test_checkpoints_of_another_run_are_not_resumed(folder, monkeypatch):
    interrupted(folder, monkeypatch, 25)
    shot = folder / "small.shot.toml"
    shot.write_text(shot.read_text() + "friction = 0.1\n")
    result = sim(folder, "--resume")
    assert result.exit_code == 2 and "contact.friction was 0.3 and is 0.1" in result.stderr
    assert (folder / "cache.usdc.part").exists()
    assert sim(folder).exit_code == 0 and not (folder / "cache.usdc.part").exists()


def test_a_concurrent_run_on_the_same_files_is_refused(folder, expected):
    part, groom = folder / "cache.usdc.part", folder / "cache.groom.usdc"
    assert sim(folder, "--frames", "1:2").exit_code == 0
    with started(folder) as other:
        while not (part / "step.000000").exists():
            assert other.poll() is None
            time.sleep(0.01)
        other.send_signal(signal.SIGSTOP)
        written = groom.stat()
        refused = [sim(folder, *more) for more in ([], ["--resume"])]
        untouched = groom.stat()
        other.send_signal(signal.SIGCONT)
        assert other.wait(120) == 0
    assert all(one.exit_code == 2 and "belongs to a run in progress" in one.stderr for one in refused)
    assert (untouched.st_ino, untouched.st_mtime_ns) == (written.st_ino, written.st_mtime_ns)
    assert (read_cache(folder / "cache.usdc").points == expected).all()


def test_a_refused_groom_leaves_no_folder_and_keeps_an_existing_one(folder, monkeypatch):
    part, recipe = folder / "cache.usdc.part", folder / "small.recipe.toml"
    right = recipe.read_text()
    for left in (False, True):
        if left:
            recipe.write_text(right)
            interrupted(folder, monkeypatch, 25)
        recipe.write_text(right.replace("count = 8", "count = -8"))
        assert sim(folder).exit_code == 2
        assert part.exists() == left
    recipe.write_text(right)
    assert len([*part.glob("step.*")]) == 25
    assert sim(folder, "--resume").exit_code == 0 and not part.exists()


def test_a_run_without_resume_reports_the_frames_it_discards(folder, monkeypatch):
    for after, more, message in [(5, (), ""), (25, (), ""), (15, (), "keeps 20 frames"), (15, ("--resume",), "")]:
        result = interrupted(folder, monkeypatch, after, *more)
        begin = result.stderr.partition("groom:")[0]  # before the first stage
        assert message in begin and ("--resume goes on from there; without it" in begin) == bool(message)
    assert "keeps 10 frames" in sim(folder).stderr and not (folder / "cache.usdc.part").exists()
    assert "thrown away" not in sim(folder).stderr


def test_a_program_keeps_its_lock_on_a_folder_after_a_simulation(folder):
    part = folder / "cache.usdc.part"
    with ringlet.hold_checkpoints(part):
        ringlet.simulate(folder / "small.shot.toml", checkpoints=part)
        with started(folder) as other:
            assert other.wait(120) == 2
        with pytest.raises(ringlet.UserError, match="belongs to a run in progress"), ringlet.hold_checkpoints(part):
            pass
    assert sim(folder).exit_code == 0


def test_resume_without_checkpoints_simulates_from_the_start(folder, expected):
    assert sim(folder, "--resume").exit_code == 0
    assert (read_cache(folder / "cache.usdc").points == expected).all()


def test_a_file_of_arrays_round_trips(tmp_path):
    arrays = {"a": np.arange(6.0).reshape(2, 3), "b": np.array("text"), "c": np.zeros((0, 3), np.float32)}
    checkpoint.write(tmp_path / "some.000001", arrays)
    back = checkpoint.read(tmp_path / "some.000001")
    assert back.keys() == arrays.keys() and all((back[name] == arrays[name]).all() for name in arrays)


def test_an_interrupted_run_provides_its_finished_frames(folder, monkeypatch, expected):
    interrupted(folder, monkeypatch, 25)
    assert sim(folder, "--resume", "--frames", "1:18").exit_code == 0
    assert (read_cache(folder / "cache.usdc").points == expected[:18]).all()


def test_an_interrupted_short_run_resumes_as_a_longer_one(folder, monkeypatch, expected):
    text = (folder / "small.shot.toml").read_text()
    edit(folder / "small.shot.toml", "frames = [1, 40]", "frames = [1, 30]")
    interrupted(folder, monkeypatch, 25)
    (folder / "small.shot.toml").write_text(text)
    assert sim(folder, "--resume").exit_code == 0
    assert (read_cache(folder / "cache.usdc").points == expected).all()


def test_streamed_frames_equal_those_of_a_simulation_in_memory(folder):
    groom = ringlet.build_groom(folder / "small.recipe.toml")
    ringlet.write_groom(groom, folder / "groom.usdc")
    shot, path = ringlet.read_shot(folder / "small.shot.toml"), folder / "cache.usdc"
    written = ringlet.write_simulation(shot, groom, folder / "groom.usdc", path, checkpoints=folder / "part")
    assert written.frames == list(range(1, 41))
    ringlet.write_cache(ringlet.simulate(shot, groom), folder / "groom.usdc", folder / "at_once.usdc")
    cache, at_once = read_cache(path), read_cache(folder / "at_once.usdc")
    assert (cache.points == at_once.points).all() and (cache.frames == at_once.frames).all()
    assert cache.statistics == written.statistics and cache.start == written.start == at_once.start


def touches(folder):
    with open_cache(folder / "cache.usdc") as cache:
        return [read_touches(folder / "touches.usdc", frame)[0] for frame in cache.frames]


def test_contacts_before_an_interruption_are_kept_with_the_frames(folder, monkeypatch):
    option, shot = ("--contacts", str(folder / "touches.usdc")), folder / "small.shot.toml"
    shot.write_text(shot.read_text().replace("radius = 1e-3", "radius = 1e-2"))
    assert sim(folder, *option).exit_code == 0
    expected = touches(folder)
    assert any(len(frame.force) for frame in expected[:20])
    interrupted(folder, monkeypatch, 25, *option)
    assert sim(folder, "--resume", *option).exit_code == 0
    for frame, before in zip(touches(folder), expected, strict=True):
        for name in ("places", "force", "gap"):
            assert (getattr(frame, name) == getattr(before, name)).all()


def test_contacts_are_refused_for_frames_that_did_not_record_them(folder, monkeypatch):
    interrupted(folder, monkeypatch, 25)
    result = sim(folder, "--resume", "--contacts", str(folder / "touches.usdc"))
    assert result.exit_code == 2 and "did not keep what touched; leave out --contacts" in result.stderr
    assert sim(folder, "--resume").exit_code == 0
