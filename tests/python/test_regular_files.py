"""Every reader takes regular files of a bounded size only; a pipe, a device or a link to one is refused at once."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from commands import edit, refused, run
from ringlet.data.regular import read_text
from ringlet.farm.page import read_results
from small_example import write_example

import ringlet
from ringlet import io


def pipe(path: Path) -> Path:
    """A pipe that nobody writes to."""
    path.unlink(missing_ok=True)
    os.mkfifo(path)
    return path


def endless(path: Path) -> Path:
    """A link to a device without end."""
    path.unlink(missing_ok=True)
    path.symlink_to("/dev/zero")
    return path


irregular = pytest.mark.parametrize(("make", "kind"), [(pipe, "pipe"), (endless, "device")])
READERS = {
    "a.hair": io.read_curves,
    "a.obj": io.read_mesh,
    "b.obj": io.read_curves,
    "a.usda": io.read_mesh,
    "a.usdc": io.read_curves,
    "b.usdc": io.read_groom,
    "c.usdc": io.read_cache,
    "a.png": io.read_texture,
    "a.recipe.toml": ringlet.read_recipe,
    "a.shot.toml": ringlet.read_shot,
}


@irregular
@pytest.mark.parametrize("name", READERS)
def test_readers_refuse_what_is_no_regular_file(tmp_path, make, kind, name):
    with pytest.raises(ringlet.UserError, match=f"{name}: is no regular file but a {kind}; [a-z]"):
        READERS[name](make(tmp_path / name))


@pytest.mark.parametrize("name", READERS)
def test_readers_refuse_a_folder_and_a_missing_file(tmp_path, name):
    with pytest.raises(ringlet.UserError, match=f"{name}: (cannot be read|there is no such file)[^\n]*; [a-z]"):
        READERS[name](tmp_path / name)
    (tmp_path / name).mkdir()
    with pytest.raises(ringlet.UserError, match=f"{name}: is a folder; [a-z]"):
        READERS[name](tmp_path / name)


@irregular
def test_files_that_a_file_names_are_regular_too(tmp_path, make, kind):
    for line in ('extends = "odd"', 'edits = "odd"', 'maps = { a = "odd" }', 'curves = { a = { file = "odd.hair" } }'):
        folder = write_example(tmp_path / line.split()[0])
        recipe = edit(folder / "small.recipe.toml", "ringlet = 2", f"ringlet = 2\n{line}")
        make(folder / "odd")
        make(folder / "odd.hair")
        refused(run("groom", recipe, "-o", folder / "out.usdc"), "odd", f"is no regular file but a {kind}")


@irregular
def test_a_layer_below_another_is_regular_too(pipeline, tmp_path, make, kind):
    for name in ("groom.usdc", "cache.usdc"):
        (tmp_path / name).write_bytes((pipeline / name).read_bytes())
    make(tmp_path / "head.usda")
    with pytest.raises(ringlet.UserError, match=f"head.usda: is no regular file but a {kind}"):
        io.read_cache(tmp_path / "cache.usdc")


@irregular
def test_results_of_a_wedge_are_regular_files(tmp_path, make, kind):
    (tmp_path / "task").mkdir()
    make(tmp_path / "task" / "result.json")
    assert read_results(tmp_path) == {}


@pytest.mark.parametrize("name", ["a.hair", "a.obj", "a.recipe.toml", "a.shot.toml"])
def test_a_file_that_is_too_large_is_refused_before_it_is_read(tmp_path, name):
    with (tmp_path / name).open("wb") as file:
        file.truncate(2**40)  # a hole: it takes no room on the disk
    with pytest.raises(ringlet.UserError, match=f"{name}: has 1,099,511,627,776 bytes; must be at most"):
        READERS[name](tmp_path / name)


@pytest.mark.parametrize(
    ("data", "words"),
    [("ringlet = 2".encode("utf-16"), "UTF-16 text; save it as UTF-8"), (b"\xff\x00", "is no text; give")],
)
def test_a_text_of_another_encoding_is_refused_with_what_to_do(tmp_path, data, words):
    (tmp_path / "a.recipe.toml").write_bytes(data)
    with pytest.raises(ringlet.UserError, match=words):
        ringlet.read_recipe(tmp_path / "a.recipe.toml")


def test_a_byte_order_mark_is_no_part_of_a_text(copy):
    for name in ("small.recipe.toml", "small.shot.toml"):
        text = (copy / name).read_text()
        (copy / name).write_bytes(b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode())
        assert read_text(copy / name) == text
    assert ringlet.read_shot(copy / "small.shot.toml").frames == (1, 4)
    assert ringlet.read_recipe(copy / "small.recipe.toml").name == "small"
