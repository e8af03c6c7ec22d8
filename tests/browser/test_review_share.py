"""The share page in a browser: from the disk, without a server."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from review import BLIND, PATIENCE, Review, coarse

import ringlet


def test_a_share_page_opens_from_disk_and_turns(browser: Any, folder: Path, tmp_path: Path):
    output = tmp_path / "look.html"
    ringlet.share(folder / "small.recipe.toml", output)
    context = browser.new_context(viewport={"width": 600, "height": 500}, offline=True, reduced_motion="reduce")
    context.set_default_timeout(1000 * PATIENCE)
    page = context.new_page()
    errors, asked = [], []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("request", lambda request: asked.append(request.url))
    page.add_init_script(coarse(0.5))
    page.goto(output.as_uri())
    page.wait_for_function("window.look?.ready")
    assert page.title() == page.get_by_role("heading").inner_text() == "small"
    assert page.get_by_role("status").inner_text().endswith("hairs")

    def picture() -> np.ndarray:
        return Review.picture_of(page, "look.viewer")

    front = picture()
    assert front.std() > 10  # hair and a head before a wall
    assert not page.evaluate("look.viewer.turntable")  # who wants less motion starts it by hand
    page.keyboard.press(" ")
    page.wait_for_function("look.viewer.turntable")
    page.keyboard.press(" ")
    eye = page.evaluate("look.viewer.camera.position.toArray()")
    page.keyboard.press("ArrowLeft")
    assert page.evaluate("look.viewer.camera.position.toArray()") != eye
    page.get_by_label("Light", exact=True).select_option(index=2)
    assert np.abs(picture() - front).max() > 20
    assert asked == [output.as_uri()] and not errors
    context.close()


def test_the_review_saves_a_share_page(opened: Any, browser: Any, tmp_path: Path):
    review: Review = opened()
    review.get("(ringlet.viewer.orbit(0.5, 0.1), ringlet.viewer.move())")
    with review.page.expect_download() as saved:
        review.page.get_by_role("button", name="Save a share page").click()
    assert saved.value.suggested_filename == "small.html"
    saved.value.save_as(tmp_path / "small.html")
    context = browser.new_context(viewport={"width": 600, "height": 500}, offline=True, reduced_motion="reduce")
    context.set_default_timeout(1000 * PATIENCE)
    page = context.new_page()
    page.add_init_script(BLIND)
    page.goto((tmp_path / "small.html").as_uri())
    page.wait_for_function("window.look?.ready")
    eyes = [
        one.evaluate(f"{name}.viewer.camera.position.x") for one, name in ((review.page, "ringlet"), (page, "look"))
    ]
    assert abs(eyes[0] - eyes[1]) < 1e-6
    assert page.locator(".undrawn").is_visible()
    context.close()
