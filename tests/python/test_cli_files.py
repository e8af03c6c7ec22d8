"""The way from a recipe to hairs on the command line, and bad input of every kind on it."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from pxr import Usd, UsdGeom
from small_example import FRAMES, write_example, write_head
from test_cli import refused, run

import ringlet


@pytest.fixture(scope="module")
def example(tmp_path_factory) -> Path:
    """The small example with its groom, cache and hairs."""
    folder = write_example(tmp_path_factory.mktemp("example"))
    made = [
        run("groom", folder / "small.recipe.toml", "-o", folder / "groom.usdc", "--json"),
        run("sim", folder / "small.shot.toml", "--groom", folder / "groom.usdc", "-o", folder / "cache.usdc", "--json"),
        run("hair", folder / "groom.usdc", "--cache", folder / "cache.usdc", "-o", folder / "hair.usdc", "--json"),
    ]
    for result in made:
        assert result.exit_code == 0, result.output
        told = json.loads(result.stdout)
        (folder / f"{Path(told['path']).stem}.json").write_text(result.stdout)
    return folder


@pytest.fixture
def copy(tmp_path) -> Path:
    """The files of the small example, to be spoilt."""
    return write_example(tmp_path)


def edit(file: Path, old: str, new: str) -> Path:
    """Replaces a part of a text file."""
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new, 1))
    return file


def made(folder: Path) -> Path:
    """The groom of the small example."""
    assert run("groom", folder / "small.recipe.toml", "-o", folder / "groom.usdc").exit_code == 0
    return folder / "groom.usdc"


@pytest.mark.parametrize(("unit", "size"), [(1.0, "18 m"), (0.001, "0.018 m")])
def test_a_head_in_another_unit_than_it_says_is_told(copy, unit, size):
    stage = Usd.Stage.Open(str(copy / "head.usda"))
    UsdGeom.SetStageMetersPerUnit(stage, unit)
    stage.Save()
    result = run("groom", copy / "small.recipe.toml", "-o", copy / "groom.usdc")
    assert result.exit_code == 0
    assert f"warning: the scalp is {size} across" in result.stderr and "metersPerUnit" in result.stderr


def test_more_frames_than_a_shot_can_have_are_refused_before_the_first(copy):
    for frames in ("1:100001", "1:99999999999999999999", "20000000:20000001"):
        refused(run("sim", copy / "small.shot.toml", "-o", copy / "cache.usdc", "--frames", frames), frames, "must be")
    assert not list(copy.glob("cache.usdc*"))


def test_what_the_review_cannot_show_is_told_before_there_is_a_server(copy):
    (copy / "empty.usdc").touch()
    (copy / "dir.usdc").mkdir()
    for name, words in {"empty.usdc": "is empty", "dir.usdc": "is a folder", "head.usda": "has no hair"}.items():
        refused(run("view", copy / name, "--no-browser"), name, words)


def told(example: Path, name: str) -> dict:
    return json.loads((example / f"{name}.json").read_text())


@pytest.mark.parametrize(
    ("command", "allowed"),
    [
        (["groom", "small.recipe.toml", "-o", "out.obj"], ".usdc, .usd or .usda"),
        (["sim", "small.shot.toml", "-o", "out.obj"], ".usdc, .usd or .usda"),
        (["sim", "small.shot.toml", "--contacts", "out.obj"], ".usdc, .usd or .usda"),
        (["hair", "groom.usdc", "-o", "out.abc"], ".usdc, .usd or .usda"),
        (["picture", "hair.usdc", "-o", "out.gif"], "must end in .png, .jpg or .jpeg"),
        (["check", "small.recipe.toml", "--fix", "-o", "out.obj"], ".usdc, .usd or .usda"),
    ],
)
def test_a_file_that_would_not_be_written_in_the_end_is_refused_at_once(copy, monkeypatch, command, allowed):
    monkeypatch.chdir(copy)
    result = run(*command)
    refused(result, "out.", allowed)
    assert "1/1" not in result.stderr  # no stage has run
    assert sorted(path.name for path in copy.iterdir()) == ["head.usda", "small.recipe.toml", "small.shot.toml"]


# What works


def test_hairs_of_a_long_cache_are_made_with_a_few_frames_in_memory(example, tmp_path):
    groom, frames, hair = ringlet.read_groom(example / "groom.usdc"), 1500, tmp_path / "hair.usdc"
    points = groom.locks.points.astype(np.float32)
    shapes = np.broadcast_to(points, (frames, *points.shape))
    cache = ringlet.Cache(np.arange(1.0, frames + 1), shapes)
    ringlet.write_cache(cache, example / "groom.usdc", example / "long.usdc")
    tracemalloc.start()
    counts = ringlet.write_hairs(example / "groom.usdc", hair, cache=example / "long.usdc")
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert counts["frames"] == frames
    assert most < 0.5 * shapes.nbytes
    with ringlet.open_cache(hair) as back:  # a layer over the cache
        assert back.points(frames).shape == points.shape


def hairs_at(file, frame):
    """Where the hairs of a file are at a frame [m], shape (n, 3)."""
    stage = Usd.Stage.Open(str(file))
    return np.array(UsdGeom.BasisCurves(stage.GetPrimAtPath("/groom/hairs")).GetPointsAttr().Get(frame))


def test_hairs_of_a_cache_by_itself_are_those_of_its_groom_and_it(example, tmp_path):
    groom, cache = example / "groom.usdc", tmp_path / "cache.usdc"
    points = ringlet.read_groom(groom).locks.points.astype(np.float32)
    ringlet.write_cache(ringlet.Cache(np.arange(1.0, 4), np.stack([points, points + 1e-3, points])), groom, cache)
    by_itself, by_both = tmp_path / "itself.usdc", tmp_path / "both.usdc"
    assert run("hair", str(cache), "-o", str(by_itself), "--frames", "2:3").exit_code == 0
    assert run("hair", str(groom), "--cache", str(cache), "-o", str(by_both), "--frames", "2:3").exit_code == 0
    second, third = ([hairs_at(file, frame) for file in (by_itself, by_both)] for frame in (2, 3))
    assert np.array_equal(*second) and np.array_equal(*third)
    assert not np.array_equal(second[0], third[0])


def test_frames_of_hairs_that_do_not_move_are_refused(example, tmp_path):
    result = run("hair", str(example / "groom.usdc"), "-o", str(tmp_path / "hair.usdc"), "--frames", "2:3")
    refused(result, "groom.usdc", "2:3", "cache")
    assert not (tmp_path / "hair.usdc").exists()


def test_groom_tells_what_it_made(example):
    groom = ringlet.read_groom(example / "groom.usdc")
    assert told(example, "groom") == {
        "path": str(example / "groom.usdc"),
        "bytes": (example / "groom.usdc").stat().st_size,
        "guides": 6,
        "locks": len(groom.locks),
        "points": len(groom.locks.points),
        "conflicts": [],
    }
    assert len(groom.locks) == 8


def test_a_head_that_an_obj_has_stands_still_and_locks_touch_it(copy):
    mesh = ringlet.read_groom(made(copy)).scalp
    corners = [f"f {a} {b} {c}" for a, b, c in (mesh.triangles + 1).tolist()]
    lines = [f"v {x} {y} {z}" for x, y, z in (100 * mesh.points).tolist()] + corners  # in centimetres
    (copy / "head.obj").write_text("\n".join(lines))
    edit(copy / "small.recipe.toml", 'file = "head.usda"\nregion = "scalp"', 'file = "head.obj"\nunit = "cm"')
    (copy / "small.shot.toml").write_text((copy / "small.shot.toml").read_text() + "[contact]\nradius = 2e-3\n")
    result = run("sim", copy / "small.shot.toml", "-o", copy / "cache.usdc")
    assert result.exit_code == 0, result.output
    cache, groom = ringlet.read_cache(copy / "cache.usdc"), ringlet.read_groom(copy / "cache.groom.usdc")
    roots = cache.points[:, groom.locks.offsets[:-1]]
    assert np.abs(roots - roots[0]).max() < 1e-6 and np.abs(np.linalg.norm(roots, axis=2) - 0.09).max() < 0.01
    assert np.linalg.norm(cache.points[-1], axis=1).min() > 0.085  # no lock is inside the ball


def test_sim_writes_every_frame_and_the_locks_follow_the_scalp(example):
    cache, groom = ringlet.read_cache(example / "cache.usdc"), ringlet.read_groom(example / "groom.usdc")
    assert told(example, "cache")["frames"] == FRAMES
    assert cache.frames.tolist() == list(range(1, FRAMES + 1))
    roots = cache.points[:, groom.locks.offsets[:-1]]
    # The head turns by 5° a frame about the vertical, so roots move on circles and keep their height.
    angle = np.radians(5 * (FRAMES - 1))
    x, z = roots[0, :, 0], roots[0, :, 2]
    turned = np.stack([np.cos(angle) * x + np.sin(angle) * z, -np.sin(angle) * x + np.cos(angle) * z], axis=1)
    np.testing.assert_allclose(roots[-1][:, [0, 2]], turned, atol=1e-5)
    np.testing.assert_allclose(roots[-1][:, 1], roots[0][:, 1], atol=1e-5)


def test_hair_has_the_hairs_of_every_lock_in_every_frame(example):
    assert told(example, "hair")["hairs"] == 3 * 8
    stage = Usd.Stage.Open(str(example / "hair.usdc"))
    points = UsdGeom.BasisCurves(stage.GetPrimAtPath("/groom/hairs")).GetPointsAttr()
    assert points.GetTimeSamples() == list(range(1, FRAMES + 1))


def test_frames_can_be_chosen(example, tmp_path):
    result = run("sim", example / "small.shot.toml", "-o", tmp_path / "cache.usdc", "--frames", "2:3", "--json")
    assert result.exit_code == 0, result.output
    assert ringlet.read_cache(tmp_path / "cache.usdc").frames.tolist() == [2, 3]


def test_a_shot_of_a_recipe_leaves_its_groom_beside_the_cache(example, tmp_path):
    assert run("sim", example / "small.shot.toml", "-o", tmp_path / "cache.usdc", "--frames", "1:1").exit_code == 0
    assert (tmp_path / "cache.groom.usdc").exists()
    assert (
        run(
            "hair", tmp_path / "cache.groom.usdc", "--cache", tmp_path / "cache.usdc", "-o", tmp_path / "h.usdc"
        ).exit_code
        == 0
    )


def test_caches_whose_names_differ_in_the_suffix_alone_have_a_groom_each(copy):
    shot, recipe = copy / "small.shot.toml", copy / "small.recipe.toml"
    for suffix, points in (("usda", 40), ("usdc", 36), ("usd", 32)):
        edit(recipe, "points = 40", f"points = {points}")
        assert run("sim", shot, "-o", copy / f"cache.{suffix}", "--frames", "1:2").exit_code == 0
        edit(recipe, f"points = {points}", "points = 40")
    for suffix, points in (("usda", 40), ("usdc", 36), ("usd", 32)):
        made = ["hair", copy / f"cache.groom.{suffix}", "--cache", copy / f"cache.{suffix}", "-o", copy / "h.usdc"]
        assert run(*made).exit_code == 0
        assert ringlet.read_cache(copy / f"cache.{suffix}").points.shape == (2, 8 * points, 3)


def test_without_json_a_person_reads_one_line(example, tmp_path):
    result = run("groom", example / "small.recipe.toml", "-o", tmp_path / "groom.usdc")
    assert len(result.stdout.splitlines()) == 1
    assert "8 locks" in result.stdout


def test_a_report_is_written_where_it_is_asked_for(example, tmp_path):
    result = run("sim", example / "small.shot.toml", "-o", tmp_path / "cache.usdc", "--report", tmp_path / "report")
    assert result.exit_code == 0, result.output
    report = json.loads((tmp_path / "report/report.json").read_text())
    assert report["name"] == "sim"
    assert len(report["statistics"]) == FRAMES
    assert [stage["name"] for stage in report["stages"]] == ["groom", "simulate"]
    assert "<html" in (tmp_path / "report/report.html").read_text()
    assert report["limits"] == [ringlet.api.run.FREE]


def test_a_report_without_a_simulation_says_nothing_of_contact(example, tmp_path):
    result = run("groom", example / "small.recipe.toml", "-o", tmp_path / "groom.usdc", "--report", tmp_path / "report")
    assert result.exit_code == 0, result.output
    assert json.loads((tmp_path / "report/report.json").read_text())["limits"] == []


@pytest.mark.parametrize(("unit", "up"), [(1.0, "Y"), (0.01, "Z"), (0.0254, "Y")])
def test_a_head_in_another_unit_or_up_axis_gives_the_same_groom(example, tmp_path, unit, up):
    write_example(tmp_path)
    (tmp_path / "head.usda").unlink()
    write_head(tmp_path / "head.usda", unit=unit, up=up)
    same, other = ringlet.read_groom(example / "groom.usdc"), ringlet.build_groom(tmp_path / "small.recipe.toml")
    np.testing.assert_allclose(other.locks.points, same.locks.points, atol=2e-4)
    assert other.space.meters_per_unit == pytest.approx(unit)


def test_the_installed_command_works_in_a_process_of_its_own(copy):
    command = Path(sys.executable).with_name("ringlet")
    done = subprocess.run([command, "groom", "small.recipe.toml"], cwd=copy, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert (copy / "groom.usdc").exists()
    failed = subprocess.run([command, "groom", "none.toml"], cwd=copy, capture_output=True, text=True)
    assert failed.returncode == 2
    assert failed.stdout == ""
    assert len(failed.stderr.splitlines()) == 1


# Bad input: one line, exit code 2, nothing written


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
        ("ringlet = 1", "ringlet = 2", ["ringlet", "2"]),
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
    """Adds a third triangle at an edge of the scalp."""
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
        (fold_scalp, ["manifold"]),
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
def test_a_place_that_cannot_be_written_is_refused_at_once(copy, monkeypatch, command, place):
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
def test_nothing_is_written_over_what_the_same_run_reads_or_writes(copy, monkeypatch, command, what):
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
def test_hairs_are_not_written_over_what_they_lie_over(example, tmp_path, monkeypatch, name):
    shutil.copytree(example, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    refused(run("hair", "groom.usdc", "--cache", "cache.usdc", "-o", name), f"{name}: is the file that it would refer")
    assert (tmp_path / name).read_bytes() == (example / name).read_bytes()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["groom", "small.shot.toml"], ["small.shot.toml: is a shot; give a recipe file"]),
        (["sim", "small.recipe.toml"], ["small.recipe.toml: is a recipe; give a shot file"]),
    ],
)
def test_a_recipe_and_a_shot_are_not_mistaken_for_one_another(copy, monkeypatch, arguments, words):
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
        ["picture", "NONE"],
        ["picture", "HAIR", "--view", "below"],
        ["picture", "HAIR", "--frame", "80"],
        ["picture", "HAIR", "--frame", "nan"],
        ["picture", "HAIR", "--color", "colour"],
        ["picture", "HAIR", "--sheet", "--frames", "80:90"],
    ],
)
def test_a_file_of_the_wrong_kind_is_refused(example, tmp_path, arguments):
    files = {
        "SHOT": example / "small.shot.toml",
        "HEAD": example / "head.usda",
        "GROOM": example / "groom.usdc",
        "CACHE": example / "cache.usdc",
        "HAIR": example / "hair.usdc",
        "NONE": tmp_path / "none.usdc",
    }
    output = tmp_path / ("out.png" if arguments[0] == "picture" else "out.usdc")
    refused(run(*[files.get(argument, argument) for argument in arguments], "-o", output))
    assert list(tmp_path.iterdir()) == []
