"""Looks and presets on the review page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from review import Review


def test_a_preset_is_shown_while_the_pointer_rests_on_it_and_taken_by_a_click(opened: Any, folder: Path):
    (folder / "wide.preset.toml").write_text("# Wide curls.\nringlet = 2\n[curl]\nwidth = 2.0\npitch = 2.5\n")
    review: Review = opened(viewport={"width": 1280, "height": 800})
    page = review.page
    before = review.text()
    page.get_by_role("button", name="Looks and presets").click()
    card = page.locator('[data-preset="wide.preset.toml"]')
    card.wait_for()
    assert page.locator('[data-preset^="looks/"]').count() > 12
    assert page.locator('[data-preset="looks/bob"] img').count() == 1
    first = review.get("Array.from(ringlet.viewer.hair.a.locks.points)")
    card.hover()
    review.until("ringlet.viewer.hair.a.locks.draft")
    assert review.get("Array.from(ringlet.viewer.hair.a.locks.points)") != first
    page.mouse.move(640, 400)
    review.until("!ringlet.viewer.hair.a.locks.draft")
    assert review.get("Array.from(ringlet.viewer.hair.a.locks.points)") == first
    assert review.text() == before and not review.get("ringlet.model.documents.recipe.undo")
    card.click()
    review.until("ringlet.model.said('recipe', ['curl', 'width']) === 2")
    review.drag(page.locator("#preset-part"), 0.98, 0.7, 0.5)
    review.until("ringlet.model.said('recipe', ['curl', 'width']) < 1.8")
    page.keyboard.press("Control+z")
    review.until("!ringlet.model.documents.recipe.undo")
    assert review.text() == before
    page.get_by_role("button", name="Keep a preset").click()
    page.get_by_role("textbox", name="Name", exact=True).fill("mine")
    page.get_by_role("dialog").get_by_role("button", name="Keep", exact=True).click()
    page.locator('[data-preset="mine.preset.toml"] img').wait_for()
    assert (folder / "mine.preset.jpg").exists() and "[curl]" in (folder / "mine.preset.toml").read_text()
    assert not review.errors
