"""A take of live hair becomes a shot: files that other commands read, and a run that is compared with the take."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pages import page, serving
from pxr import Usd, UsdGeom
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.play.take_shot import HeadClip, write_take_shot
from ringlet.viewer.project import Project
from ringlet.viewer.show.live_take import LiveTake
from small_example import write_example, write_head
from test_viewer_takes import keep, nod, recorded

import ringlet
from ringlet.groom import Groom


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_example(tmp_path)


def made_of(
    folder: Path, file: str = "small.shot.toml", steps: int = 24, name: str = ""
) -> tuple[Any, LiveTake, Groom]:
    """The shot of a nod in a take, the take and its groom."""
    groom = ringlet.build_groom(folder / "small.recipe.toml")
    take = recorded(groom, steps, "nod")[0].take(groom)
    files = Files(folder / file, Project(folder))
    shot = files.document("shot").text if files.mode == "shot" else ""
    return write_take_shot(files, take, shot, name), take, groom


@pytest.mark.parametrize("up", ["Y", "Z"])
def test_the_head_of_the_shot_moves_as_in_the_take_and_its_groom_is_the_same(folder: Path, up: str) -> None:
    write_head(folder / "head.usda", unit=0.1, up=up)
    made, take, groom = made_of(folder)
    shot, again = ringlet.read_shot(made.shot), ringlet.build_groom(made.recipe)
    assert again.locks.points == pytest.approx(groom.locks.points, abs=1e-9)
    assert shot.frames == (1, take.steps[-1] + 1)
    heads = ringlet.head_motion(again, shot.frames)
    for row, step in enumerate(take.steps):
        assert heads[step][:3] == pytest.approx(take.heads[row].reshape(3, 4), abs=2e-5)


def test_the_shot_has_the_material_and_the_wind_of_the_take(folder: Path) -> None:
    file = folder / "small.shot.toml"
    file.write_text(file.read_text() + "\n[strands]\nbend_scale = 3 # soft\n\n[contact]\nradius = 3e-4\n")
    shot = ringlet.read_shot(made_of(folder)[0].shot)
    assert (shot.strands.bend_scale, shot.contact.radius, shot.preroll) == (3.0, 3e-4, 0)
    groom = ringlet.build_groom(folder / "small.recipe.toml")
    take = recorded(groom, 30, wind="left")[0].take(groom)
    files = Files(folder / "small.recipe.toml", Project(folder))
    shot = ringlet.read_shot(write_take_shot(files, take, "", "windy").shot)
    assert shot.touching is not None
    assert shot.forces.wind == pytest.approx(take.wind, abs=0.01)
    assert shot.forces.wind[0] < -2.0


def test_a_take_that_begins_in_motion_has_a_lead_from_rest(folder: Path) -> None:
    groom = ringlet.build_groom(folder / "small.recipe.toml")
    clip = HeadClip.of(recorded(groom, 200, "walk")[0].take(groom))
    assert -24 < clip.first < -10
    assert clip.frames[1] == pytest.approx(120, abs=1)
    assert np.abs(clip.turns[0]).max() < 1e-6
    assert np.abs(np.diff(clip.turns, axis=0)).max() < 0.05
    still = HeadClip.of(recorded(groom, 30, "nod")[0].take(groom))
    assert still.first == 1


def test_cloth_goes_with_the_body_and_the_neck_bends(folder: Path) -> None:
    stage = Usd.Stage.Open(str(folder / "head.usda"))
    shirt = UsdGeom.Mesh.Define(stage, "/ball/shirt")
    shirt.CreatePointsAttr([(-3, -12, 0), (3, -12, 0), (0, -12, 3)])
    shirt.CreateFaceVertexCountsAttr([3])
    shirt.CreateFaceVertexIndicesAttr([0, 1, 2])
    stage.Save()
    made = made_of(folder)[0]
    bodies = {body.prim: body.clip for body in ringlet.io.read_bodies(made.head, frames=(1, 24), fps=24.0)}
    shirt_at, skin = bodies["/ball/shirt"], bodies["/ball/skin"]
    assert shirt_at.at(20.0) == pytest.approx(shirt_at.at(1.0), abs=1e-6)  # a nod moves no trunk
    moved = np.linalg.norm(skin.at(20.0) - skin.at(1.0), axis=1)
    assert moved[skin.at(1.0)[:, 1].argmin()] < 0.1 * moved.max()


def test_files_that_are_there_are_not_written_over(folder: Path) -> None:
    first = made_of(folder)[0]
    assert first.shot.name == "small_take.shot.toml"
    assert made_of(folder)[0].shot.name == "small_take_2.shot.toml"
    before = first.shot.read_text()
    with pytest.raises(ringlet.UserError, match=r"^take: small_take\.head\.usdc is there already; give another name$"):
        made_of(folder, name="small_take")
    assert first.shot.read_text() == before


def test_what_cannot_be_written_leaves_no_file(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: Any, **__: Any) -> None:
        raise ringlet.UserError("x: cannot be written (No space left on device); choose another place")

    monkeypatch.setattr("ringlet.viewer.play.take_shot._write", full)
    before = sorted(folder.iterdir())
    with pytest.raises(ringlet.UserError, match="No space left"):
        made_of(folder)
    assert sorted(folder.iterdir()) == before


def test_the_shot_of_a_take_is_opened_simulated_and_compared_with_it(folder: Path) -> None:
    with serving(folder) as client, page(client) as one:
        one.receive("measured")
        nod(one)
        taken = keep(one, note="a nod")
        one.send(kind="make_shot", id=taken["id"], name="nodding")
        assert one.receive("welcome", name="nodding.shot.toml")["mode"] == "shot"
        kept = one.latest("snapshots")["snapshots"]
        assert [(entry["id"], entry["note"]) for entry in kept] == [(taken["id"], "a nod")]
        take = one.receive("live_take", side="b", id=taken["id"])
        assert take["first"] == 1
        last = float(take["steps"][-1] + 1)
        frames = one.watch(1.0, last)
        assert np.abs(frames[1]["points"] - frames[0]["points"]).max() > 1e-3
        assert one.latest("compared", side="b")["take"] == taken["id"]


def test_changed_and_unsaved_recipes_are_refused_in_one_line(folder: Path) -> None:
    with serving(folder) as client, page(client) as one:
        one.receive("measured")
        nod(one)
        taken = keep(one)
        one.send(kind="set", changes=[[["curl", "width"], 2.0]], gesture=1)
        one.send(kind="make_shot", id=taken["id"])
        assert one.receive_trouble() == "take: small.recipe.toml has unsaved changes; save them, and make the shot then"
        one.send(kind="save")
        one.send(kind="make_shot", id=taken["id"])
        assert "small.recipe.toml has changed since it was kept; load its settings" in one.receive_trouble()
        one.send(kind="load_snapshot", id=taken["id"])
        one.send(kind="save")
        one.send(kind="make_shot", id=taken["id"])
        one.receive("welcome", mode="shot")
