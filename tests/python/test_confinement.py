"""Untrusted files: no output elsewhere, bounded input, and no guesses at later formats."""

from __future__ import annotations

import math
import os
import stat
from pathlib import Path

import pytest
from commands import refused, run
from pxr import Sdf
from ringlet.data.files import replacing
from small_example import write_example

import ringlet


@pytest.fixture
def project(tmp_path) -> Path:
    """The small example in a folder; no file may appear outside it."""
    return write_example(tmp_path / "project")


def add_line(file: Path, line: str, below: str = "ringlet = 2") -> Path:
    file.write_text(file.read_text().replace(below, f"{below}\n{line}", 1))
    return file


def names_below(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


# Output paths


@pytest.mark.parametrize("place", ["../edits.toml", "sub/../../edits.toml", "{outside}/edits.toml", "link/edits.toml"])
def test_edits_are_written_beside_the_recipe_only(project, place):
    outside = project.parent / "outside"
    outside.mkdir()
    (project / "link").symlink_to(outside)
    recipe = add_line(project / "small.recipe.toml", f'edits = "{place.format(outside=outside)}"')
    groom = ringlet.build_groom(recipe)
    before = names_below(project.parent)
    refused(run("edit", recipe, "--freeze", groom.locks.ids[0]), "edits", "outside of", str(project))
    assert names_below(project.parent) == before


def test_a_loft_is_written_beside_the_shot_by_default(project):
    shot = project / "small.shot.toml"
    shot.write_text(shot.read_text() + '\n[rest]\nmode = "lofted"\nfile = "../rest.usdc"\n')
    before = names_below(project.parent)
    refused(run("loft", shot), "small.shot.toml", "rest.file", "outside of")
    assert names_below(project.parent) == before
    assert run("loft", shot, "-o", project.parent / "rest.usdc").exit_code == 0
    assert (project.parent / "rest.usdc").exists()


def test_a_link_in_place_of_the_output_is_replaced_and_not_followed(tmp_path):
    (tmp_path / "precious").write_text("precious")
    (tmp_path / "out").symlink_to(tmp_path / "precious")
    with replacing(tmp_path / "out") as temporary:
        temporary.write_text("new")
    assert (tmp_path / "precious").read_text() == "precious"
    assert not (tmp_path / "out").is_symlink() and (tmp_path / "out").read_text() == "new"


def test_a_file_that_is_upgraded_keeps_its_mode_and_the_link_to_it(tmp_path):
    recipe, link = tmp_path / "kept/a.recipe.toml", tmp_path / "b.recipe.toml"
    recipe.parent.mkdir()
    recipe.write_text('ringlet = 1\nunit = "m"\n[scalp]\nfile = "head.usdc"\n')
    recipe.chmod(0o600)
    link.symlink_to("kept/a.recipe.toml")
    assert run("upgrade", link).exit_code == 0
    assert link.is_symlink() and recipe.read_text().startswith("ringlet = 2\n")
    assert stat.S_IMODE(recipe.stat().st_mode) == 0o600
    assert names_below(tmp_path) == ["b.recipe.toml", "kept", "kept/a.recipe.toml"]


@pytest.mark.parametrize("mode", [0o600, 0o640, 0o755, 0o444])
def test_a_file_that_is_replaced_keeps_its_mode_and_is_private_while_it_is_written(tmp_path, mode):
    (tmp_path / "out.txt").write_text("old")
    (tmp_path / "out.txt").chmod(mode)
    with replacing(tmp_path / "out.txt") as temporary:
        assert stat.S_IMODE(temporary.stat().st_mode) == 0o600
        temporary.write_text("new")
    assert stat.S_IMODE((tmp_path / "out.txt").stat().st_mode) == mode


@pytest.mark.skipif(os.geteuid() != 0, reason="only root gives files away")
def test_a_file_that_root_replaces_keeps_its_owner(project):
    for path in (groom := project / "groom.usdc", recipe := project / "old.recipe.toml"):
        path.write_text('ringlet = 1\n[scalp]\nfile = "head.usda"\n')
        os.chown(path, 12345, 23456)
    assert run("upgrade", recipe).exit_code == 0
    assert run("groom", project / "small.recipe.toml", "-o", groom).exit_code == 0
    assert {(path.stat().st_uid, path.stat().st_gid) for path in (groom, recipe)} == {(12345, 23456)}


def test_a_pipe_in_place_of_an_output_is_refused_and_stays(project):
    os.mkfifo(project / "groom.usdc")
    refused(run("groom", project / "small.recipe.toml", "-o", project / "groom.usdc"), "a pipe; choose another name")
    with pytest.raises(ringlet.UserError, match="a pipe; choose another name"), replacing(project / "groom.usdc"):
        pass
    assert (project / "groom.usdc").is_fifo()


def test_a_link_in_place_of_the_temporary_file_is_not_followed(tmp_path):
    (tmp_path / "precious").write_text("precious")
    (tmp_path / f".out.{os.getpid()}.txt").symlink_to(tmp_path / "precious")
    with replacing(tmp_path / "out.txt") as temporary:
        temporary.write_text("new")
    assert (tmp_path / "precious").read_text() == "precious" and (tmp_path / "out.txt").read_text() == "new"


def test_a_read_only_folder_is_refused_before_the_first_stage(project, monkeypatch):
    closed = project / "closed"
    closed.mkdir()
    closed.chmod(0o500)
    if os.access(closed, os.W_OK):  # root ignores permissions, so the refusal is simulated
        monkeypatch.setattr("ringlet.data.files.tempfile.TemporaryFile", deny)
    refused(run("groom", project / "small.recipe.toml", "-o", closed / "groom.usdc"), "cannot be written")
    assert list(closed.iterdir()) == []


def deny(**_):
    raise PermissionError(13, "Permission denied")


# Bounded input


@pytest.mark.parametrize("text", ["ringlet = 2\na = " + "[" * 100_000, "ringlet = 2\nseed = " + "9" * 5000])
@pytest.mark.parametrize("command", ["groom", "sim"])
def test_unbounded_nesting_and_digits_are_refused(tmp_path, command, text):
    (tmp_path / "deep.toml").write_text(text)
    refused(run(command, tmp_path / "deep.toml", "-o", tmp_path / "out.usdc"), "deep.toml", "not valid TOML")


def test_a_pipe_in_place_of_a_file_is_refused(project):
    os.mkfifo(project / "pipe")
    refused(run("groom", project / "pipe", "-o", project / "groom.usdc"), "pipe", "is no regular file but a pipe")
    recipe = add_line(project / "small.recipe.toml", 'extends = "pipe"')
    refused(run("groom", recipe, "-o", project / "groom.usdc"), "pipe", "is no regular file but a pipe")


def numbers_of(schema: dict, place: str):
    """Schemas of all numbers among the settings, with their paths."""
    for name, inner in [*schema.get("properties", {}).items(), *schema.get("$defs", {}).items()]:
        yield from numbers_of(inner, f"{place}.{name}")
    for option in [*schema.get("anyOf", ()), *schema.get("oneOf", ()), *schema.get("prefixItems", ())]:
        yield from numbers_of(option, place)
    for key in ("items", "additionalProperties"):
        if isinstance(schema.get(key), dict):
            yield from numbers_of(schema[key], place)
    if schema.get("type") in ("integer", "number"):
        yield place, schema


# Numbers whose bounds are those of the setting that they belong to, or that they stand for.
BOUNDED_ELSEWHERE = {
    f"{of}.{name}" for of in ("Varied", "Ramped", "Mapped", "Wanted") for name in ("value", "region", "lock")
}
BOUNDED_ELSEWHERE |= {"Edit.set"}


@pytest.mark.parametrize("kind", ["recipe", "shot"])
def test_every_number_in_a_recipe_and_a_shot_has_finite_bounds(kind):
    unbounded = []
    for place, about in numbers_of(ringlet.schema()[kind], kind):
        least, most = (
            about.get(f"{end}imum", about.get(f"exclusive{end.title()}imum", math.inf)) for end in ("min", "max")
        )
        named = ".".join(place.split(".")[-2:])
        if not (abs(least) < 1e16 and abs(most) < 1e16) and "const" not in about and named not in BOUNDED_ELSEWHERE:
            unbounded.append(place)
    assert unbounded == []


# Versions


@pytest.mark.parametrize(("command", "file"), [("groom", "small.recipe.toml"), ("sim", "small.shot.toml")])
def test_a_later_format_is_refused_with_a_remedy(project, command, file):
    path = project / file
    path.write_text(path.read_text().replace("ringlet = 2", "ringlet = 3"))
    refused(run(command, path, "-o", project / "out.usdc"), file, "ringlet is 3", "update it")


def test_a_removed_setting_is_refused_with_its_replacement(project):
    recipe = add_line(project / "small.recipe.toml", "rate = [[0, 1], [1, 2]]", below="[curl]")
    refused(run("groom", recipe, "-o", project / "groom.usdc"), "curl.rate", "any more", "give curls", "pitch a ramp")


def as_version(path: Path, version: object) -> Path:
    """Replaces the version in the layer of a cache or a rest shape."""
    layer = Sdf.Layer.FindOrOpen(str(path))
    data = dict(layer.customLayerData)
    kept = dict(data["ringlet"])
    kept.pop("version")
    data["ringlet"] = kept | ({} if version is None else {"version": version})
    layer.customLayerData = data
    layer.Save()
    return path


def test_a_cache_of_a_later_layout_is_refused_and_one_without_a_version_opens(project):
    shot, cache = project / "small.shot.toml", project / "cache.usdc"
    assert run("sim", shot, "-o", cache).exit_code == 0
    points = ringlet.read_cache(cache).points
    assert (ringlet.read_cache(as_version(cache, None)).points == points).all()
    with pytest.raises(ringlet.UserError, match="has layout 2; this Ringlet reads up to 1: update it"):
        ringlet.read_cache(as_version_again(cache, 2))


def as_version_again(path: Path, version: int) -> Path:
    layer = Sdf.Layer.FindOrOpen(str(path))
    layer.customLayerData = {
        **layer.customLayerData,
        "ringlet": {**layer.customLayerData["ringlet"], "version": version},
    }
    layer.Save()
    return path


def test_a_loft_of_a_later_layout_is_refused_with_a_remedy(project):
    shot, rest = project / "small.shot.toml", project / "small.rest.usdc"
    assert run("loft", shot, "-o", rest).exit_code == 0
    shot.write_text(shot.read_text() + '\n[rest]\nmode = "lofted"\n')
    as_version(rest, 3)
    refused(run("sim", shot, "-o", project / "cache.usdc"), "small.rest.usdc", "layout 3", "update it")
