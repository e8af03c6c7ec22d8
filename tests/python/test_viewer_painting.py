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
from ringlet.viewer.brush import Ball
from ringlet.viewer.texels import Texels

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
    assert np.allclose(texels.changed(half, weight, "smooth"), 0.5)
    added = texels.changed(half, weight, "add")
    assert added.max() > 0.95 and (added[texels.covered][weight == 0.0] == 0.5).all()


def test_a_drawn_line_becomes_the_curve_of_a_parting_in_one_undo_step(folder: Path):
    with serving(folder) as client, page(client) as one:
        before = one.receive("locks", draft=False)["points"]
        one.receive("numbers")
        angle = np.linspace(-0.5, 0.5, 60)
        points = 0.09 * np.stack([0.1 + 0 * angle, np.cos(angle), np.sin(angle)], axis=1)
        one.send(kind="draw", place=["guides", "part", "line"], points=points.tolist(), gesture=3)
        document = one.receive("document", dirty=True)
        assert document["said"]["guides"]["part"] == {"line": "guides_part_line"}
        drawn = np.array(document["said"]["curves"]["guides_part_line"]["points"])
        assert 3 < len(drawn) < 20 and np.allclose(np.linalg.norm(drawn[:, 1:], axis=1), 9.0, atol=0.02)
        assert np.abs(one.receive("locks", draft=False)["points"] - before).max() > 0.001
        one.send(kind="draw", place=["guides", "part", "line"], points=points[::-1].tolist(), gesture=4)
        document = one.receive("document")
        assert list(document["said"]["curves"]) == ["guides_part_line"]
        for _ in range(2):
            one.send(kind="undo")
            document = one.receive("document")
        assert not document["dirty"] and not document["undo"]
        one.send(kind="draw", place=["guides", "part", "line"], points=[[0, 0.09, 0]] * 2, gesture=5)
        assert one.receive_trouble() == "draw: the stroke has no length; draw a line over the scalp"
