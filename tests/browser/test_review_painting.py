"""Painting and drawing on the scalp, on the review page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from review import Review, different
from test_viewer_painting import unwrap


def test_a_map_is_painted_and_a_parting_drawn_on_the_scalp(opened: Any, folder: Path):
    unwrap(folder)
    review: Review = opened(viewport={"width": 1280, "height": 800}, pixels=0.25)
    page, mouse = review.page, review.page.mouse
    review.choose("guides")
    page.locator('[data-setting="guides.length"] summary', has_text="varies").click()
    page.get_by_role("button", name="Paint guides length on the scalp").click()
    review.until("ringlet.model.painted")
    white = review.picture()
    page.locator(".paint label", has_text="remove").click()
    x, y = review.project(np.array([0.0, 0.08, 0.04]))
    mouse.move(x - 30, y)
    mouse.down()
    mouse.move(x + 30, y, steps=4)
    mouse.up()
    review.until("ringlet.model.said('recipe', ['guides', 'length', 'map']) === 'guides_length'")
    review.until("ringlet.model.painted.map && ringlet.model.painted.values.some((one) => one < 200)")
    review.settled()
    assert different(review.picture(), white) > 0.002
    page.keyboard.press("Control+z")
    review.until("!ringlet.model.documents.recipe.undo")
    page.keyboard.press("Escape")
    assert not review.get("ringlet.tools.paint.on")
    review.get("ringlet.model.draw(['guides', 'part_line', 'curve'], 'parting')")
    mouse.move(x - 40, y)
    mouse.down()
    mouse.move(x + 40, y + 10, steps=6)
    mouse.up()
    review.until("ringlet.model.said('recipe', ['guides', 'part_line', 'curve']) === 'guides_part_line'")
    points = np.array(review.get("ringlet.model.said('recipe', ['curves', 'guides_part_line', 'points'])"))
    assert 8.0 < np.linalg.norm(points, axis=1).min() <= np.linalg.norm(points, axis=1).max() < 9.1
    assert not review.errors


def test_directions_are_combed_and_a_guide_is_drawn_off_the_head(opened: Any, folder: Path):
    unwrap(folder)
    review: Review = opened(viewport={"width": 1280, "height": 800})
    page, mouse = review.page, review.page.mouse
    review.choose("guides")
    review.get("ringlet.model.paint(['guides', 'direction'], 'guides direction')")
    review.until("ringlet.model.painted")
    assert page.locator(".paint .choice:visible").all_inner_texts() == ["remove", "smooth", "comb"]
    x, y = review.project(np.array([0.0, 0.08, 0.04]))
    mouse.move(x - 30, y)
    mouse.down()
    mouse.move(x + 30, y, steps=4)
    mouse.up()
    review.until("ringlet.model.said('recipe', ['guides', 'direction']) === 'guides_direction'")
    review.until("ringlet.model.painted.directions.some((one) => Math.abs(one) > 0.2)")
    page.keyboard.press("Escape")
    review.get("ringlet.model.draw(['guides', 'drawn'], 'a guide')")
    mouse.move(x, y)
    mouse.down()
    mouse.move(x + 60, y - 80, steps=6)
    mouse.move(x + 120, y - 160, steps=6)
    mouse.up()
    review.until("ringlet.model.said('recipe', ['guides', 'drawn'])?.[0] === 'guides_drawn'")
    points = np.array(review.get("ringlet.model.said('recipe', ['curves', 'guides_drawn', 'points'])"))
    distance = np.linalg.norm(points, axis=1)
    assert 8.0 < distance[0] < 9.1 and distance[-1] > 10.0  # from the root on the head into the air
    review.until("ringlet.model.guides.offsets.length === 8")
    for _ in range(2):
        page.keyboard.press("Control+z")
    review.until("!ringlet.model.documents.recipe.undo")
    assert not review.errors
