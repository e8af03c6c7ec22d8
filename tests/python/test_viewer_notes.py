"""What else a review keeps next to its recipe: notes, reference pictures, bookmarks; and cameras of the scene."""

from __future__ import annotations

import io
import tomllib
from pathlib import Path

import numpy as np
import pytest
from pages import page, serving
from PIL import Image
from pxr import Gf, Usd, UsdGeom
from ringlet.data.pigment import HAIR_COLORS, absorption, display_color, pigments_of_color, reflectance
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.keep.reviewing import Reviewing
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import WriteNote
from ringlet.viewer.publisher import Publisher
from test_viewer_snapshots import LOOK, picture


def test_a_note_is_a_readable_file_that_all_pages_see(folder: Path):
    with serving(folder) as client, page(client, "one") as one, page(client, "two") as two:
        ids = one.receive("locks")["ids"]
        two.receive("notes", notes=[])
        two.send(
            kind="write_note", author="Ben", text="less frizz here", look={**LOOK, "frame": 3.0}, at=[0.0, 0.09, 0.0],
            lock=int(ids[1]), point=12, strokes=[[[0.1, 0.2], [0.15, 0.25]]],
        )  # fmt: skip
        note = one.receive("notes")["notes"][0]
        two.receive("notes")
        assert (note["author"], note["lock"], note["point"], note["look"]["frame"]) == ("Ben", ids[1], 12, 3.0)
        one.send(kind="edit_note", id=note["id"], resolved=True)
        assert two.receive("notes")["notes"][0]["resolved"]
    file = next((folder / "small.review/notes").iterdir())
    stored = tomllib.loads(file.read_text())
    assert stored["text"] == "less frizz here" and stored["strokes"] == [[[0.1, 0.2], [0.15, 0.25]]]
    with serving(folder) as client, page(client) as one:
        kept = one.receive("notes")["notes"]
        assert [each["id"] for each in kept] == [note["id"]] and kept[0]["resolved"]
        one.send(kind="delete_note", id=note["id"])
        one.receive("notes", notes=[])
    assert not file.exists()


def test_an_empty_note_is_refused(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.receive("notes")
        one.send(kind="write_note", text="  ", look=LOOK)
        assert "note: is empty" in one.receive_trouble()


def test_a_reference_is_kept_and_placed(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.receive("references", references=[])
        one.send(kind="add_reference", name="photo.jpg", picture=picture((200, 150, 90), "JPEG", (40, 30)))
        entry = one.receive("references")["references"][0]
        assert (entry["name"], entry["mode"]) == ("photo.jpg", "next")
        data = one.receive("picture", name=f"references/{entry['id']}")["data"].tobytes()
        assert Image.open(io.BytesIO(data)).size == (40, 30)
        one.send(kind="place_reference", id=entry["id"], mode="over", opacity=0.3, x=0.1, y=-0.2, scale=1.5)
        placed = one.receive("references")["references"][0]
        assert (placed["mode"], placed["opacity"], placed["scale"]) == ("over", 0.3, 1.5)
    files = folder / "small.review/references"
    assert (files / f"{entry['id']}.jpg").read_bytes() == data
    with serving(folder) as client, page(client) as one:
        assert one.receive("references")["references"] == [placed]
        one.send(kind="delete_reference", id=entry["id"])
        one.receive("references", references=[])
    assert not list(files.iterdir())


def test_what_the_session_itself_wrote_is_not_published_again(folder: Path):
    project, published = Project(folder), Publisher()
    review = Reviewing(project, published, notice=lambda text: None)
    review.open(Files(folder / "small.recipe.toml", project))
    review.handle(WriteNote.model_validate({"kind": "write_note", "text": "less frizz", "look": LOOK}))
    published.clear("notes")
    review.reload()
    assert not published.subjects("notes")
    next((folder / "small.review/notes").iterdir()).unlink()
    review.reload()
    assert published.subjects("notes")


@pytest.mark.parametrize("melanin, redness", [(0.95, 0.1), (0.8, 0.9), (0.6, 0.95), (0.28, 0.5), (0.05, 0.2)])
def test_a_picked_color_gives_the_melanin_that_has_it(melanin: float, redness: float):
    color = display_color(reflectance(absorption(melanin, redness), 0.38))
    found = pigments_of_color(color, 0.38)
    assert found[0] == pytest.approx(melanin, abs=1e-3) and found[1] == pytest.approx(redness, abs=2e-2)
    assert found[2] < 1e-4
    assert pigments_of_color([0.02, 0.05, 0.5], 0.38)[2] > 0.2  # no melanin is blue


def test_the_eyedropper_sets_melanin_and_redness_in_one_undo_step(folder: Path):
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text() + "\n[color]\nmelanin = { value = 0.9, vary = 0.1 } # dark\n")
    wanted = HAIR_COLORS["ginger"]
    linear = display_color(wanted.reflectance)
    color = "#" + "".join(f"{round(255 * (1.055 * c ** (1 / 2.4) - 0.055)):02x}" for c in linear)
    with serving(folder) as client, page(client) as one:
        before = one.receive("document")["text"]
        one.send(kind="pick_color", color=color)
        document = one.receive("document", dirty=True)
        assert document["values"]["color"]["melanin"]["value"] == pytest.approx(wanted.melanin, abs=0.01)
        assert document["values"]["color"]["redness"]["value"] == pytest.approx(wanted.redness, abs=0.05)
        assert document["said"]["color"]["melanin"]["vary"] == 0.1 and "# dark" in document["text"]
        one.send(kind="undo")
        assert one.receive("document")["text"] == before
        one.send(kind="pick_color", color="#0030ff")
        while "a dye has #0030ff" not in one.receive("notice")["message"]:
            pass


def test_bookmarks_and_light_are_kept_with_the_recipe(folder: Path):
    with serving(folder) as client, page(client, "one") as one, page(client, "two") as two:
        one.receive("views", views={})
        two.receive("views", views={})
        look = {**LOOK, "light": "daylight", "light_turn": 70.0, "focal_length": 50.0}
        one.send(kind="keep_view", slot=0, look=look)
        one.send(kind="keep_view", slot=3, look=LOOK)
        while set(two.receive("views")["views"]) != {"0", "3"}:
            pass
    stored = tomllib.loads((folder / "small.review/views.toml").read_text())
    assert stored["view"]["0"]["light_turn"] == 70.0
    with serving(folder) as client, page(client) as one:
        views = one.receive("views")["views"]
        assert views["0"]["focal_length"] == 50.0 and views["3"]["light"] == "studio"


def test_cameras_of_the_head_are_offered(folder: Path):
    stage = Usd.Stage.Open(str(folder / "head.usda"))
    camera = UsdGeom.Camera.Define(stage, "/cameras/close")
    camera.CreateFocalLengthAttr(50.0)
    camera.CreateVerticalApertureAttr(24.0)
    UsdGeom.XformCommonAPI(camera).SetTranslate(Gf.Vec3d(0, 10, 80))
    UsdGeom.Camera.Define(stage, "/cameras/flat").CreateProjectionAttr("orthographic")
    stage.Save()
    with serving(folder) as client, page(client) as one:
        (found,) = one.receive("cameras")["cameras"]
    eye, target = np.array(found["camera"]).reshape(2, 3)
    assert found["name"] == "close" and found["focal_length"] == pytest.approx(50.0 * 36.0 / 24.0)
    assert (eye - target)[:2] == pytest.approx([0.0, 0.0], abs=1e-9) and 0.6 < (eye - target)[2] < 0.9


def test_a_file_that_cannot_be_read_is_reported_and_left(folder: Path):
    review = folder / "small.review"
    review.mkdir()
    (review / "views.toml").write_text("view = 3")
    with serving(folder) as client, page(client) as one:
        one.receive("views", views={})
        assert "views.toml: cannot be read" in one.receive("notice")["message"]
        one.send(kind="keep_view", slot=1, look=LOOK)
        assert "mend it" in one.receive_trouble()
    assert (review / "views.toml").read_text() == "view = 3"
