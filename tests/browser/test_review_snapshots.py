"""Snapshots and comparison of looks on the review page."""

from __future__ import annotations

import itertools
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from review import Review

AXES = (("x", "width"), ("y", "height"))


def show(review: Review, tab: str) -> None:
    """Shows a tab of the dock."""
    review.page.get_by_role("tab", name=tab).click()


def set_curl(review: Review, **values: Any) -> None:
    show(review, "Settings")
    for name, value in values.items():
        field = review.page.locator(f'[data-setting="curl.{name}"] > .field-head input.number')
        field.fill(str(value))
        field.press("Enter")
    review.answered()
    review.settled()


def take(review: Review) -> None:
    """Takes a snapshot by its key and waits for its thumbnail."""
    before = review.get("ringlet.model.snapshots.length")
    review.page.locator("main canvas").focus()
    review.page.keyboard.press("s")
    review.until(f"ringlet.model.snapshots.length == {before + 1} && ringlet.model.pictures.size == {before + 1}")


def look_of(review: Review, *order: str) -> np.ndarray:
    """The picture of some looks, next to one another."""
    review.get(f"(ringlet.viewer.looks.order = {list(order)}, ringlet.viewer.looks.arrangement = 'split')")
    return review.picture()


def test_a_snapshot_is_taken_compared_loaded_noted_and_deleted(opened: Any, folder: Path):
    review: Review = opened(viewport={"width": 1280, "height": 800})
    page = review.page
    first = review.locks()
    show(review, "Snapshots")
    page.locator(".author").fill("Ann")
    page.locator(".author").press("Enter")
    take(review)
    review.until("document.querySelector('.card img')?.naturalWidth == 400")
    set_curl(review, width=2.5)
    take(review)
    show(review, "Snapshots")
    cards = page.get_by_role("list", name="Snapshots").locator(".card")
    assert cards.count() == 2 and "Ann" in cards.first.inner_text()
    cards.nth(1).get_by_role("textbox").fill("as agreed")
    cards.nth(1).get_by_role("textbox").blur()
    review.until("ringlet.model.snapshots[0].note == 'as agreed'")
    page.get_by_role("button", name="Compare with ‘as agreed’").click()
    review.until("ringlet.viewer.compared && ringlet.viewer.hair.b.table")
    assert page.locator(".look-label b").all_inner_texts() == ["now", "as agreed"]
    assert "Ann" in page.locator('.look-label[data-side="b"] span').inner_text()
    page.get_by_role("button", name="Changes (1)").click()
    assert page.locator(".compare-changes tbody tr").all_inner_texts() == ["curl.width\t2.5\t1.0"]
    page.get_by_role("button", name="End", exact=True).click()
    review.until("!ringlet.viewer.compared")
    cards.nth(1).get_by_role("button", name="Load").click()
    review.until("ringlet.model.said('recipe', ['curl', 'width']) == 1 && ringlet.model.settled")
    review.settled()
    assert np.array_equal(review.locks(), first)
    page.keyboard.press("Control+z")
    review.until("ringlet.model.said('recipe', ['curl', 'width']) == 2.5")
    cards.first.get_by_role("button", name="Delete").click()
    page.get_by_role("dialog").get_by_role("button", name="Delete", exact=True).click()
    review.until("ringlet.model.snapshots.length == 1")
    page.reload()
    review.until("window.ringlet?.model.snapshots.length == 1")
    stored = list((folder / "small.review/snapshots").glob("*.recipe.toml"))
    assert len(stored) == 1 and tomllib.loads(stored[0].read_text())["curl"]["width"] == 1.0
    assert not review.errors


def test_four_looks_have_one_camera_and_their_labels(opened: Any):
    review: Review = opened(viewport={"width": 1280, "height": 800}, pixels=0.1)
    page = review.page
    take(review)
    for width in (1.8, 2.6):
        set_curl(review, width=width)
        take(review)
    set_curl(review, width=3.2)
    for card in (0, 1, 2):
        review.get(f"document.querySelectorAll('.thumbnail')[{card}].click()")
        review.until(f"ringlet.viewer.looks.order.length == {card + 2}")
    review.until("ringlet.viewer.hair.d.table")
    labels = [label.bounding_box() for label in page.locator(".look-label").all()]
    assert len(labels) == 4
    corners = {(round(box["x"]), round(box["y"])) for box in labels}
    assert len(corners) == 4
    for one, other in itertools.combinations(labels, 2):
        apart = [max(one[at], other[at]) - min(one[at] + one[size], other[at] + other[size]) for at, size in AXES]
        assert max(apart) >= 0  # no label is over another
    whole = review.picture()
    for side in "abcd":
        assert look_of(review, side).shape == whole.shape
    review.get("(ringlet.viewer.looks.order = ['a', 'b', 'c', 'd'])")
    page.get_by_role("button", name="Remove ‘now’ from the comparison").click()
    assert page.locator(".look-label").count() == 3
    assert not review.errors


def test_the_difference_of_two_looks_is_where_they_differ(opened: Any):
    review: Review = opened(viewport={"width": 1000, "height": 640}, pixels=0.25)
    page = review.page
    page.get_by_label("Compare looks").select_option("now")
    review.until("ringlet.viewer.compared && ringlet.viewer.hair.b.table")
    page.get_by_label("Arrangement of the looks").select_option("difference")
    saturation = lambda image: image.max(axis=2) - image.min(axis=2)  # noqa: E731
    assert saturation(review.picture()).max() < 12  # two equal looks
    set_curl(review, width=3)
    tinted = saturation(review.clear_picture()) > 60
    assert 0.001 < tinted.mean() < 0.6
    assert not tinted[:20, :20].any()
    assert page.get_by_text("orange: brighter in the first").is_visible()
    assert not review.errors


@pytest.mark.parametrize("width, height", [(390, 844), (1280, 800)])
def test_the_dock_covers_no_control(opened: Any, width: int, height: int):
    review: Review = opened(viewport={"width": width, "height": height}, has_touch=True, is_mobile=width != 1280)
    if width == 390:
        review.page.get_by_role("navigation", name="Panels").get_by_role("button", name="View").click()
    review.page.get_by_role("button", name="Take a snapshot (S)").click()
    review.until("ringlet.model.pictures.size == 1")
    review.page.keyboard.press("t")
    box = review.page.locator(".dock").bounding_box()
    assert box["x"] >= 0 and box["x"] + box["width"] <= width
    assert review.get("document.documentElement.scrollWidth") <= width
