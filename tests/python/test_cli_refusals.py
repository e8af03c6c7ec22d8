"""Refusals on the command line: one line, exit code 2 and no file."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from commands import edit, made, refused, run
from pxr import Usd, UsdGeom


def test_too_many_frames_are_refused_before_the_first(copy):
    for frames in ("1:100001", "1:99999999999999999999", "20000000:20000001"):
        refused(run("sim", copy / "small.shot.toml", "-o", copy / "cache.usdc", "--frames", frames), frames, "must be")
    assert not list(copy.glob("cache.usdc*"))


def test_files_without_hair_are_refused_before_the_review_server_starts(copy):
    (copy / "empty.usdc").touch()
    (copy / "dir.usdc").mkdir()
    for name, words in {"empty.usdc": "is empty", "dir.usdc": "is a folder", "head.usda": "has no hair"}.items():
        refused(run("view", copy / name, "--no-browser"), name, words)


@pytest.mark.parametrize(
    ("command", "allowed"),
    [
        (["groom", "small.recipe.toml", "-o", "out.obj"], ".usdc, .usd or .usda"),
        (["sim", "small.shot.toml", "-o", "out.obj"], ".usdc, .usd or .usda"),
        (["sim", "small.shot.toml", "--contacts", "out.obj"], ".usdc, .usd or .usda"),
        (["hair", "groom.usdc", "-o", "out.abc"], ".usdc, .usd or .usda"),
        (["render", "hair.usdc", "-o", "out.gif"], "must end in .png, .jpg, .jpeg or .exr"),
        (["check", "small.recipe.toml", "--fix", "-o", "out.obj"], ".usdc, .usd or .usda"),
    ],
)
def test_an_output_format_is_refused_before_the_first_stage(copy, monkeypatch, command, allowed):
    monkeypatch.chdir(copy)
    result = run(*command)
    refused(result, "out.", allowed)
    assert "1/1" not in result.stderr  # no stage has run
    assert sorted(path.name for path in copy.iterdir()) == ["head.usda", "small.recipe.toml", "small.shot.toml"]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("[curl]\nwidth", "[curl]\nwidht", ["small.recipe.toml", "curl", "widht", "'width'"]),
        ("[locks]", "[lokcs]", ["lokcs", "'locks'"]),
        ("count = 8", "count = -8", ["locks.count", "-8", "at least"]),
        ("pitch = 1.5", "pitch = 1.5\ncurls = 4", ["curl", "pitch", "curls"]),
        ("width = 1.0", "width = nan", ["curl.width", "nan"]),
        ("points = 40", "points = 'many'", ["locks.points", "many"]),
        ("points = 40", "points = 4", ["points"]),
        ("ringlet = 2", "ringlet = 3", ["ringlet", "2"]),
        ("[scalp]", "[scalp", ["small.recipe.toml", "TOML", "line"]),
        ('file = "head.usda"', 'file = "had.usda"', ["had.usda"]),
        ('region = "scalp"', 'region = "sclap"', ["sclap", "scalp"]),
        ('region = "scalp"', 'mesh = "/ball/skim"', ["/ball/skim", "/ball/skin"]),
    ],
)
def test_a_bad_recipe_is_refused(copy, old, new, words):
    recipe = edit(copy / "small.recipe.toml", old, new)
    before = sorted(copy.iterdir())
    refused(run("groom", recipe, "-o", copy / "groom.usdc"), *words)
    assert sorted(copy.iterdir()) == before


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("frames = [1, 4]", "frames = [4, 1]", ["small.shot.toml", "frames"]),
        ("preroll = 0", "prerol = 0", ["prerol", "'preroll'"]),
        ("preroll = 0", "preroll = -1", ["preroll", "-1", "at least"]),
        ("small.recipe.toml", "small.recip.toml", ["small.recip.toml"]),
        ("preroll = 0", "[strands]\nradius = -1", ["radius", "-1"]),
        ("preroll = 0", "[strands]\ntwist_ratio = 1.5", ["twist_ratio", "1.5", "at most 1"]),
    ],
)
def test_a_bad_shot_is_refused(copy, old, new, words):
    shot = edit(copy / "small.shot.toml", old, new)
    before = sorted(copy.iterdir())
    refused(run("sim", shot, "-o", copy / "cache.usdc"), *words)
    assert sorted(copy.iterdir()) == before


def spoil_points(folder: Path) -> None:
    stage = Usd.Stage.Open(str(folder / "head.usda"))
    attribute = UsdGeom.Mesh(stage.GetPrimAtPath("/ball/skin")).GetPointsAttr()
    points = np.array(attribute.Get())
    points[5] = np.nan
    attribute.Set(points)
    stage.Save()


def remove_mesh(folder: Path) -> None:
    stage = Usd.Stage.Open(str(folder / "head.usda"))
    stage.RemovePrim("/ball/skin")
    stage.Save()


def empty_mesh(folder: Path) -> None:
    stage = Usd.Stage.Open(str(folder / "head.usda"))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/ball/skin"))
    mesh.GetPointsAttr().Set([])
    mesh.GetFaceVertexCountsAttr().Set([])
    mesh.GetFaceVertexIndicesAttr().Set([])
    stage.RemovePrim("/ball/skin/scalp")
    stage.Save()


def fold_scalp(folder: Path) -> None:
    """Adds a third triangle to an edge of the scalp."""
    stage = Usd.Stage.Open(str(folder / "head.usda"))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/ball/skin"))
    counts, indices = list(mesh.GetFaceVertexCountsAttr().Get()), list(mesh.GetFaceVertexIndicesAttr().Get())
    subset = UsdGeom.Subset(stage.GetPrimAtPath("/ball/skin/scalp"))
    subset.GetIndicesAttr().Set([*subset.GetIndicesAttr().Get(), len(counts)])
    mesh.GetFaceVertexCountsAttr().Set([*counts, 3])
    mesh.GetFaceVertexIndicesAttr().Set([*indices, *indices[:2], indices[20]])
    stage.Save()


def spoil_file(folder: Path) -> None:
    (folder / "head.usda").write_text("a head")


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (spoil_points, ["head.usda", "/ball/skin", "finite"]),
        (remove_mesh, ["head.usda", "Mesh"]),
        (empty_mesh, ["head.usda", "/ball/skin"]),
        (fold_scalp, ["shared by", "must be at most 2"]),
        (spoil_file, ["head.usda"]),
    ],
)
def test_a_bad_head_is_refused(copy, spoil, words):
    spoil(copy)
    before = sorted(copy.iterdir())
    refused(run("groom", copy / "small.recipe.toml", "-o", copy / "groom.usdc"), *words)
    assert sorted(copy.iterdir()) == before


def write_guides(path: Path, curves: list[list[tuple[float, float, float]]]) -> None:
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    UsdGeom.SetStageUpAxis(stage, "Y")
    guides = UsdGeom.BasisCurves.Define(stage, "/guides")
    guides.CreateTypeAttr("linear")
    guides.CreateWrapAttr("nonperiodic")
    guides.CreateCurveVertexCountsAttr([len(curve) for curve in curves])
    guides.CreatePointsAttr([point for curve in curves for point in curve])
    stage.Save()


@pytest.mark.parametrize(
    ("curves", "words"),
    [
        ([[(0, 9, 0), (0, 12, 0)], [(0, 9, 0), (0, 9, 0)]], ["length 0"]),
        ([[(0, 9, 0), (0, 12, 0)], [(0, 9, 0)]], ["1 point"]),
        ([[(0, 9, 0), (0, float("nan"), 0)]], ["finite"]),
        ([[(0, 59, 0), (0, 62, 0)]], ["scalp"]),
        ([], ["guides"]),
    ],
)
def test_bad_drawn_guides_are_refused(copy, curves, words):
    write_guides(copy / "guides.usda", curves)
    recipe = edit(copy / "small.recipe.toml", "count = 6\nlength = 5", 'file = "guides.usda"')
    before = sorted(copy.iterdir())
    refused(run("groom", recipe, "-o", copy / "groom.usdc"), *words)
    assert sorted(copy.iterdir()) == before


@pytest.mark.parametrize(
    "command", ["groom small.recipe.toml -o", "sim small.shot.toml -o", "sim small.shot.toml --contacts"]
)
@pytest.mark.parametrize("place", ["file/groom.usdc", "folder.usdc", "groom.txt", "/dev/null/groom.usdc"])
def test_an_unwritable_path_is_refused_before_the_first_stage(copy, monkeypatch, command, place):
    (copy / "file").touch()
    (copy / "folder.usdc").mkdir()
    before = sorted(copy.iterdir())
    monkeypatch.chdir(copy)
    result = run(*command.split(), place)
    refused(result)
    assert "1/1" not in result.stderr  # no stage has run
    assert sorted(copy.iterdir()) == before


@pytest.mark.parametrize(
    ("command", "what"),
    [
        ("groom small.recipe.toml -o head.usda", "scalp.file"),
        ("groom small.recipe.toml -o ../{here}/head.usda", "scalp.file"),
        ("sim small.shot.toml -o head.usda", "scalp.file"),
        ("sim small.shot.toml -o chair.usda", "collider[1].file"),
        ("sim small.shot.toml --groom groom.usdc -o groom.usdc", "groom"),
        ("sim small.shot.toml --groom groom.usdc -o head.usda", "head"),
        ("sim small.shot.toml -o cache.usdc --contacts cache.usdc", "cache"),
        ("sim small.shot.toml -o cache.usdc --contacts ./link/cache.usdc", "cache"),
        ("sim small.shot.toml -o cache.usdc --contacts cache.groom.usdc", "groom under the cache"),
        ("sim small.shot.toml --groom groom.usdc --contacts groom.usdc", "groom"),
        ("sim small.shot.toml --groom groom.usdc --contacts head.usda", "head"),
        ("sim small.shot.toml --contacts head.usda", "scalp.file"),
    ],
)
def test_a_run_does_not_overwrite_its_own_files(copy, monkeypatch, command, what):
    made(copy)
    shot = copy / "small.shot.toml"
    shot.write_text(shot.read_text() + '[contact]\n[[collider]]\n[[collider]]\nfile = "chair.usda"\n')
    (copy / "chair.usda").write_bytes((copy / "head.usda").read_bytes())
    (copy / "link").symlink_to(copy)
    before = {path: path.read_bytes() for path in copy.iterdir() if path.is_file()}
    monkeypatch.chdir(copy)
    result = run(*command.format(here=copy.name).split())
    refused(result, f": is the {what} of the same run; choose another name")
    assert "1/1" not in result.stderr and "sim:" not in result.stderr
    assert {path: path.read_bytes() for path in copy.iterdir() if path.is_file()} == before


@pytest.mark.parametrize("name", ["cache.usdc", "groom.usdc", "head.usda"])
def test_hairs_do_not_overwrite_the_layers_they_refer_to(pipeline, tmp_path, monkeypatch, name):
    shutil.copytree(pipeline, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    refused(run("hair", "groom.usdc", "--cache", "cache.usdc", "-o", name), f"{name}: is ", "choose another name")
    assert (tmp_path / name).read_bytes() == (pipeline / name).read_bytes()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["groom", "small.shot.toml"], ["small.shot.toml: is a shot; give a recipe file"]),
        (["sim", "small.recipe.toml"], ["small.recipe.toml: is a recipe; give a shot file"]),
    ],
)
def test_a_recipe_in_place_of_a_shot_is_refused_and_vice_versa(copy, monkeypatch, arguments, words):
    monkeypatch.chdir(copy)
    refused(run(*arguments, "-o", "out.usdc"), *words)


@pytest.mark.parametrize(
    "arguments",
    [
        ["sim", "SHOT", "--groom", "HEAD"],
        ["sim", "SHOT", "--groom", "NONE"],
        ["hair", "HEAD"],
        ["hair", "NONE"],
        ["hair", "GROOM", "--cache", "GROOM"],
        ["hair", "GROOM", "--cache", "CACHE", "--frames", "80:90"],
        ["render", "NONE"],
        ["render", "HAIR", "--view", "below"],
        ["render", "HAIR", "--frame", "80"],
        ["render", "HAIR", "--frame", "nan"],
        ["render", "HAIR", "--color", "colour"],
        ["render", "HAIR", "--sheet", "--frames", "80:90"],
    ],
)
def test_a_file_of_the_wrong_kind_is_refused(pipeline, tmp_path, arguments):
    files = {
        "SHOT": pipeline / "small.shot.toml",
        "HEAD": pipeline / "head.usda",
        "GROOM": pipeline / "groom.usdc",
        "CACHE": pipeline / "cache.usdc",
        "HAIR": pipeline / "hair.usdc",
        "NONE": tmp_path / "none.usdc",
    }
    output = tmp_path / ("out.png" if arguments[0] == "render" else "out.usdc")
    refused(run(*[files.get(argument, argument) for argument in arguments], "-o", output))
    assert list(tmp_path.iterdir()) == []
