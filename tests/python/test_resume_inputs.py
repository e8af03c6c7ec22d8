"""An interrupted run resumes only where all that it read is the same."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest
from commands import edit, refused, run
from pxr import Sdf, Usd, UsdGeom
from ringlet.data.reads import recorded
from ringlet.sim import checkpoint
from small_example import write_example
from wear import SCARF, define, quads, write_wear

import ringlet

SHOT = """
[variation]
bend = { map = "soft" }
[contact]
[[collider]]
[[collider]]
file = "chair/chair.usda"
"""
PIN = """
[[cloth.pin]]
map = "pinned"
subset = "hem"
"""


def paint(file, prim, name, value):
    """Sets a float primvar of every vertex of a mesh, or of every point of curves."""
    stage = Usd.Stage.Open(str(file))
    points = UsdGeom.PointBased(stage.GetPrimAtPath(prim))
    count = len(points.GetPointsAttr().Get())
    primvar = UsdGeom.PrimvarsAPI(points).CreatePrimvar(name, Sdf.ValueTypeNames.FloatArray, "vertex")
    primvar.Set([value] * count)
    stage.Save()


def write_chair(file):
    """Writes a sheet below the head."""
    stage = Usd.Stage.CreateNew(str(file))
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    define(stage, "/chair", [(x, -0.3, z) for z in (-0.2, 0.2) for x in (-0.2, 0.2)], quads(2, 2))
    stage.Save()


def set_subset(mesh, faces):
    UsdGeom.Subset.CreateGeomSubset(UsdGeom.Mesh(mesh), "hem", "face", faces)


def hem(folder, faces):
    stage = Usd.Stage.Open(str(folder / "wear.usda"))
    set_subset(stage.GetPrimAtPath("/wear/scarf"), faces)
    stage.Save()


def flip_faces(file):
    """Reverses the faces of a mesh, whose points stay."""
    stage = Usd.Stage.Open(str(file))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/chair"))
    mesh.GetFaceVertexIndicesAttr().Set(list(reversed(mesh.GetFaceVertexIndicesAttr().Get())))
    stage.Save()


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A groom with a pin, a painted scalp, a chair and a pinned scarf, after a run that a full disk interrupted."""
    folder = write_example(tmp_path / "project")
    (folder / "chair").mkdir()
    write_chair(folder / "chair/chair.usda")
    paint(folder / "head.usda", "/ball/skin", "soft", 1.0)
    write_wear(folder, lambda mesh: set_subset(mesh, [0, 1]))
    paint(folder / "wear.usda", "/wear/scarf", "pinned", 1.0)
    assert run("groom", folder / "small.recipe.toml", "-o", folder / "groom.usdc").exit_code == 0
    paint(folder / "groom.usdc", "/groom/locks", "ringlet:pin", 0.2)
    shot = edit(folder / "small.shot.toml", "small.recipe.toml", "groom.usdc")
    shot.write_text(shot.read_text() + SHOT + SCARF.replace("[contact]\n", "") + PIN)
    monkeypatch.setattr(checkpoint, "VERTICES", 1)  # a state after every frame
    interrupt(folder, monkeypatch)
    return folder


def interrupt(folder, monkeypatch):
    write_step = checkpoint.Checkpoints.write_step

    def full(self, step, *rest):
        if step >= 2:
            raise OSError(28, "No space left on device")
        write_step(self, step, *rest)

    with monkeypatch.context() as patch:
        patch.setattr(checkpoint.Checkpoints, "write_step", full)
        result = sim(folder)
    assert result.exit_code == 2 and "No space left" in result.stderr, result.output


def sim(folder, *more):
    return run("sim", folder / "small.shot.toml", "-o", folder / "cache.usdc", *more)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda f: paint(f / "groom.usdc", "/groom/locks", "ringlet:pin", 0.9), "locks.point.pin"),
        (lambda f: paint(f / "head.usda", "/ball/skin", "soft", 0.1), "head.usda has changed"),
        (lambda f: flip_faces(f / "chair/chair.usda"), "chair.usda has changed"),
        (lambda f: paint(f / "wear.usda", "/wear/scarf", "pinned", 0.5), "wear.usda has changed"),
        (lambda f: hem(f, [0, 1, 2]), "wear.usda has changed"),
        (lambda f: edit(f / "small.shot.toml", "[variation]", "[strands]\nradius = 2e-4\n[variation]"), "radius was"),
        (
            lambda f: edit(f / "small.shot.toml", 'file = "chair/chair.usda"', 'file = "wear.usda"'),
            "wear.usda is read in place of chair.usda",
        ),
    ],
)
def test_a_run_with_other_inputs_is_not_resumed_and_the_line_names_them(folder, change, words):
    before = {path: path.read_bytes() for path in folder.rglob("*.usd?") if path.is_file()}
    steps = sorted(path.name for path in (folder / "cache.usdc.part").iterdir())
    shot = (folder / "small.shot.toml").read_text()
    change(folder)
    refused(sim(folder, "--resume"), "cache.usdc.part: was left by another run", words)
    assert not (folder / "cache.usdc").exists()
    assert sorted(path.name for path in (folder / "cache.usdc.part").iterdir()) == steps
    for path, content in before.items():
        path.write_bytes(content)
    (folder / "small.shot.toml").write_text(shot)
    assert sim(folder, "--resume").exit_code == 0


def test_a_run_resumes_in_a_moved_folder_with_files_that_were_touched(folder):
    moved = folder.rename(folder.with_name("moved"))
    for path in moved.rglob("*.usd?"):
        os.utime(path)
    assert sim(moved, "--resume").exit_code == 0
    assert len(ringlet.read_cache(moved / "cache.usdc").frames) == 4


def test_every_file_that_python_opens_for_a_groom_is_recorded(folder):
    opened = set()

    def audit(event, arguments):
        if event == "open" and recording and isinstance(arguments[0], str | os.PathLike):
            opened.add(os.path.realpath(arguments[0]))

    recording = True
    sys.addaudithook(audit)
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text().replace("ringlet = 2", 'ringlet = 2\nedits = "small.edits.toml"'))
    (folder / "small.edits.toml").write_text("ringlet = 2\n")
    with recorded() as read:
        ringlet.load_groom(recipe)
    recording = False
    inside = {path for path in opened if path.startswith(os.path.realpath(folder))}
    assert {"small.recipe.toml", "small.edits.toml"} <= {Path(path).name for path in inside}
    assert inside <= {str(read.input_at(path)) for path in inside}
