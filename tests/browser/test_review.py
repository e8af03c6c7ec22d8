"""Editing on the review page."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from review import Review, different
from ringlet.groom.thinning import spread
from test_several_grooms import SEVERAL

from ringlet import build_groom, build_hairs
from ringlet.groom import lay_hairs

CURL = """
[hairs.families]
count = 3
noise = 0.1
[hairs.curl]
drift = 0.3
slips = 0.4
escape = 0.3
relax = 0.5
[hairs.coil]
width = 0.2
pitch = 6
kink = 0.4
"""


@pytest.mark.parametrize("curl", ["", CURL], ids=["as their lock", "with a curl of their own"])
def test_gpu_hairs_equal_those_of_the_core(opened: Any, folder: Path, curl: str):
    """The shader implements src/ringlet/groom/hairs.cpp."""
    recipe = folder / "small.recipe.toml"
    recipe.write_text(
        recipe.read_text().replace(
            "per_lock = 3", "per_lock = 7\nfrizz = 0.3\nroot_radius = 0.4\nblend = 0.6\nlock_taper = 0.4"
        )
        + curl
    )
    review: Review = opened(pixels=0.1)
    review.picture()
    hairs = build_hairs(build_groom(recipe))
    count, points = len(hairs.curves), int(hairs.curves.counts[0])
    read = review.get("Array.from(ringlet.viewer.hair.a.read(ringlet.viewer.renderer, 1e6))")
    drawn = np.array(read).reshape(count, points, 4)
    order = spread(np.diff(hairs.layout["first"]))
    expected = hairs.curves.points.reshape(count, points, 3)[order]
    assert np.abs(drawn[:, :, :3] - expected).max() < 2e-6
    widths = hairs.curves.point["width"].reshape(count, points)[order]
    assert np.allclose(drawn[:, :, 3], widths, rtol=1e-4)
    assert not review.errors


def test_hairs_know_where_in_the_tube_of_their_lock_they_are_and_how_dense_it_is(opened: Any, folder: Path):
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text().replace("per_lock = 3", 'per_lock = 300\nlock_radius = "4 mm"'))
    review: Review = opened(pixels=0.1)
    review.picture()
    groom = build_groom(recipe)
    hairs = build_hairs(groom)
    count, points = len(hairs.curves), int(hairs.curves.counts[0])
    read = review.get("""(() => {
        const { renderer, hair: { a: hair } } = ringlet.viewer, { width, height } = hair.carry.target;
        hair.read(renderer, 1e6);
        const values = new Uint8Array(4 * width * height);
        renderer.readRenderTargetPixels(hair.carry.target, 0, 0, width, height, values, undefined, 1);
        return Array.from(values);
    })()""")
    tubes = np.array(read)[: 4 * count * points].reshape(count, points, 4) / 255.0
    order = spread(np.diff(hairs.layout["first"]))
    middle = points // 2  # there hairs are no more held to the skin
    places = hairs.curves.points.reshape(8, -1, points, 3)[:, :, middle]
    locks = groom.locks.points.reshape(8, -1, 3)
    away = np.linalg.norm(places[:, :, None] - locks[:, None], axis=3).min(axis=2).ravel()[order]
    widths = hairs.curves.point["width"].reshape(count, points)[order, middle]
    radius = np.sqrt(2.0 * (away**2).mean())
    tube = tubes[:, middle]
    off = np.linalg.norm(2.0 * tube[:, :3] - 1.0, axis=1) - np.minimum(away / radius, 1.0)
    assert np.percentile(np.abs(off), 90) < 0.1  # others are nearer to another turn of the coil
    depth = (tube[:, 3] / (1.0 - tube[:, 3])).mean()
    assert depth == pytest.approx(300 * widths.mean() / (np.pi * radius), rel=0.06)
    assert not review.errors


@pytest.mark.parametrize("curl", ["", CURL], ids=["as their lock", "with a curl of their own"])
def test_gpu_hairs_of_several_grooms_equal_those_of_the_core(opened: Any, folder: Path, curl: str):
    """Grooms differ in what is the same along the hairs of each."""
    recipe = folder / "several.recipe.toml"
    recipe.write_text(SEVERAL)
    small = folder / "small.recipe.toml"
    small.write_text(small.read_text().replace("per_lock = 3", "per_lock = 7\nfrizz = 0.3\nroot_radius = 0.4") + curl)
    review: Review = opened("several.recipe.toml", pixels=0.1)
    review.picture()
    groom = build_groom(recipe)
    hairs = lay_hairs(groom)
    points = hairs.deformed(groom.locks.points, groom.scalp.points).reshape(len(hairs.curves), -1, 3)
    lock = hairs.curves.curve["lock"]
    order = spread(np.bincount(lock))
    read = review.get("Array.from(ringlet.viewer.hair.a.read(ringlet.viewer.renderer, 1e6))")
    drawn = np.array(read).reshape(*points.shape[:2], 4)
    assert np.abs(drawn[:, :, :3] - points[order]).max() < 2e-6
    width = hairs.curves.point["width"].reshape(points.shape[:2])[order]
    assert np.allclose(drawn[:, :, 3], width, rtol=1e-4)
    assert not review.errors


def test_the_list_above_the_stages_chooses_the_groom_that_is_changed(opened: Any, folder: Path):
    (folder / "several.recipe.toml").write_text(SEVERAL)
    review: Review = opened("several.recipe.toml")
    before = review.locks()
    review.page.get_by_label("Groom", exact=True).select_option("brows")
    review.until("ringlet.model.documents.recipe.groom === 'brows'")
    review.choose("guides")
    review.drag(review.slider("guides.length"), 0.1, 0.5, 0.8)
    review.until("ringlet.model.documents.recipe.dirty")
    changed = tomllib.loads(review.text())["grooms"]
    assert changed["brows"]["guides"]["length"] > 2 and "guides" not in changed["hair"]
    review.settled()
    moved = np.linalg.norm(review.locks() - before, axis=1)
    assert moved.max() > 0.002 and (moved == 0).any() and not review.errors


def test_a_slider_changes_picture_and_recipe_and_undo_reverts_both(opened: Any):
    review: Review = opened(pixels=0.25)
    before, text = review.picture(), review.text()
    review.drag(review.slider("curl.width"), 0.35, 0.6, 0.9)
    review.until("ringlet.model.documents.recipe.dirty")
    assert tomllib.loads(review.text())["curl"]["width"] > 1.5
    review.settled()
    assert different(review.picture(), before) > 0.005
    review.page.keyboard.press("Control+z")
    review.until("!ringlet.model.documents.recipe.dirty")
    assert review.text() == text
    review.settled()
    assert different(review.picture(), before) < 0.002
    assert not review.errors


def test_saving_writes_the_file_and_a_new_page_shows_it(opened: Any, folder: Path, serve: Any):
    server = serve("small.recipe.toml")
    review: Review = opened(server)
    field = review.page.locator('[data-setting="curl.pitch"] > .field-head input.number')
    field.fill("2.25")
    field.press("Enter")
    review.until("ringlet.model.documents.recipe.dirty")
    review.page.get_by_role("button", name="Save", exact=True).click()
    review.until("!ringlet.model.documents.recipe.dirty")
    text = (folder / "small.recipe.toml").read_text()
    assert "pitch = 2.25" in text and text.count("\n") == review.text().count("\n")
    review.page.reload()
    review.until("window.ringlet?.model.documents.recipe?.said.curl.pitch == 2.25")


def test_guides_are_sculpted_with_a_brush(opened: Any):
    review: Review = opened()
    page = review.page
    page.get_by_role("button", name="Sculpt guides").click()
    page.get_by_role("switch", name="both sides").check()
    before = np.array(review.get("Array.from(ringlet.model.guides.points)")).reshape(-1, 3)
    offsets = review.get("Array.from(ringlet.model.guides.offsets)")
    front = int(np.argmax(before[np.array(offsets[1:]) - 1] @ review.get("ringlet.viewer.camera.position.toArray()")))
    at = review.project(before[offsets[front + 1] - 1])
    page.mouse.move(*at)
    page.mouse.down()
    page.mouse.move(at[0] + 50, at[1] - 20, steps=4)
    page.mouse.up()
    review.until("ringlet.model.documents.recipe.edits.includes('[[sculpt]]')")
    review.settled()
    after = np.array(review.get("Array.from(ringlet.model.guides.points)")).reshape(-1, 3)
    assert np.linalg.norm(after - before, axis=1)[offsets[front + 1] - 1] > 0.003
    assert np.array_equal(after[offsets[:-1]], before[offsets[:-1]])  # roots stay
    eye = review.get("ringlet.viewer.camera.position.toArray()")
    clear = review.get("ringlet.viewer.clear")
    x, y = clear["x"] + 10, clear["y"] + 10
    page.mouse.move(x, y)
    page.mouse.down()  # a stroke beside the hair does nothing
    page.mouse.move(x + 40, y, steps=2)
    page.mouse.up()
    assert review.get("ringlet.viewer.camera.position.toArray()") == eye
    page.mouse.down(button="right")  # the right button turns the head
    page.mouse.move(x + 80, y, steps=2)
    page.mouse.up(button="right")
    assert review.get("ringlet.viewer.camera.position.toArray()") != eye
    page.keyboard.press("Control+z")
    review.until("!ringlet.model.documents.recipe.dirty && !ringlet.model.guides.changed.some(one => one)")
    page.keyboard.press("Control+Shift+z")
    review.until("ringlet.model.guides.changed.some(one => one)")
    page.get_by_role("button", name="Reset all").click()
    review.until("!ringlet.model.guides.changed.some(one => one)")
    assert not review.errors


def test_the_plane_of_symmetry_is_seen_while_a_brush_works_on_both_sides(opened: Any):
    review: Review = opened(viewport={"width": 800, "height": 500}, pixels=1)
    review.page.get_by_role("button", name="Sculpt guides").click()
    review.until("ringlet.viewer.guides.shown")
    both = review.page.get_by_role("switch", name="both sides")
    review.get("(ringlet.viewer.showHair(false), ringlet.viewer.frame(60, 10))")  # from one side
    pictures = []
    for on in (False, True, False):
        both.set_checked(on)
        assert review.get("ringlet.viewer.guides.plane.visible") == on
        pictures.append(review.picture())
    without, shown, again = pictures
    # The corners stand out from the groom: four lines of over 100 pixels, of which the head covers none
    blue = (shown[:, :, 2] > shown[:, :, 0] + 60) & (np.abs(shown - without).max(axis=2) > 40)
    assert blue.sum() > 100
    assert different(without, again) == 0
    both.check()
    review.page.keyboard.press("b")  # the brush is put away, and the plane with it
    assert not review.get("ringlet.viewer.guides.plane.visible")


def test_regions_and_overlays_are_chosen_from_lists(opened: Any, folder: Path):
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text() + '[[pin]]\nlength = "2 cm"\n[[shape]]\nop = "scraggle"\n')
    review: Review = opened(pixels=0.25)
    review.choose("shape/0")
    review.show_all_settings()
    review.unfold("shape.0.mask")
    review.page.locator('[data-setting="shape.0.mask"] summary', has_text="varies").click()
    review.page.locator('[data-setting="shape.0.mask.region"] select').select_option("scalp")
    review.until("ringlet.model.documents.recipe.said.shape[0].mask?.region === 'scalp'")
    review.settled()
    plain = review.clear_picture()
    review.until("ringlet.model.measured?.pin.length")
    review.page.get_by_label("Overlay").select_option("pin")
    assert review.page.get_by_role("note").inner_text().split() == ["free", "held"]
    assert different(review.clear_picture(), plain) > 0.002  # few hairs cover few pixels
    assert not review.errors


def test_two_looks_are_shown_side_by_side(opened: Any):
    review: Review = opened(pixels=(ratio := 0.25))
    other = review.page.get_by_label("Compare looks")
    other.select_option("now")
    review.until("ringlet.viewer.compared && ringlet.viewer.hair.b.table")
    picture = review.picture()
    clear = review.get("ringlet.viewer.clear")
    assert clear["x"] > 200 and 1000 - clear["x"] - clear["width"] > 200 and clear["width"] > 280
    begin, middle, end = (int(ratio * (clear["x"] + part * clear["width"])) for part in (0, 0.5, 1))
    alpha = "ringlet.viewer.film.transparent(ringlet.viewer.renderer).data.filter((_, k) => k % 4 == 3)"
    seen = (np.array(review.get(f"Array.from({alpha})")).reshape(picture.shape[:2]) > 8).any(axis=0)
    for left, right in ((begin, middle), (middle, end)):
        head = left + np.flatnonzero(seen[left:right])
        assert abs((head[0] + head[-1]) / 2 - (left + right) / 2) < 10 * ratio
    review.drag(review.slider("curl.width"), 0.35, 0.95)
    review.until("ringlet.model.documents.recipe.dirty")
    review.settled()
    picture = review.picture()
    size = min(middle - begin, end - middle)
    assert different(picture[:, begin : begin + size], picture[:, middle : middle + size]) > 0.005
    review.page.get_by_role("button", name="End", exact=True).click()
    review.until("!ringlet.viewer.compared")


def test_colour_is_edited_and_shown(opened: Any):
    review: Review = opened(pixels=0.25)
    before = review.picture()
    review.choose("color")
    review.drag(review.slider("color.melanin"), 0.9, 0.4, 0.02)
    review.until("ringlet.model.documents.recipe.dirty")
    assert tomllib.loads(review.text())["color"]["melanin"] < 0.2
    review.settled()
    light = review.picture()
    assert different(light, before) > 0.001
    assert light.sum() > before.sum()
    review.show_all_settings()
    review.unfold("color.dye")
    dye = review.page.locator('[data-setting="color.dye"] details.table')
    dye.evaluate("(details) => { details.open = true; }")
    review.page.locator('[data-setting="color.dye.color"] input').fill("#1020ff")
    review.answered()
    review.settled()
    red, _, blue = np.moveaxis(review.picture() - light, 2, 0)
    assert tomllib.loads(review.text())["color"]["dye"]["color"] == "#1020ff"
    assert red.sum() < blue.sum()
    review.page.locator('select[aria-label="Hair color"]').select_option("dark_brown")
    assert different(review.picture(), before) < 0.002
    assert not review.errors
