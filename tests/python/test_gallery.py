"""The styles of the gallery, at a part of their locks and hairs, on their heads."""

from __future__ import annotations

import dataclasses
import re
import shutil
import tomllib
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from ringlet.data.groom import Groom
from ringlet.groom.check import check_groom
from ringlet.groom.load import load
from ringlet.groom.sections import STRAND
from ringlet.io import read_meshes
from ringlet.picture.bodies import PosedBody
from ringlet.picture.camera import frame
from ringlet.picture.sheet import draw_tile, subsample
from scipy.spatial import KDTree

import ringlet
from ringlet.groom import hairs_per_cm2, make_hairs, read_recipe

ROOT = Path(__file__).parents[2]
STYLES = {entry["name"]: entry for entry in tomllib.loads((ROOT / "docs/gallery.toml").read_text())["style"]}
HEADS = ("child", "adult", "torso")
ON_SCALPS = [(name, entry["head"]) for name, entry in STYLES.items() if "heads" not in entry]  # those of any head
LOCKS = 160  # of loose hair
LOCK_RADIUS = 3e-3  # of what a lock hides [m]
HIDDEN_FACE = 0.1  # largest part of eyes and nose that locks hide from the front


@cache
def recipe_text(name: str, head: str) -> str:
    """The recipe of a style on a head, with few locks where hair is loose."""
    recipe = ROOT / STYLES[name]["recipe"]
    tables = load(recipe)[1]
    scalp = f'[scalp]\nfile = "{ROOT}/examples/{head}/head.usdc"\nmesh = "/{head}/skin"\n'
    return f'ringlet = 2\nextends = "{recipe}"\n{scalp}' + (
        f"[locks]\ncount = {LOCKS}\n" if "count" in tables["locks"] else ""
    )


@pytest.fixture(scope="module", params=ON_SCALPS, ids=lambda p: p[0])
def style(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, str, Groom]:
    name, head = request.param
    path = tmp_path_factory.mktemp("gallery") / "style.recipe.toml"
    path.write_text(recipe_text(name, head))
    return name, head, ringlet.build_groom(path)


def test_there_are_thirty_styles_on_three_heads_with_short_recipes_and_a_page():
    assert len(STYLES) >= 30
    assert all(len((ROOT / entry["recipe"]).read_text().splitlines()) < 60 for entry in STYLES.values())
    assert {entry["head"] for entry in STYLES.values()} == set(HEADS)
    page = (ROOT / "docs/gallery.md").read_text()
    assert all(entry["recipe"] in page and f"## {entry['title']}\n" in page for entry in STYLES.values())
    assert all((ROOT / "docs" / picture).exists() for picture in re.findall(r"images/gallery/\w+\.jpg", page))


def test_a_picture_is_due_until_it_holds_the_digest_of_its_recipe_and_camera(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.syspath_prepend(str(ROOT / "docs"))
    import gallery

    monkeypatch.setattr(gallery, "FOLDER", tmp_path)
    (bob,) = (style for style in gallery.read_styles() if style.name == "bob")
    assert [names for _, names in gallery.due([bob], again=False)] == [["adult", "close"], ["child"]]
    mark = gallery.digest(bob.recipe, *bob.shots["close"])
    Image.new("RGB", (8, 8)).save(tmp_path / "bob_close.jpg", comment=mark.encode())
    assert [names for _, names in gallery.due([bob], again=False)] == [["adult"], ["child"]]
    moved = dataclasses.replace(bob.shots["close"][1], height=7.0)
    bob.shots["close"] = ("adult", moved)
    assert [names for _, names in gallery.due([bob], again=False)] == [["adult", "close"], ["child"]]


def test_a_picture_is_not_due_in_another_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.syspath_prepend(str(ROOT / "docs"))
    import gallery

    (bob,) = (style for style in gallery.read_styles() if style.name == "bob")
    mark = gallery.digest(bob.recipe, *bob.shots["close"])
    for folder in ("types", "looks"):
        shutil.copytree(ROOT / "examples" / folder, tmp_path / "examples" / folder)
    for head in HEADS:
        (tmp_path / "examples" / head).mkdir()
        shutil.copy(ROOT / "examples" / head / "head.usdc", tmp_path / "examples" / head)
    monkeypatch.setattr(gallery, "ROOT", tmp_path)
    assert gallery.digest(tmp_path / bob.recipe.relative_to(ROOT), *bob.shots["close"]) == mark


def test_locks_of_a_style_are_rooted_in_the_scalp_and_stay_out_of_the_head(style: tuple[str, str, Groom]):
    name, _, groom = style
    assert np.isin(groom.locks.curve["root_triangle"], groom.scalp.region("scalp")).all()
    assert np.isfinite(groom.locks.points).all() and (groom.locks.lengths() > 5e-4).all()
    meshes = read_meshes(groom.scalp_file, groom.cage)
    colliders = [mesh for mesh in meshes if mesh.name != groom.scalp.name and groom.shows(mesh.name)]
    found = check_groom(groom, colliders).summary()
    assert max(found[kind]["depth"] for kind in ("scalp", "body")) < 3e-3, name


def test_a_style_has_a_full_head_of_hair(style: tuple[str, str, Groom]):
    name, _, groom = style
    assert hairs_per_cm2(groom) > 115, name
    if (groom.locks.curve.get(STRAND, np.full(len(groom.locks), -1)) < 0).all():
        assert read_recipe(ROOT / STYLES[name]["recipe"]).hairs.density is not None, name


def test_a_style_is_seen_in_a_small_picture(style: tuple[str, str, Groom]):
    name, _, groom = style
    hairs = subsample(make_hairs(groom, fraction=0.05, wider=True).curves, 600)
    assert np.isfinite(hairs.points).all()
    camera = frame([groom.scalp.points], view="three_quarter", aspect=0.9)
    bald, styled = (
        draw_tile([PosedBody(groom.scalp, groom.scalp.points)], drawn, camera, (36, 40), None, 2).astype(int)
        for drawn in (hairs.take(np.zeros(1, int)), hairs)
    )
    assert (styled.mean(axis=2) < bald.mean(axis=2) - 12).mean() > 0.04, name


def test_a_style_leaves_the_face_free(style: tuple[str, str, Groom]):
    name, _, groom = style
    face = groom.scalp.points[np.unique(groom.scalp.triangles[groom.scalp.region("face")])]
    eyes_and_nose = face[(np.abs(face[:, 0]) < 0.045) & (np.abs(face[:, 1] - 0.36) < 0.02) & (face[:, 2] > 0.03)]
    before = groom.locks.points[groom.locks.points[:, 2] > eyes_and_nose[:, 2].min()]
    hidden = (KDTree(before[:, :2]).query(eyes_and_nose[:, :2])[0] < LOCK_RADIUS) if len(before) else np.zeros(1)
    assert hidden.mean() < HIDDEN_FACE, name
