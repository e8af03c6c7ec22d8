"""The review page: accessibility, layout, drawing on demand and downloads."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from review import Review

SIXTY_FRAMES = """() => new Promise(done => {
    let left = 60;
    const next = () => left-- ? requestAnimationFrame(next) : done();
    next();
})"""


def test_an_idle_page_draws_nothing(opened: Any):
    review: Review = opened(pixels=0.2, live=True)
    review.settled()
    review.until("ringlet.model.measured && ringlet.viewer.idle")
    before = review.get("ringlet.viewer.pictures")
    review.page.evaluate(SIXTY_FRAMES)
    assert review.get("ringlet.viewer.pictures") == before


def test_the_page_says_when_it_has_settled(opened: Any):
    review: Review = opened(pixels=0.2, live=True)
    assert review.get("ringlet.settled")
    change = "ringlet.model.say({ kind: 'set', changes: [[['curl', 'width'], 2]], gesture: 1 })"
    assert not review.get(f"({change}, ringlet.settled)")
    review.settled()
    assert review.get("ringlet.model.said('recipe', ['curl', 'width'])") == 2
    assert not review.get("(ringlet.viewer.move(), ringlet.settled)")
    review.settled()
    assert not review.get("(document.querySelector('.dock').style.width = '200px', ringlet.laidOut)")
    review.laid_out()
    assert not review.errors


REACH = (Path(__file__).parent / "reach.js").read_text()


def test_controls_are_labelled_legible_and_reachable_by_keyboard(opened: Any):
    review: Review = opened(pixels=0.2)
    review.get("ringlet.lock.choose(2)")
    assert review.page.evaluate(REACH) == {"nameless": [], "faint": []}
    review.get("ringlet.tools.brush.show(true)")
    assert review.page.evaluate(REACH) == {"nameless": [], "faint": []}
    review.page.keyboard.press("Escape")
    assert not review.get("ringlet.tools.brush.on")
    dark = review.picture().mean()
    review.page.get_by_label("Dark or light theme").press("Enter")
    assert review.get("document.documentElement.dataset.theme") == "light"
    assert review.page.evaluate(REACH) == {"nameless": [], "faint": []}
    assert abs(review.picture().mean() - dark) < 5  # the wall is that of the render in both
    review.slider("curl.width").focus()
    review.page.keyboard.press("ArrowRight")
    review.until("ringlet.model.documents.recipe.dirty")
    eye = review.get("ringlet.viewer.camera.position.toArray()")
    review.page.locator("main canvas").focus()
    review.page.keyboard.press("ArrowLeft")
    assert review.get("ringlet.viewer.camera.position.toArray()") != eye


def test_a_browser_without_webgl_shows_a_line_in_place_of_the_picture(opened: Any, folder: Path):
    review: Review = opened()
    page = review.page
    line = page.locator(".undrawn")
    assert line.inner_text().startswith("No picture: this browser has no WebGL 2. Turn on graphics acceleration")
    box, clear = line.bounding_box(), review.get("ringlet.viewer.clear")
    assert clear["x"] < box["x"] and box["x"] + box["width"] < clear["x"] + clear["width"]
    assert page.get_by_role("button", name="Save picture").is_disabled()
    assert page.get_by_role("button", name="Record a movie").is_disabled()
    locks = np.array(review.get("Array.from(ringlet.viewer.hair.a.locks.points)")).reshape(8, -1, 3)
    tip = locks[:, -1].argmax(axis=0)[1]  # the highest: no other is before it
    page.mouse.click(*review.project(locks[tip, -1]))
    assert review.get("ringlet.lock.rows") == [tip]
    page.keyboard.press("s")
    review.until("ringlet.model.pictures.size == 1")
    thumbnail = next((folder / "small.review/snapshots").glob("*.png"))
    assert np.asarray(Image.open(thumbnail).convert("L")).std() > 10  # the line is written on it
    assert not review.errors


def test_the_page_loads_no_external_resource(opened: Any):
    review: Review = opened()
    names = review.get("performance.getEntriesByType('resource').map(entry => new URL(entry.name).host)")
    assert set(names) == {review.get("location.host")}


def test_pictures_and_movies_are_saved(opened: Any):
    review: Review = opened(viewport={"width": 800, "height": 500}, pixels=0.5, live=True)
    for size, clear in (("", False), ("1080 × 1920", True)):
        review.page.get_by_role("button", name="Save picture").click()
        review.page.get_by_label("Size in pixels").select_option(size)
        review.page.get_by_label("Transparent background").set_checked(clear)
        with review.page.expect_download() as picture:
            review.page.get_by_role("dialog").get_by_role("button", name="Save", exact=True).click()
        assert picture.value.suggested_filename == "small.png"
        saved = Image.open(picture.value.path())
        assert saved.size == ((1080, 1920) if clear else (800, 500))
        alpha = np.asarray(saved.convert("RGBA"))[:, :, 3]
        assert (alpha[0, 0] < 10 and alpha[960, 540] > 245) if clear else alpha.min() == 255
    review.until("ringlet.viewer.canvas.width === 400")  # that of the page again, once the picture rests
    film = review.page.get_by_label("Record a movie")
    began = time.monotonic()
    film.click()
    for turn in (0.3, 0.6):
        review.get(f"(ringlet.viewer.orbit({turn}, 0), ringlet.viewer.move())")
        review.until("ringlet.viewer.current")
    review.until("document.querySelector('.recorded').textContent !== '0:00'")
    minutes, seconds = review.page.get_by_label("Recorded time").inner_text().split(":")
    assert 0 < 60 * int(minutes) + int(seconds) <= time.monotonic() - began + 1
    with review.page.expect_download() as movie:
        film.click()
    assert Path(movie.value.path()).stat().st_size > 1000


@pytest.mark.parametrize("width, height", [(820, 1180), (1180, 820)])
def test_every_control_is_reachable_on_a_tablet(opened: Any, width: int, height: int):
    review: Review = opened(viewport={"width": width, "height": height})
    review.get("ringlet.lock.choose(2)")
    outside = review.get(
        "[...document.querySelectorAll('.bar, .panel, .viewbar, .status, .bar button, .viewbar button')].filter(e => "
        "e.checkVisibility()).map(e => [e.className, e.getBoundingClientRect()]).filter(([, box]) => box.width && ("
        "box.left < -0.5 || box.top < -0.5 || box.right > innerWidth + 0.5 || box.bottom > innerHeight + 0.5))"
        ".map(([name]) => name)"
    )
    assert outside == []
    hidden = review.get(
        "[...document.querySelectorAll('.bar button, .viewbar button, .viewbar select, .lock button')].filter(e => "
        "e.checkVisibility() && e.getBoundingClientRect().width).filter(e => { const box = e.getBoundingClientRect(); "
        "return !e.contains(document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2)); })"
        ".map(e => e.ariaLabel || e.textContent)"
    )
    assert hidden == []
