"""Notes, reference pictures, bookmarks and the sheet on the review page."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from review import Review


def point_of_lock(review: Review, row: int = 2) -> np.ndarray:
    """Middle of a lock [m]."""
    locks = "ringlet.viewer.hair.a.locks"
    return np.array(
        review.get(
            f"Array.from({locks}.points.slice(3 * ({locks}.offsets[{row}] + 20), 3 * ({locks}.offsets[{row}] + 21)))"
        )
    )


def test_a_note_with_arrows_brings_back_its_view_and_is_exported(opened: Any, folder: Path, tmp_path: Path):
    review: Review = opened(viewport={"width": 1280, "height": 800})
    page = review.page
    page.locator("main canvas").focus()
    page.keyboard.press("a")
    page.get_by_label("Text of the note").fill("less frizz here")
    page.mouse.click(*review.project(point_of_lock(review)))
    page.get_by_role("button", name="Arrow").click()
    page.mouse.move(420, 150)
    page.mouse.down()
    page.mouse.move(520, 250, steps=4)
    page.mouse.up()
    clear = review.get("ringlet.viewer.clear")  # what the camera sees between the panels while it is drawn
    page.get_by_role("button", name="Keep", exact=True).click()
    review.until("ringlet.model.notes.length == 1")
    eye = review.get("ringlet.viewer.camera.position.toArray()")
    stored = tomllib.loads(next((folder / "small.review/notes").glob("*.toml")).read_text())
    assert stored["lock"] == review.get("ringlet.viewer.hair.a.locks.ids[2]") and stored["text"] == "less frizz here"
    tail, tip = np.array(stored["strokes"][0][:2])  # in heights of the picture, from its middle
    middle = np.array([clear["x"] + clear["width"] / 2, clear["y"] + clear["height"] / 2])
    assert tail == pytest.approx((np.array([420, 150]) - middle) * (1, -1) / clear["height"], abs=1e-3)
    assert tip == pytest.approx((np.array([520, 250]) - middle) * (1, -1) / clear["height"], abs=1e-3)
    review.get("(ringlet.viewer.orbit(0.8, 0.1), ringlet.viewer.move())")
    review.until("!document.querySelector('.marks polyline')")  # of another view
    page.get_by_role("button", name="Show note 1").click()
    assert review.get("ringlet.viewer.camera.position.toArray()") == pytest.approx(eye)
    review.until("document.querySelector('.marks polyline')")
    page.get_by_role("button", name="Camera, light and sheet").click()
    with page.expect_download() as download:
        page.get_by_role("button", name="Save a sheet of five angles").click()
    download.value.save_as(tmp_path / "sheet.png")
    pixels = np.asarray(Image.open(tmp_path / "sheet.png").convert("RGB"), np.int64)
    marks = (np.abs(pixels - (255, 180, 94)).max(axis=2) < 25).nonzero()[0]  # of the arrow, in the row of notes
    assert len(marks) > 200 and marks.min() > 560
    page.get_by_label("resolved").check()
    review.until("ringlet.model.notes[0].resolved")
    assert not review.errors


def test_a_reference_is_shown_moved_and_gives_the_hair_its_color(opened: Any, folder: Path, tmp_path: Path):
    Image.new("RGB", (60, 80), (96, 60, 36)).save(tmp_path / "photo.png")
    review: Review = opened(viewport={"width": 1280, "height": 800})
    page = review.page
    page.keyboard.press("t")
    page.get_by_role("tab", name="References").click()
    page.locator("input[type=file]").set_input_files(tmp_path / "photo.png")
    review.until("document.querySelector('.reference')?.naturalWidth == 60")
    box = page.locator(".reference").bounding_box()
    page.mouse.move(box["x"] + box["width"] - 20, box["y"] + 20)
    page.mouse.down()
    page.mouse.move(box["x"] + box["width"] + 60, box["y"] + 60, steps=4)
    page.mouse.up()
    height = review.get("ringlet.viewer.clear.height")
    review.until(f"Math.abs(ringlet.model.references[0].x + 0.35 - {80 / height}) < 0.001")
    assert review.get("ringlet.model.references[0].y") == pytest.approx(-40 / height, abs=1e-3)
    page.get_by_label("Where ‘photo.png’ is").select_option("over")
    review.until("document.querySelector('.reference').style.opacity == '0.5'")
    page.get_by_role("button", name="Pick the hair's color").click()
    page.locator(".reference").click(position={"x": 100, "y": 20})
    review.until("ringlet.model.said('recipe', ['color', 'melanin']) !== undefined")
    color = tomllib.loads(review.text())["color"]
    assert 0.4 < color["melanin"] < 0.9
    page.keyboard.press("Control+z")
    review.until("ringlet.model.said('recipe', ['color']) === undefined")
    assert not review.errors


def test_answers_overwrite_no_note_that_is_typed_and_no_picture_that_is_moved(opened: Any, tmp_path: Path):
    Image.new("RGB", (60, 80), (96, 60, 36)).save(tmp_path / "photo.png")
    review: Review = opened(viewport={"width": 1280, "height": 800})
    page = review.page
    note = "author: 'A', look: ringlet.look.state, at: null, lock: null, point: 0, strokes: []"
    write = f"ringlet.model.say({{{{ kind: 'write_note', text: '{{}}', {note} }}}})"
    page.keyboard.press("t")
    page.get_by_role("tab", name="Notes").click()
    review.get(write.format("first"))
    text = page.get_by_label("Text of note 1")
    text.click()
    page.keyboard.press("End")
    page.keyboard.type(", softer")
    review.get(write.format("second"))
    review.until("ringlet.model.notes.length == 2")
    assert text.input_value() == "first, softer"
    page.keyboard.press("Tab")
    review.until("ringlet.model.notes[0].text == 'first, softer'")
    # The slider of a card is moved after the picture was dragged, which leaves the focus where it was.
    page.get_by_role("tab", name="References").click()
    page.locator("input[type=file]").set_input_files(tmp_path / "photo.png")
    review.until("document.querySelector('.reference')?.naturalWidth == 60")
    review.laid_out()
    size = page.get_by_label("size of ‘photo.png’")
    size.focus()
    box = page.locator(".reference").bounding_box()
    page.mouse.move(box["x"] + 20, box["y"] + 20)
    page.mouse.down()
    page.mouse.move(box["x"] + 100, box["y"] + 60, steps=4)
    page.mouse.up()
    moved = -0.35 + 80 / review.get("ringlet.viewer.clear.height")
    review.until(f"Math.abs(ringlet.model.references[0].x - {moved}) < 0.001")
    before = review.get("ringlet.model.references[0].scale")
    assert page.evaluate("document.activeElement.type") == "range"
    page.keyboard.press("ArrowRight")
    review.until(f"ringlet.model.references[0].scale > {before}")
    assert review.get("ringlet.model.references[0].x") == pytest.approx(moved, abs=1e-3)
    assert not review.errors


def test_light_lens_and_bookmarks_are_kept_with_the_recipe_for_other_browsers(opened: Any, serve: Any):
    server = serve("small.recipe.toml")
    review: Review = opened(server)
    page = review.page
    size = "ringlet.viewer.view.focalLength / ringlet.viewer.camera.position.distanceTo(ringlet.viewer.controls.target)"
    before = review.get(size)
    page.get_by_role("button", name="Camera, light and sheet").click()
    page.get_by_label("Focal length").fill("50")
    page.get_by_label("Light rotation").fill("90")
    review.settled()
    assert review.get(size) == pytest.approx(before)  # of the subject in the picture
    page.get_by_role("button", name="Store bookmark 2").click()
    review.until("ringlet.model.views['0']?.light_turn == 90 && ringlet.model.views['2']")
    page.close()
    other: Review = opened(server)
    other.until("Math.abs(ringlet.viewer.view.focalLength - 50) < 0.1 && ringlet.viewer.stage.lights.turn == 90")
    other.page.get_by_role("button", name="Camera, light and sheet").click()
    assert other.page.get_by_role("button", name="Recall bookmark 2").is_visible()
    assert not other.errors
