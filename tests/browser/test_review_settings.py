"""The settings on the review page: their first sight, the search over all stages, and pins."""

from __future__ import annotations

import tomllib
from typing import Any

from review import Review

# Heights of the panel for every operator, with `said` of its settings in the file; the page alone, without the server.
HEIGHTS = """(said) => {
    const { model } = ringlet, recipe = model.documents.recipe;
    const places = [...recipe.stages.filter(({ place }) => place[0] !== 'shape').map(({ place }) => place[0])];
    recipe.values = { ...recipe.values, shape: model.welcome.operators.map(op => ({ op })) };
    const heights = {};
    const measure = (name, place) => {
        recipe.said = {};
        model.choose('recipe', ['hairs']);
        const fields = () => [...document.querySelectorAll('.settings > .fields > .field')];
        model.choose('recipe', place);
        const table = Object.fromEntries(
            fields().slice(-said || Infinity).map(one => [one.dataset.setting.split('.').at(-1), {}]));
        let at = recipe.said;
        place.forEach((part, k) => at = at[part] = k + 1 < place.length ? {} : table);
        model.tell('document');
        heights[name] = [document.querySelector('.settings').scrollHeight,
            fields().filter(one => one.checkVisibility()).length];
    };
    for (const name of places) measure(name, [name]);
    model.welcome.operators.forEach((op, k) => measure(op, ['shape', k]));
    return heights;
}"""


def test_the_first_sight_of_every_operator_is_short(opened: Any):
    review: Review = opened(viewport={"width": 1280, "height": 800})
    for said in (0, 9):  # the examples set up to 9 settings of an operator
        heights = review.page.evaluate(HEIGHTS, said)
        assert len(heights) > 25
        assert {name: height for name, (height, _) in heights.items() if height > 640} == {}
        assert heights["curl"][1] == 5 + said
    assert not review.errors


def test_a_search_finds_settings_of_all_stages_and_shows_the_one_that_is_chosen(opened: Any):
    review: Review = opened(viewport={"width": 1280, "height": 800})
    page = review.page
    page.locator("main canvas").focus()
    page.keyboard.press("/")
    page.keyboard.type("per_lock")
    found = page.locator(".search-results [role=option]")
    assert found.first.inner_text().startswith("per lock")
    page.get_by_label("Search settings").fill("flat")
    assert any(text.startswith("flatness") for text in found.all_inner_texts())
    stages = set(page.locator(".found-stage").all_inner_texts())
    assert stages > {"curl"}  # also what is called flat in other stages, or described so
    page.get_by_label("Search settings").fill("hairs stray distance")
    page.keyboard.press("Enter")
    assert review.get("ringlet.model.chosen.place[0]") == "hairs"
    assert review.get("document.activeElement.closest('.field').dataset.setting").startswith("hairs.")
    assert page.locator(".field.found").is_visible() and not page.locator(".search-results").is_visible()
    page.keyboard.press("Escape")
    page.locator("main canvas").focus()
    page.keyboard.press("/")
    page.keyboard.type("nothing is called this")
    assert "No setting" in page.locator(".search-results").inner_text()
    page.keyboard.press("Escape")
    assert page.locator(".fields").is_visible()
    assert not review.errors


def test_a_pinned_setting_is_at_first_sight_of_its_stage(opened: Any):
    review: Review = opened(viewport={"width": 1280, "height": 800})
    flatness = review.page.locator('[data-setting="curl.flatness"]')
    assert not flatness.is_visible()
    review.show_all_settings()
    review.unfold("curl.flatness")
    flatness.hover()
    flatness.get_by_role("button", name="Pin flatness").click()
    review.page.get_by_role("button", name="Fewer settings").click()
    assert flatness.is_visible() and not review.page.locator('[data-setting="curl.attract"]').is_visible()
    review.page.reload()
    review.until("window.ringlet?.model.settled")
    assert flatness.is_visible()
    flatness.hover()
    review.unfold("curl.flatness")
    flatness.get_by_role("button", name="Unpin flatness").click()
    assert not flatness.is_visible()


def test_shorter_tighter_and_parted_on_the_left_takes_five_clicks_and_three_drags(opened: Any):
    review: Review = opened(viewport={"width": 1280, "height": 800})
    page = review.page
    done = {"clicks": 0, "drags": 0}

    def click(part: Any) -> None:
        part.click()
        done["clicks"] += 1

    def drag(setting: str, by: float) -> float:
        """Drags the knob of a setting by a fraction of its slider; returns the value that the recipe has then."""
        slider = review.slider(setting)
        slider.scroll_into_view_if_needed()
        at = slider.evaluate("(input) => (input.value - input.min) / (input.max - input.min)")
        review.drag(slider, at, at + by)
        done["drags"] += 1
        return float(slider.input_value())

    click(page.locator('[data-stage="guides"]'))
    length = float(review.slider("guides.length").input_value())
    assert drag("guides.length", -0.1) < length
    click(page.get_by_role("button", name="All settings"))
    click(page.locator('[data-setting="guides.part_line"] > .field-head > .unfold'))
    click(page.locator('[data-setting="guides.part_line"] summary').first)
    assert drag("guides.part_line.offset", 0.02) > 0.0  # the character's left is at +X
    click(page.locator('[data-stage="curl"]'))
    width = float(review.slider("curl.width").input_value())
    assert drag("curl.width", -0.1) < width
    recipe = tomllib.loads(review.text())
    assert recipe["guides"]["part_line"]["offset"] > 0.0 and not review.errors
    assert done == {"clicks": 5, "drags": 3}  # docs/review_settings.md says so
