"""Trust in the review page: gestures, numbers, problems, files and keys."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pytest
from conftest import Review


def number(review: Review, setting: str) -> Any:
    return review.page.locator(f'[data-setting="{setting}"] > .field-head input.number')


def test_a_slider_dragged_out_and_back_is_a_whole_groom_again(opened: Any):
    review: Review = opened()
    slider = review.slider("curl.width")
    box = slider.bounding_box()
    y, begin = round(box["y"] + box["height"] / 2), round(box["x"] + box["width"] / 3)
    review.page.mouse.move(begin, y)
    review.page.mouse.down()
    value = float(slider.input_value())
    for x in (begin + 60, begin):
        review.page.mouse.move(x, y, steps=3)
        review.until("ringlet.model.numbers.draft")
    assert abs(float(slider.input_value()) - value) <= float(slider.get_attribute("step"))
    log = "window.said = []; const say = ringlet.model.say; ringlet.model.say = function (m) { said.push(m); "
    review.page.evaluate(f"() => {{ {log} say.call(this, m); }} }}")
    review.page.mouse.up()
    review.until("said.some(message => message.kind == 'set' && message.resting)")
    review.settled()


# Typed in a field in cm whose value is 1.0, what the file says then; None is refused.
TYPED = {
    "1.5 mm": "1.5 mm",
    "1,5": 1.5,
    "*1.1": 1.1,
    "+10%": 1.1,
    "-50 %": 0.5,
    "(1 + 2) / 4": 0.75,
    "1 cm + 2 mm": 1.2,
    "1,500": None,
    "1.5.2": None,
    "2 furlongs": None,
    "1 + 2 mm": None,
    "-1": None,
    "50 cm": None,
    "": None,
    "wide": None,
}


def test_typed_numbers_are_taken_as_meant_or_refused(opened: Any):
    review: Review = opened()
    field = number(review, "curl.width")
    for typed, expected in TYPED.items():
        before = review.text()
        field.fill(typed)
        field.press("Enter")
        if expected is None:
            assert field.get_attribute("aria-invalid") == "true", typed
            assert field.input_value() == typed and review.text() == before
            assert review.page.locator('[data-setting="curl.width"] .refusal').first.inner_text()
            field.press("Escape")
            assert field.get_attribute("aria-invalid") is None and field.input_value() == "1"
        else:
            review.until("JSON.stringify(ringlet.model.said('recipe', ['curl', 'width'])) != '1'")
            assert tomllib.loads(review.text())["curl"]["width"] == expected, typed
            field.blur()
            review.page.keyboard.press("Control+z")
            review.until("ringlet.model.said('recipe', ['curl', 'width']) == 1")
    assert not review.errors


def test_the_label_of_a_number_scrubs_it(opened: Any):
    review: Review = opened()
    box = review.page.locator('[data-setting="curl.width"] > .field-head > label').bounding_box()
    x, y = box["x"] + 10, box["y"] + box["height"] / 2
    moved = []
    for key in ("", "Shift"):
        review.page.mouse.move(x, y)
        if key:
            review.page.keyboard.down(key)
        review.page.mouse.down()
        review.page.mouse.move(x + 60, y, steps=5)
        review.page.mouse.up()
        if key:
            review.page.keyboard.up(key)
        review.answered()
        moved.append(tomllib.loads(review.text())["curl"]["width"] - 1.0)
        review.page.keyboard.press("Control+z")
        review.until("ringlet.model.said('recipe', ['curl', 'width']) == 1")
    assert moved[0] == pytest.approx(10 * moved[1]) and moved[1] > 0


def test_a_groom_that_cannot_be_made_stays_in_sight_with_its_remedies(opened: Any, folder: Path):
    review: Review = opened()
    page = review.page
    locks = review.get("ringlet.viewer.hair.a.locks.points.length")
    field = number(review, "curl.pitch")
    field.fill("2 mm")
    field.press("Enter")
    problem = page.locator('[data-problem="groom"]')
    problem.wait_for()
    assert "locks.points is 40" in problem.inner_text()
    assert review.get("getComputedStyle(document.querySelector('.picture'), '::after').content") != "none"
    review.choose("locks")
    assert "wrong" in page.locator('[data-setting="locks.points"]').get_attribute("class")
    page.keyboard.press("Control+s")
    page.locator('[data-problem="save"]').wait_for()
    assert "2 mm" not in (folder / "small.recipe.toml").read_text()
    problem.get_by_role("button", name="Set points to").click()
    review.until("ringlet.model.settled && !ringlet.model.problems.length")
    assert review.get("ringlet.viewer.hair.a.locks.points.length") > 2 * locks
    assert not review.errors


def test_an_outside_write_is_loaded_and_a_conflict_is_merged(opened: Any, folder: Path):
    recipe = folder / "small.recipe.toml"
    review: Review = opened()
    page = review.page
    recipe.write_text(recipe.read_text().replace("pitch = 1.5", "pitch = 1.75"))
    review.until("ringlet.model.documents.recipe.said.curl.pitch == 1.75")
    assert not review.get("ringlet.model.documents.recipe.dirty")
    number(review, "curl.width").fill("2")
    number(review, "curl.width").press("Enter")
    review.until("ringlet.model.documents.recipe.dirty")
    recipe.write_text(recipe.read_text().replace("pitch = 1.75", "pitch = 1.25").replace("width = 1.0", "width = 1.3"))
    conflict = page.locator('[data-problem="conflict/recipe"]')
    conflict.wait_for()
    conflict.get_by_role("button", name="See and merge").click()
    merge = page.get_by_role("button", name="Merge", exact=True)
    assert merge.is_disabled()  # both changed the width
    page.get_by_label("curl.width: mine").check()
    merge.click()
    conflict.wait_for(state="detached")
    page.get_by_role("button", name="Save", exact=True).click()
    review.until("!ringlet.model.documents.recipe.dirty")
    curl = tomllib.loads(recipe.read_text())["curl"]
    assert (curl["width"], curl["pitch"]) == (2.0, 1.25)
    assert not review.errors


def test_keys_act_on_the_page_but_not_on_text_that_is_typed(opened: Any):
    review: Review = opened()
    page = review.page
    number(review, "curl.width").fill("2")
    number(review, "curl.width").press("Enter")
    review.until("ringlet.model.documents.recipe.dirty")
    page.get_by_role("button", name="Save as…").click()
    page.get_by_label("Name").fill("wide")
    page.keyboard.press("Control+z")  # of the text alone
    page.keyboard.press("Escape")
    review.answered()
    assert review.get("ringlet.model.documents.recipe.dirty")
    page.locator("body").click(position={"x": 500, "y": 300})
    page.keyboard.press("ArrowLeft")
    eye = review.get("ringlet.viewer.camera.position.toArray()")
    page.keyboard.press("f")
    assert review.get("ringlet.viewer.camera.position.toArray()") != eye
    page.keyboard.press("?")
    assert "Ctrl+Shift+Z" in page.get_by_role("dialog", name="Keys").inner_text()
    page.keyboard.press("Escape")
    page.keyboard.press("Control+z")
    review.until("!ringlet.model.documents.recipe.dirty")


def test_another_file_is_opened_after_unsaved_changes_are_saved(opened: Any, folder: Path):
    (folder / "other.recipe.toml").write_text(
        (folder / "small.recipe.toml").read_text().replace("count = 8", "count = 9")
    )
    review: Review = opened()
    page = review.page
    number(review, "curl.width").fill("2")
    number(review, "curl.width").press("Enter")
    review.until("ringlet.model.documents.recipe.dirty && ringlet.model.files.length")
    page.keyboard.press("Control+o")
    page.get_by_role("button", name="other.recipe.toml").click()
    page.get_by_role("button", name="Save them").click()
    review.until("ringlet.model.welcome.name == 'other.recipe.toml' && ringlet.model.settled")
    assert review.get("ringlet.viewer.hair.a.locks.ids.length") == 9
    assert "width = 2" in (folder / "small.recipe.toml").read_text()
    page.get_by_role("button", name="Save as…").click()
    page.get_by_label("Name").fill("third")
    page.get_by_role("dialog").get_by_role("button", name="Save", exact=True).click()
    review.until("ringlet.model.welcome.name == 'third.recipe.toml'")
    assert page.locator(".file-name").inner_text() == "third.recipe.toml"
    assert not review.errors
