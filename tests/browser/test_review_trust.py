"""Trust in the review page: gestures, numbers, problems, files and keys."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pytest
from review import Review, different


def number(review: Review, setting: str) -> Any:
    return review.page.locator(f'[data-setting="{setting}"] > .field-head input.number')


def test_a_slider_dragged_out_and_back_is_a_whole_groom_again(opened: Any):
    review: Review = opened()
    log = "window.said = []; const say = ringlet.model.say; ringlet.model.say = function (m) { said.push(m); "
    silent = "addEventListener('change', (event) => event.stopImmediatePropagation(), true);"
    review.page.evaluate(f"() => {{ {log} say.call(this, m); }}; {silent} }}")  # as where it ends as it began
    box = review.slider("curl.width").bounding_box()
    y, begin = box["y"] + box["height"] / 2, box["x"] + box["width"] / 3
    review.page.mouse.move(begin, y)
    review.page.mouse.down()
    for x in (begin + 60, begin):
        review.page.mouse.move(x, y, steps=3)
    review.until("said.length && said.every(message => message.kind != 'set' || !message.resting)")
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
    page.get_by_role("textbox", name="Name", exact=True).fill("wide")
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
    assert "Ctrl+Shift+Z" in page.get_by_role("dialog", name="Keyboard shortcuts").inner_text()
    shortcuts = page.get_by_role("region", name="Keyboard shortcuts")
    assert shortcuts.get_by_role("heading").all_inner_texts() == ["File", "View", "Groom", "Review", "Frames"]
    assert shortcuts.evaluate("(list) => list.scrollWidth <= list.clientWidth")
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
    page.get_by_role("button", name="Save and open").click()
    review.until("ringlet.model.welcome.name == 'other.recipe.toml' && ringlet.model.settled")
    assert review.get("ringlet.viewer.hair.a.locks.ids.length") == 9
    assert "width = 2" in (folder / "small.recipe.toml").read_text()
    page.get_by_role("button", name="Save as…").click()
    page.get_by_role("textbox", name="Name", exact=True).fill("third")
    page.get_by_role("dialog").get_by_role("button", name="Save", exact=True).click()
    review.until("ringlet.model.welcome.name == 'third.recipe.toml'")
    assert page.locator(".file-name").inner_text() == "third.recipe.toml"
    assert not review.errors


def test_points_of_a_ramp_stay_in_its_box_and_shapes_are_offered(opened: Any):
    review: Review = opened()
    review.page.locator('[data-setting="curl.width"] summary', has_text="along the hair").click()
    ramp = review.page.locator('[data-setting="curl.width.ramp"] svg.ramp')
    ramp.scroll_into_view_if_needed()
    box = ramp.bounding_box()
    review.page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
    review.page.mouse.down()
    review.page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] - 80, steps=3)
    assert 0 <= float(ramp.locator("circle").nth(1).get_attribute("cy")) <= 104
    review.page.mouse.up()
    for _ in range(2):
        review.answered()
        heights = [float(dot.get_attribute("cy")) for dot in ramp.locator("circle").all()]
        assert min(heights) >= 5 and max(heights) <= 99
    assert next(text for text in ramp.locator("text").all_text_contents() if text) == "0"
    review.page.get_by_label("ramp: shape of the curve").first.select_option("decreases to the tip")
    review.until("JSON.stringify(ringlet.model.documents.recipe.said.curl.width.ramp) == '[[0,1],[1,0]]'")


OVERLAPS = """() => {
    const panels = '.bar, .left > *, .settings, .tray, .viewbar, .status, .sheets, .problems';
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
    assert page.locator(".tray").is_visible() and not page.locator(".viewbar").is_visible()
    panels.get_by_role("button", name="Stages").click()
    assert page.locator(".stack").is_visible() and not page.locator(".tray").is_visible()
    page.get_by_role("button", name="Looks and presets…").click()
    page.keyboard.press("b")
    assert page.locator(".brush.sculpt").is_visible() and not page.locator(".presets, .stack").first.is_visible()
    page.keyboard.press("b")
    assert page.locator(".stack").is_visible()
    assert not review.errors


@pytest.mark.parametrize(("width", "height"), [(390, 844), (820, 1180), (1280, 800)])
def test_the_tray_leaves_the_picture_clear_and_its_targets_are_large_enough(opened: Any, width: int, height: int):
    review: Review = opened(viewport={"width": width, "height": height}, has_touch=True, is_mobile=True)
    page = review.page
    before = review.get("ringlet.viewer.clear")
    page.keyboard.press("a")  # writes a note in the tray
    review.laid_out()
    tray, clear = page.locator(".tray").bounding_box(), review.get("ringlet.viewer.clear")
    assert clear["y"] + clear["height"] <= tray["y"]
    assert page.evaluate(OVERLAPS) == [] and page.evaluate(SMALL) == [] and page.evaluate(SPILLED) == []
    tabs = page.get_by_role("tablist", name="Tray").bounding_box()
    closing = page.get_by_role("button", name="Close the tray").bounding_box()
    assert closing["y"] == pytest.approx(tabs["y"], abs=4)  # in the line of the tabs
    page.keyboard.press("Escape")
    page.get_by_role("button", name="Close the tray").click()
    review.laid_out()
    assert review.get("ringlet.viewer.clear") == before and not review.errors


def test_light_camera_and_bookmarks_are_remembered(opened: Any):
    review: Review = opened()
    page = review.page
    page.get_by_label("Light", exact=True).select_option(index=1)
    review.get("(ringlet.viewer.orbit(0.7, 0.1), ringlet.viewer.move())")
    page.locator("main canvas").focus()
    page.keyboard.press("Shift+Digit1")
    eye = review.get("ringlet.viewer.camera.position.toArray()")
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("1")
    assert review.get("ringlet.viewer.camera.position.toArray()") == pytest.approx(eye)
    review.settled()  # the look is remembered
    page.reload()
    review.until("window.ringlet?.viewer.hair.a.table && ringlet.model.settled")
    assert review.get("ringlet.viewer.camera.position.toArray()") == pytest.approx(eye)
    assert page.get_by_label("Light", exact=True).evaluate("e => e.selectedIndex") == 1


def test_locks_are_chosen_by_a_lasso_and_by_keys_and_the_edited_ones_are_listed(opened: Any):
    review: Review = opened()
    page = review.page
    page.keyboard.press("n")
    assert review.get("ringlet.lock.rows") == [0]
    box = page.locator("main canvas").bounding_box()
    page.keyboard.down("Shift")
    page.mouse.move(box["width"] / 2, 60)
    page.mouse.down()
    for x, y in ((0.75, 0.5), (0.5, 0.95), (0.25, 0.5), (0.5, 0.1)):
        page.mouse.move(box["width"] * x, box["height"] * y, steps=3)
    page.mouse.up()
    page.keyboard.up("Shift")
    chosen = review.get("ringlet.lock.rows.length")
    assert chosen > 1
    page.get_by_role("button", name="Isolate").click()
    review.until(f"ringlet.viewer.hair.a.locks.marked.reduce((sum, one) => sum + one, 0) == {chosen}")
    assert page.get_by_role("list", name="Edited locks").get_by_role("button").count() == chosen
    assert not review.errors


def test_two_looks_are_labelled_wiped_swapped_and_flipped(opened: Any):
    review: Review = opened(pixels=0.5)
    page = review.page
    number(review, "curl.width").fill("2")
    number(review, "curl.width").press("Enter")
    review.until("ringlet.model.documents.recipe.dirty")
    review.settled()
    now = review.picture()
    page.get_by_label("Compare with another look").select_option("saved")
    review.until("ringlet.viewer.compared && ringlet.viewer.hair.b.table")
    assert page.locator(".look-label b").all_inner_texts() == ["now", "as saved"]
    page.get_by_label("Arrangement of the looks").select_option("wipe")
    clear = review.get("ringlet.viewer.clear")
    wiped, middle = review.picture(), round(0.5 * (clear["x"] + clear["width"] / 2))
    assert different(wiped[:, :middle], now[:, :middle]) < 0.002 < different(wiped[:, middle:], now[:, middle:])
    page.get_by_label("Place of the wipe").focus()
    for _ in range(26):
        page.keyboard.press("ArrowRight")
    assert different(review.picture(), now) < 0.002  # all that is clear is left of the line
    page.get_by_role("button", name="Swap the two sides").click()
    assert different(review.picture()[:, :450], now[:, :450]) > 0.005
    page.get_by_label("Arrangement of the looks").select_option("flip")
    page.get_by_label("Arrangement of the looks").blur()
    assert different(review.picture(), now) < 0.002
    page.keyboard.press("Tab")
    assert different(review.picture(), now) > 0.005
    page.get_by_role("button", name="End", exact=True).click()
    review.until("!ringlet.viewer.compared")
    assert not review.errors


def test_messages_do_not_pile_up_and_the_diff_is_whole(opened: Any):
    review: Review = opened()
    show = "[0, 1, 2, 0, 1].forEach((k) => ringlet.notices.show(`message ${k}`))"
    assert review.get(f"({show}, document.querySelectorAll('.notice').length)") == 2
    long = "x" * 300
    review.get(f"ringlet.model.say({{ kind: 'set', changes: [[['name'], '{long}']], gesture: 1 }})")
    review.until("ringlet.model.documents.recipe.dirty")
    review.page.locator(".file-name").click()
    assert long in review.page.locator("ins.change").inner_text()


def test_the_focus_of_the_picture_is_seen_between_the_panels(opened: Any):
    review: Review = opened()
    review.page.keyboard.press("Tab")
    review.page.locator("main canvas").focus()
    style = "getComputedStyle(document.querySelector('.picture'), '::before')"
    left, right = (float(review.get(f"{style}.{side}").removesuffix("px")) for side in ("left", "right"))
    panel = review.get("document.querySelector('.left').getBoundingClientRect().right")
    settings = review.get("innerWidth - document.querySelector('.settings').getBoundingClientRect().left")
    assert left >= panel and right >= settings
    assert review.get("getComputedStyle(document.querySelector('canvas')).outlineStyle") == "none"


def test_an_operator_asks_for_the_curve_that_it_needs(opened: Any, folder: Path):
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text() + "[curves.wave]\npoints = [[0, 9, 0], [0, 14, 0]]\n")
    review: Review = opened()
    review.until("ringlet.model.names.curves.length")
    review.page.get_by_label("Add an operator").select_option("attract")
    dialog = review.page.get_by_role("dialog", name="Choose a curve for ‘attract’")
    dialog.get_by_role("combobox").select_option("wave")
    dialog.get_by_role("button", name="Add").click()
    review.until("ringlet.model.documents.recipe.said.shape?.[0].curve == 'wave' && ringlet.model.settled")


def test_numbers_of_a_shot_have_units(opened: Any):
    review: Review = opened("small.shot.toml")
    review.choose("shot:strands")
    assert review.page.locator(".settings h2").inner_text().lower() == "hair material"
    unit = review.page.locator('[data-setting="strands.youngs_modulus"] .unit').first
    assert unit.inner_text() == "GPa"
    number(review, "strands.youngs_modulus").fill("3")
    number(review, "strands.youngs_modulus").press("Enter")
    review.until("ringlet.model.documents.shot.said.strands?.youngs_modulus == 3e9")
    assert review.page.evaluate("() => ringlet.model.words('curl.width is 0.3 m; must be at most 0.2 m')") == (
        "curl.width is 30 cm; must be at most 20 cm"
    )
