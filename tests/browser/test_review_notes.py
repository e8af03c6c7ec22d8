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
    page.get_by_label("Resolved").check()
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
    list_ = "document.querySelector('[aria-label=\"Reference pictures\"]')"
    assert review.get(f"{list_}.scrollWidth") == review.get(f"{list_}.clientWidth")  # nothing is cut by the dock
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
