"""Ends are atomic: a kill before any call that changes files leaves the former result or the new one.

What each kill leaves is taken from a single run, which is halted before its calls.
"""

from __future__ import annotations

import re
import shutil
import stat
from collections.abc import Callable
from itertools import groupby
from pathlib import Path

import pytest
from commands import edit, run
from halts import halts
from ringlet.data.files import replacing
from ringlet.viewer import protocol
from ringlet.viewer.files.conflicts import differences
from ringlet.viewer.project import Project
from ringlet.viewer.session import Session
from ringlet.viewer.show.grooming import Grooming

import ringlet

RECIPE, SHOT = "small.recipe.toml", "small.shot.toml"
ASIDE = re.compile(r"\..*\.\d+(\.\w+)?$")  # with the number of its process
Files = dict[str, tuple[int, bytes]]  # mode and content of the files in a folder and below, by path


@pytest.fixture
def inputs(pipeline, tmp_path, monkeypatch) -> Path:
    """A copy of the small example with its groom and its cache, as the current folder."""
    shutil.copytree(pipeline, tmp_path / "copy")
    monkeypatch.chdir(tmp_path / "copy")
    return tmp_path / "copy"


def files(folder: Path) -> Files:
    found = [path for path in sorted(folder.rglob("*")) if path.is_file()]
    return {str(path.relative_to(folder)): (stat.S_IMODE(path.stat().st_mode), path.read_bytes()) for path in found}


def restore(folder: Path, kept: Files) -> None:
    for path in folder.iterdir():
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    for name, (mode, content) in kept.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
        (folder / name).chmod(mode)


def settled(kept: Files) -> Files:
    """Without files that are written aside."""
    return {name: one for name, one in kept.items() if not ASIDE.match(Path(name).name)}


def left_by_kills(folder: Path, do: Callable[[], object]) -> list[Files]:
    """The files that kills before each call leave, and those of the end; of those alike but for files written aside,
    the last."""
    found = [files(folder) for _ in halts(do)] + [files(folder)]
    return [one for one, after in zip(found, [*found[1:], {}], strict=True) if settled(one) != settled(after)]


def done(line: str) -> Callable[[], object]:
    def do() -> None:
        result = run(*line.split())
        assert result.exit_code == 0, result.output

    return do


def test_a_kill_leaves_the_former_file_or_the_new_one_with_its_mode(tmp_path):
    def replace():
        with replacing(tmp_path / "out.txt") as aside:
            aside.write_text("new")

    (tmp_path / "out.txt").write_text("old")
    (tmp_path / "out.txt").chmod(0o600)
    assert left_by_kills(tmp_path, replace)[-1] == {"out.txt": (0o600, b"new")}
    (tmp_path / "out.txt").write_text("old")
    for call in halts(replace):
        found = files(tmp_path)
        assert found["out.txt"] in [(0o600, b"old"), (0o600, b"new")], call
        assert {mode for mode, _ in found.values()} == {0o600}, call


COMMANDS = {
    "groom": (f"groom {RECIPE} -o groom.usdc", "groom.usdc"),
    "groom as text": (f"groom {RECIPE} -o groom.usda", "groom.usda"),
    "hair": ("hair groom.usdc --cache cache.usdc -o hair.usdc", "hair.usdc"),
    "convert": ("convert groom.usdc groom.hair", "groom.hair"),
    "edit": (f"edit {RECIPE} --freeze 19000000", "small.edits.toml"),
    "upgrade": (f"upgrade {RECIPE}", RECIPE),
}


@pytest.mark.parametrize(("line", "output"), COMMANDS.values(), ids=COMMANDS)
def test_a_command_leaves_the_former_result_or_the_new_one(inputs, line, output):
    if "edit" in line:
        edit(inputs / RECIPE, "ringlet = 2", 'ringlet = 2\nedits = "small.edits.toml"')
    if "upgrade" in line:
        edit(inputs / RECIPE, "ringlet = 2", "ringlet = 1")
    else:
        (inputs / output).write_bytes(b"ringlet = 2\n")
    (inputs / output).chmod(0o600)
    former = files(inputs)
    left = left_by_kills(inputs, done(line))
    assert len(left) == 2 and settled(left[0]) == former and left[1].keys() == former.keys()
    for one in left:
        assert {mode for name, (mode, _) in one.items() if name not in former or name == output} == {0o600}
    restore(inputs, left[0])
    done(line)()
    assert settled(files(inputs)) == left[1]


def result_of(folder: Path) -> tuple[bytes, bytes]:
    """The positions in a cache and the groom under it."""
    return ringlet.read_cache(folder / "new.usdc").points.tobytes(), (folder / "new.groom.usdc").read_bytes()


def test_a_run_that_is_killed_keeps_the_former_cache_and_is_resumed_to_the_same_bits(inputs, monkeypatch):
    """A kill at any call of the run, and one more at any call of the end of the run that resumes it."""
    sim, part = f"sim {SHOT} --frames 1:3 -o new.usdc", inputs / "new.usdc.part"
    done(sim)()
    before = result_of(inputs)
    monkeypatch.setattr("ringlet.sim.checkpoint.VERTICES", 2 * 320)  # a state after each second frame
    edit(inputs / RECIPE, "width = 1.0", "width = 1.2")
    left = left_by_kills(inputs, done(sim))
    after = result_of(inputs)
    simulated = next(k for k, one in enumerate(left) if "new.usdc.part/step.000002" in one)
    restore(inputs, left[simulated])
    second = left_by_kills(inputs, done(f"{sim} --resume"))
    results = []
    for one in left[:simulated] + second:
        restore(inputs, one)
        results.append(result_of(inputs))
        done(f"{sim} --resume")()
        assert result_of(inputs) == after and not part.exists()
    # The groom comes right before its cache.
    assert [both for both, _ in groupby(results)] == [before, (before[0], after[1]), after]
    assert results.count((before[0], after[1])) == 1 and results.count(before) > simulated


def test_a_save_in_the_review_that_is_killed_is_done_by_the_next_server(folder, monkeypatch):
    """A recipe, its file of edits and a painted map are saved; what is not yet written is recovered."""
    monkeypatch.setattr(Grooming, "request", lambda grooming, **_: None)  # the groom is no part of this
    for name in ("small.edits.toml", "long.png"):
        (folder / name).write_bytes(b"ringlet = 2\n")
    edit(folder / RECIPE, "ringlet = 2", 'ringlet = 2\nedits = "small.edits.toml"\nmaps.long = "long.png"')

    def save(*, changed: bool) -> None:
        session = Session(folder / RECIPE, Project(folder))
        page = session.join("one", leads=True)
        if changed:
            session.files.write_edits("edit", [{"lock": 19000000, "set": {"curl.pitch": "8 mm"}}])
            session.files.set("recipe", [(["curl", "width"], 1.7)], maps={"long.png": b"painted"})
            session.leave(page)  # writes the journal
            page = session.join("two", leads=True)
        assert session.files.recipe.theirs is None, differences(session.files.recipe)
        session.handle(page, protocol.Save())
        session._finish()

    before = settled(files(folder))
    left, found = left_by_kills(folder, lambda: save(changed=True)), []
    after = settled(left[-1])
    for one in left:
        restore(folder, one)
        save(changed=False)
        found.append(settled(files(folder)))
    assert [one for one, _ in groupby(found)] == [before, after]
