"""Trust in the review page: gestures, numbers, problems, files and keys."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from review import Review, different


def number(review: Review, setting: str) -> Any:
    return review.page.locator(f'[data-setting="{setting}"] > .field-head input.number')


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


OVERLAPS = """() => {
    const panels = '.bar, .left > *, .dock, .viewbar, .timeline, .sheets, .problems';
    const parts = [...document.querySelectorAll(panels)]
        .filter((e) => e.checkVisibility() && e.getBoundingClientRect().height > 0)
        .map((e) => {
            const box = e.getBoundingClientRect(), clip = e.closest('.left')?.getBoundingClientRect() ?? box;
            const top = Math.max(box.top, clip.top), bottom = Math.min(box.bottom, clip.bottom); // as it is scrolled
            return [e.className, { left: box.left, right: box.right, top, bottom }];
        });
    return parts.flatMap(([a, p], k) => parts.slice(k + 1)
        .filter(([, q]) => Math.min(p.right, q.right) - Math.max(p.left, q.left) > 1
            && Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top) > 1)
        .map(([b]) => `${a} / ${b}`));
}"""

SMALL = """() => [...document.querySelectorAll('button, input, select, summary')]
    .filter((e) => e.checkVisibility() && !e.closest('.ramp, .choice'))
    .map((e) => [e, e.getBoundingClientRect()]).filter(([, box]) => box.width && Math.min(box.width, box.height) < 24)
    .map(([e]) => e.outerHTML.slice(0, 100))"""


# What stands in the bar or in the row of a stage, and is not all in it or is on something else of it.
SPILLED = """() => [...document.querySelectorAll('.bar, .stage')].flatMap((row) => {
    const outer = row.getBoundingClientRect();
    const seen = [...row.querySelectorAll('button, select')].filter((e) => e.checkVisibility());
    const boxes = seen.map((e) => [e, e.getBoundingClientRect()]);
    return boxes.filter(([e, box]) => box.top < outer.top - 1 || box.bottom > outer.bottom + 1
        || boxes.some(([other, it]) => other !== e && it.left < box.right - 1 && it.right > box.left + 1
            && it.top < box.bottom - 1 && it.bottom > box.top + 1))
        .map(([e]) => e.outerHTML.slice(0, 100)); })"""


@pytest.mark.parametrize("width, height", [(390, 844), (844, 390), (820, 1180), (1280, 800)])
def test_panels_do_not_overlap_and_targets_are_large_enough(opened: Any, width: int, height: int):
    review: Review = opened(viewport={"width": width, "height": height}, has_touch=True, is_mobile=width != 1280)
    for sheet in ("Settings", "Stages", "View", "Picture") if width <= 720 or height <= 480 else ("",):
        if sheet:
            review.page.get_by_role("navigation", name="Panels").get_by_role("button", name=sheet).click()
            review.laid_out()
        assert review.page.evaluate(OVERLAPS) == []
        assert review.page.evaluate(SMALL) == []
        assert review.page.evaluate(SPILLED) == []
        assert review.get("document.documentElement.scrollWidth") <= width


def test_one_thing_at_a_time_is_open_on_a_small_screen(opened: Any):
    review: Review = opened(viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True)
    page = review.page
    panels = page.get_by_role("navigation", name="Panels")
    panels.get_by_role("button", name="View").click()
    page.get_by_role("button", name="Snapshots, notes and references (T)").click()
    assert page.locator(".dock").is_visible() and not page.locator(".viewbar").is_visible()
    panels.get_by_role("button", name="Stages").click()
    assert page.locator(".stack").is_visible() and not page.locator(".dock").is_visible()
    page.get_by_role("button", name="Looks and presets…").click()
    page.keyboard.press("b")
    assert page.locator(".brush.sculpt").is_visible() and not page.locator(".presets, .stack").first.is_visible()
    page.keyboard.press("b")
    assert page.locator(".stack").is_visible()
    assert not review.errors


SHARE = """() => {
    const at = (size) => Array.from({ length: size / 8 }, (_, k) => 8 * k + 4);
    const places = at(innerHeight).flatMap((y) => at(innerWidth).map((x) => document.elementFromPoint(x, y)));
    return places.filter((element) => element?.closest('.picture')).length / places.length;
}"""


def test_chart_and_notes_leave_most_of_the_window_to_the_picture(opened: Any):
    review: Review = opened("small.shot.toml", viewport={"width": 1280, "height": 800})
    page = review.page
    for tab in ("Chart", "Snapshots", "Notes", "References"):
        page.get_by_role("tab", name=tab).click()
        review.laid_out()
        clear = review.get("ringlet.viewer.clear")
        assert page.evaluate(SHARE) > 0.6 and clear["width"] * clear["height"] > 0.6 * 1280 * 800
        assert page.evaluate(OVERLAPS) == []
    assert not review.errors


def test_a_phone_that_follows_reads_settings_and_sees_the_picture(opened: Any, serve: Any):
    server = serve("small.shot.toml")
    opened(server)
    review: Review = opened(server, viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True)
    page = review.page
    page.get_by_role("button", name="Stay a guest").click()
    review.laid_out()
    assert page.evaluate(SHARE) > 0.5
    panels = page.get_by_role("navigation", name="Panels")
    panels.get_by_role("button", name="Stages", exact=True).click()
    review.laid_out()
    assert page.evaluate(SHARE) > 0.3 and review.get("ringlet.viewer.clear.height") > 0.25 * 844
    panels.get_by_role("button", name="Settings", exact=True).click()
    page.locator(".search").first.fill("curlier")
    page.locator("#found-0").click()
    setting = page.locator('[data-setting="curl.pitch"]')
    assert setting.is_visible() and setting.locator("input").first.is_disabled()
    assert not review.errors


@pytest.mark.parametrize(("width", "height"), [(390, 844), (820, 1180), (1280, 800)])
def test_the_dock_leaves_the_picture_clear_and_its_targets_are_large_enough(opened: Any, width: int, height: int):
    review: Review = opened(viewport={"width": width, "height": height}, has_touch=True, is_mobile=True)
    page = review.page
    before = review.get("ringlet.viewer.clear")
    page.keyboard.press("a")  # writes a note
    review.laid_out()
    assert page.evaluate(OVERLAPS) == [] and page.evaluate(SMALL) == [] and page.evaluate(SPILLED) == []
    page.keyboard.press("Escape")
    page.keyboard.press("t")
    if width == 390:
        page.get_by_role("navigation", name="Panels").get_by_role("button", name="Picture").click()
    review.laid_out()
    assert review.get("ringlet.viewer.clear") == before and not review.errors


def test_two_looks_are_labelled_wiped_swapped_and_flipped(opened: Any):
    review: Review = opened(pixels=(ratio := 0.25))
    page = review.page
    number(review, "curl.width").fill("2")
    number(review, "curl.width").press("Enter")
    review.until("ringlet.model.documents.recipe.dirty")
    review.settled()
    now = review.picture()
    page.get_by_label("Compare looks").select_option("saved")
    review.until("ringlet.viewer.compared && ringlet.viewer.hair.b.table")
    assert page.locator(".look-label b").all_inner_texts() == ["now", "as saved"]
    page.get_by_label("Arrangement of the looks").select_option("wipe")
    clear = review.get("ringlet.viewer.clear")
    wiped, middle = review.picture(), round(ratio * (clear["x"] + clear["width"] / 2))
    assert different(wiped[:, :middle], now[:, :middle]) < 0.002 < different(wiped[:, middle:], now[:, middle:])
    page.get_by_label("Place of the wipe").focus()
    for _ in range(26):
        page.keyboard.press("ArrowRight")
    assert different(review.picture(), now) < 0.002  # all that is clear is left of the line
    page.get_by_role("button", name="Swap the two sides").click()
    left = slice(round(900 * ratio))
    assert different(review.picture()[:, left], now[:, left]) > 0.005
    page.get_by_label("Arrangement of the looks").select_option("flip")
    page.get_by_label("Arrangement of the looks").blur()
    assert different(review.picture(), now) < 0.002
    page.keyboard.press("Tab")
    assert different(review.picture(), now) > 0.005
    page.get_by_role("button", name="End", exact=True).click()
    review.until("!ringlet.viewer.compared")
    assert not review.errors


def test_the_focus_of_the_picture_is_seen_between_the_panels(opened: Any):
    review: Review = opened()
    review.page.keyboard.press("Tab")
    review.page.locator("main canvas").focus()
    style = "getComputedStyle(document.querySelector('.picture'), '::before')"
    left, right = (float(review.get(f"{style}.{side}").removesuffix("px")) for side in ("left", "right"))
    panel = review.get("document.querySelector('.left').getBoundingClientRect().right")
    settings = review.get("innerWidth - document.querySelector('.dock').getBoundingClientRect().left")
    assert left >= panel and right >= settings
    assert review.get("getComputedStyle(document.querySelector('canvas')).outlineStyle") == "none"
