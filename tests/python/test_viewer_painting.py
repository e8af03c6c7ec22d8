"""Painting on the scalp in the review: strokes on maps that settings name, one undo step each, written on save."""

from __future__ import annotations

import json
import tomllib
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from pages import Page, page, serving
from PIL import Image
from pxr import Gf, Sdf, Usd, UsdGeom, Vt
from ringlet.data.mesh import Mesh
from ringlet.viewer.edit.brush import Ball
from ringlet.viewer.edit.texels import Texels

import ringlet

LENGTH = ["guides", "length", "map"]


def unwrap(folder: Path) -> None:
    """Gives the head texture coordinates: seen from above."""
    stage = Usd.Stage.Open(str(folder / "head.usda"))
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/ball/skin"))
    points = np.array(mesh.GetPointsAttr().Get())
    primvar = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.vertex)
    primvar.Set(Vt.Vec2fArray([Gf.Vec2f(float(x), float(z)) for x, z in 0.5 + points[:, [0, 2]] / 20.0]))
    stage.Save()


def stroke(one: Page, gesture: int, *, place: list[Any] = LENGTH, tool: str = "remove", **more: Any) -> None:
    """A stroke over the front of the crown."""
    common = {"kind": "paint", "place": place, "tool": tool, "radius": 0.05, "gesture": gesture, **more}
    one.send(at=[0.0, 0.08, 0.04], by=[0.0, 0.0, 0.0], resting=False, **common)
    one.send(at=[0.02, 0.08, 0.04], by=[0.02, 0.0, 0.0], resting=True, **common)


def lengths(points: np.ndarray, offsets: np.ndarray) -> np.ndarray:
    edges = np.linalg.norm(np.diff(points.reshape(-1, 3), axis=0), axis=1)
    return np.array([edges[a : b - 1].sum() for a, b in pairwise(offsets)])


def test_a_stroke_shortens_hair_is_one_undo_step_and_is_written_on_save(folder: Path):
    unwrap(folder)
    before = (folder / "small.recipe.toml").read_text()
    with serving(folder) as client, page(client) as one:
        locks = one.receive("locks", draft=False)
        one.receive("numbers")
        stroke(one, 5, radius=0.1)
        painted = one.receive("painted", map="guides_length")
        assert painted["values"].min() < 100 and painted["values"].max() == 255
        document = one.receive("document", undo=True)
        assert document["said"]["maps"] == {"guides_length": "small.guides_length.png"}
        shorter = one.receive("locks", draft=False)
        ratio = lengths(shorter["points"], shorter["offsets"]) / lengths(locks["points"], locks["offsets"])
        assert ratio.min() < 0.9
        assert not (folder / "small.guides_length.png").exists()
        one.send(kind="undo")
        document = one.receive("document")
        assert document["text"] == before and not document["undo"] and not document["dirty"]
        one.send(kind="redo")
        one.receive("numbers", draft=False, revision=one.receive("document")["revision"])
        shown = one.latest("locks", draft=False)
        one.send(kind="save")
        one.receive("saved")
    with Image.open(folder / "small.guides_length.png") as picture:
        assert picture.size == (512, 512)
    made = ringlet.build_groom(folder / "small.recipe.toml")
    assert np.allclose(made.locks.points - made.origin, shown["points"].reshape(-1, 3), atol=2e-6)


def test_painting_goes_on_from_the_picture_on_disk_and_an_unsaved_stroke_is_recovered(folder: Path):
    unwrap(folder)
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text().replace("length = 5", 'length = { value = 5, map = "long" }\n'))
    recipe.write_text(recipe.read_text() + '\n[maps]\nlong = "long.png"\n')
    Image.fromarray(np.full((64, 64), 128, np.uint8)).save(folder / "long.png")
    with serving(folder) as client, page(client) as one:
        one.receive("numbers")
        one.send(kind="show_map", place=LENGTH)
        assert set(one.receive("painted", map="long")["values"]) == {128}
        stroke(one, 5, tool="add")
        assert one.receive("painted")["values"].max() > 200
        one.receive("document", dirty=True)
    (entry,) = json.loads((folder / ".small.recipe.toml.unsaved").read_text())["documents"].values()
    assert list(entry["maps"]) == ["long.png"]
    with serving(folder) as client, page(client) as one:
        assert one.receive("document")["dirty"]
        one.receive("numbers", draft=False)
        one.send(kind="show_map", place=LENGTH)
        assert one.receive("painted")["values"].max() > 200
        one.send(kind="revert")
        assert not one.receive("document")["dirty"]


def test_what_cannot_be_painted_is_refused_in_one_line(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.receive("numbers")
        stroke(one, 5)
        assert (
            one.receive_trouble()
            == "paint: head.usda /ball/skin has no texture coordinates (st) to paint over; unwrap it"
        )
        assert not one.latest("document")["dirty"]


def test_a_new_mask_begins_black_and_is_named_after_its_operator(folder: Path):
    unwrap(folder)
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text() + '[[shape]]\nop = "scraggle"\n')
    with serving(folder) as client, page(client) as one:
        one.receive("numbers")
        one.send(kind="show_map", place=["shape", 0, "mask", "map"])
        assert set(one.receive("painted")["values"]) == {0}
        stroke(one, 5, place=["shape", 0, "mask", "map"], tool="add", mirrored=True)
        document = one.receive("document", undo=True)
        assert tomllib.loads(document["text"])["shape"][0]["mask"] == {"map": "scraggle_mask"}


def test_texels_lie_on_the_mesh_and_smoothing_keeps_a_constant():
    points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]])
    triangles = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    uv = 0.25 + 0.5 * points[triangles][:, :, [0, 2]]
    texels = Texels(Mesh("square", points, triangles, uv=uv), np.arange(2), (40, 40))
    rows, columns = np.nonzero(texels.covered)
    u, v = (columns + 0.5) / 40, 1.0 - (rows + 0.5) / 40
    inside = (abs(u - 0.5) < 0.25) & (abs(v - 0.5) < 0.25)
    assert inside.sum() == 400
    assert np.allclose(texels.position[inside][:, [0, 2]], 2.0 * np.stack([u, v], 1)[inside] - 0.5)
    half = np.full((40, 40), 0.5, np.float32)
    ball = Ball(np.array([0.5, 0.0, 0.5]), np.zeros(3), 0.2)
    weight = ball.falloff(texels.position)
    assert np.allclose(texels.changed(half, weight, None), 0.5)
    added = texels.changed(half, weight, 1.0)
    assert added.max() > 0.95 and (added[texels.covered][weight == 0.0] == 0.5).all()


def test_a_drawn_line_becomes_the_curve_of_a_parting_in_one_undo_step(folder: Path):
    with serving(folder) as client, page(client) as one:
        before = one.receive("locks", draft=False)["points"]
        one.receive("numbers")
        angle = np.linspace(-0.5, 0.5, 60)
        points = 0.09 * np.stack([0.1 + 0 * angle, np.cos(angle), np.sin(angle)], axis=1)
        one.send(kind="draw", place=["guides", "part_line", "curve"], points=points.tolist(), gesture=3)
        document = one.receive("document", dirty=True)
        assert document["said"]["guides"]["part_line"] == {"curve": "guides_part_line"}
        drawn = np.array(document["said"]["curves"]["guides_part_line"]["points"])
        assert 3 < len(drawn) < 20 and np.allclose(np.linalg.norm(drawn[:, 1:], axis=1), 9.0, atol=0.02)
        assert np.abs(one.receive("locks", draft=False)["points"] - before).max() > 0.001
        one.send(kind="draw", place=["guides", "part_line", "curve"], points=points[::-1].tolist(), gesture=4)
        document = one.receive("document")
        assert list(document["said"]["curves"]) == ["guides_part_line"]
        for _ in range(2):
            one.send(kind="undo")
            document = one.receive("document")
        assert not document["dirty"] and not document["undo"]
        one.send(kind="draw", place=["guides", "part_line", "curve"], points=[[0, 0.09, 0]] * 2, gesture=5)
        assert one.receive_trouble() == "draw: the stroke has no length; draw a line over the scalp"


def test_directions_are_combed_into_a_picture_that_turns_the_guides(folder: Path):
    unwrap(folder)
    place = ["guides", "direction"]
    with serving(folder) as client, page(client) as one:
        one.receive("numbers")
        before = one.latest("guides")["points"].reshape(6, -1, 3)
        one.send(kind="show_map", place=place)
        shown = one.receive("painted", map="")
        assert not shown["values"].any() and not shown["directions"].any()
        common = {"kind": "paint", "place": place, "tool": "comb", "radius": 0.2, "falloff": "flat", "gesture": 5}
        one.send(at=[0.0, 0.09, 0.0], by=[0.0, 0.0, 0.0], resting=False, **common)
        one.send(at=[0.0, 0.0, 0.0], by=[0.1, 0.0, 0.0], resting=True, **common)
        shown = one.latest("painted", map="guides_direction")
        while not shown["values"].any():
            shown = one.receive("painted")
        assert np.allclose(shown["directions"].reshape(-1, 3), (1.0, 0.0, 0.0), atol=0.01)
        document = one.receive("document", undo=True)
        assert document["said"]["guides"]["direction"] == "guides_direction"
        while (now := one.receive("guides")["points"].reshape(6, -1, 3)) is None or np.allclose(now, before):
            pass
        tips, tips_before = now[:, 1] - now[:, 0], before[:, 1] - before[:, 0]
        assert (tips[:, 0] > tips_before[:, 0] - 1e-6).all() and (tips[:, 0] - tips_before[:, 0]).max() > 0.001
        one.latest("numbers", draft=False, revision=document["revision"])
        assert "guides_direction" in one.latest("names")["vectors"]
        one.send(kind="save")
        one.receive("saved")
        one.send(kind="undo")
        assert not one.receive("document", undo=False)["said"].get("maps")
    with Image.open(folder / "small.guides_direction.png") as picture:
        assert picture.mode == "RGB" and picture.getpixel((256, 256)) == (255, 128, 128)
    made = ringlet.build_groom(folder / "small.recipe.toml").guides.points.reshape(6, -1, 3)
    assert np.allclose(made[:, 1] - made[:, 0], tips, atol=1e-5)


def test_a_drawn_guide_is_a_guide_of_the_recipe_in_one_undo_step(folder: Path):
    place = ["guides", "drawn"]
    with serving(folder) as client, page(client) as one:
        one.receive("numbers")
        before = one.latest("guides")["points"].reshape(6, -1, 3)
        upwards = [[0.0, 0.09 + 0.05 * t, 0.02 * t * t] for t in np.linspace(0.0, 1.0, 30)]
        one.send(kind="draw", place=place, points=upwards, gesture=3)
        document = one.receive("document", dirty=True)
        assert document["said"]["guides"]["drawn"] == ["guides_drawn"]
        guides = one.receive("guides")["points"].reshape(7, -1, 3)
        assert np.array_equal(guides[:6], before)
        assert np.allclose(guides[6][[0, -1]], [[0, 0.09, 0], [0, 0.14, 0.02]], atol=2e-4)
        sideways = [[0.09 + 0.05 * t, 0.02, 0.0] for t in np.linspace(0.0, 1.0, 30)]
        one.send(kind="draw", place=place, points=sideways, gesture=4)
        document = one.receive("document")
        assert document["said"]["guides"]["drawn"] == ["guides_drawn", "guides_drawn_2"]
        assert np.array_equal(one.receive("guides")["points"].reshape(8, -1, 3)[:7], guides)
        one.send(kind="undo")
        document = one.receive("document")
        assert document["said"]["guides"]["drawn"] == ["guides_drawn"] and list(document["said"]["curves"])
        one.send(kind="undo")
        document = one.receive("document")
        assert not document["dirty"] and not document["undo"]
        one.send(kind="draw", place=place, points=[[0, 0.2, 0], [0, 0.3, 0]], gesture=5)
        assert one.receive_trouble() == "draw: the guide begins 110 mm off the scalp; begin it where the hair grows"
