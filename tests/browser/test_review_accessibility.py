"""Every state of the review page against WCAG 2.2 AA, as far as axe-core sees it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from conftest import REQUIRED
from review import Review

AXE = Path(__file__).parents[2] / "web/node_modules/axe-core/axe.min.js"
TAGS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"]
RUN = """([tags, part]) => axe.run(part, { runOnly: { type: "tag", values: tags }, resultTypes: ["violations"] })
    .then(({ violations }) => violations.flatMap(({ id, nodes }) =>
        nodes.map(({ html, failureSummary }) => `${id}: ${html.slice(0, 160)} ${failureSummary.slice(0, 200)}`)))"""

pytestmark = pytest.mark.skipif(not AXE.exists() and not REQUIRED, reason="axe-core is not installed: tools/web.sh")


class Checked:
    """A page, and what axe-core finds in each of its states."""

    def __init__(self, review: Review) -> None:
        self.review = review
        self.found: dict[str, list[str]] = {}
        review.page.evaluate(AXE.read_text())

    def check(self, state: str, part: str = "html") -> None:
        """Checks the page as it is; part: selector of what has changed in it since it was checked in whole."""
        violations = self.review.page.evaluate(RUN, [TAGS, part])
        if violations:
            self.found[state] = violations


def test_a_button_without_a_name_is_found(opened: Any):
    checked = Checked(opened(viewport={"width": 500, "height": 500}))
    checked.review.get("document.querySelector('.bar').append(document.createElement('button'))")
    checked.check("nameless")
    assert any(found.startswith("button-name") for found in checked.found["nameless"])


def test_all_of_the_page_is_in_landmarks_and_the_view_is_a_few_tabs_away(opened: Any):
    review: Review = opened(viewport={"width": 1280, "height": 800})
    Checked(review)
    found = review.page.evaluate("axe.run({ runOnly: ['region', 'landmark-unique'] })")
    assert [node["html"][:80] for rule in found["violations"] for node in rule["nodes"]] == []
    review.get("document.activeElement.blur()")
    for _ in range(3):
        review.page.keyboard.press("Tab")
    assert review.get("document.activeElement.textContent") == "To the view"
    review.page.keyboard.press("Enter")
    assert review.get("document.activeElement.closest('.viewbar') !== null")


def test_every_stage_of_a_recipe_is_accessible(opened: Any):
    review: Review = opened(viewport={"width": 1280, "height": 800})
    checked = Checked(review)
    checked.check("first sight")
    for stage in review.get("[...document.querySelectorAll('.stage-name')].map((one) => one.dataset.stage)"):
        review.choose(stage)
        review.show_all_settings()
        review.get("document.querySelector('.settings').scrollTop = 0")  # what is under the search is no target
        checked.check(stage, ".settings, .stack")
    review.get("ringlet.lock.choose(2)")
    checked.check("a lock")
    assert checked.found == {}


def test_every_tool_of_a_recipe_is_accessible(opened: Any):
    review: Review = opened(viewport={"width": 1280, "height": 800})
    page, checked = review.page, Checked(review)
    review.get("ringlet.tools.brush.show(true)")
    checked.check("sculpting")
    review.get("ringlet.tools.brush.show(false)")
    page.get_by_role("button", name="Camera, light and sheet").click()
    checked.check("camera and light")
    page.keyboard.press("Escape")
    page.get_by_role("button", name="Looks and presets").click()
    checked.check("presets")
    page.keyboard.press("Escape")
    page.locator(".search").first.fill("width")
    checked.check("search")
    page.locator(".search").first.fill("")
    page.locator("main canvas").focus()
    for key, state in {"s": "", "t": "snapshots", "a": "a note"}.items():
        page.keyboard.press(key)
        if key == "s":
            review.until("document.querySelector('.card img')?.naturalWidth || ringlet.model.snapshots.length")
        if state:
            checked.check(state)
    page.keyboard.press("Escape")
    page.get_by_role("tab", name="References").click()
    checked.check("references")
    page.get_by_role("tab", name="Settings").click()
    assert checked.found == {}


def test_dialogs_and_compared_looks_are_accessible(opened: Any):
    review: Review = opened(viewport={"width": 1280, "height": 800})
    page, checked = review.page, Checked(review)
    page.keyboard.press("?")
    checked.check("help")
    page.keyboard.press("Escape")
    page.get_by_role("button", name="Save as…").click()
    checked.check("save as")
    page.keyboard.press("Escape")
    page.get_by_label("Compare looks").select_option("now")
    review.until("ringlet.viewer.compared")
    for arrangement in ("split", "wipe"):
        page.get_by_label("Arrangement of the looks").select_option(arrangement)
        checked.check(f"compared, {arrangement}")
    page.get_by_role("button", name="Changes").click()
    checked.check("changes")
    page.get_by_role("button", name="End", exact=True).click()
    page.get_by_label("Dark or light theme").click()
    checked.check("light theme")
    assert checked.found == {}


def test_a_shot_is_accessible(opened: Any):
    review: Review = opened("small.shot.toml", viewport={"width": 1280, "height": 800})
    checked = Checked(review)
    checked.check("shot")
    review.choose("shot:strands")
    checked.check("strands")
    assert checked.found == {}


def test_people_are_accessible(opened: Any, serve: Any):
    server = serve("small.recipe.toml")
    _, review = (opened(server, viewport={"width": 900, "height": 500}) for _ in range(2))
    checked = Checked(review)
    checked.check("a follower that is asked for a name")
    review.page.get_by_role("button", name="Stay a guest").click()
    review.page.get_by_role("button", name="2 people are here").click()
    checked.check("people")
    assert checked.found == {}


@pytest.mark.parametrize("width, height", [(390, 844), (820, 1180)])
def test_small_screens_are_accessible(opened: Any, width: int, height: int):
    review: Review = opened(viewport={"width": width, "height": height}, has_touch=True, is_mobile=True)
    checked = Checked(review)
    for sheet in ("Settings", "Stages", "View", "Picture") if width <= 720 else ("",):
        if sheet:
            review.page.get_by_role("navigation", name="Panels").get_by_role("button", name=sheet).click()
        checked.check(sheet)
    assert checked.found == {}
