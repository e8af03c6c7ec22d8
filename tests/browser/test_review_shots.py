"""Shots, caches and cloth on the review page."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
from review import Review, different
from ringlet.groom.thinning import spread
from wear import SCARF, write_roofed, write_wear

import ringlet
from ringlet import build_hairs


def test_gpu_hairs_stay_below_a_cloth_like_those_of_the_core(opened: Any, folder: Path):
    top = write_roofed(folder)
    review: Review = opened("cache.usdc", pixels=0.1)
    review.until("ringlet.timeline.count == 1 && ringlet.timeline.settled")
    review.picture()
    hairs = build_hairs(ringlet.read_groom(folder / "groom.usdc"))
    count, number = len(hairs.curves), int(hairs.curves.counts[0])
    read = review.get("Array.from(ringlet.viewer.hair.a.read(ringlet.viewer.renderer, 1e6))")
    drawn = np.array(read).reshape(count, number, 4)[:, :, :3]
    order = spread(np.diff(hairs.layout["first"]))
    kept = ringlet.io.read_hairs(folder / "hair.usdc", 1.0).points.reshape(count, number, 3)[order]
    assert hairs.curves.points[:, 1].max() > top + 1e-3
    assert drawn[..., 1].max() < top
    assert np.abs(drawn - kept).max() < 1e-4  # weights are quantised to 255 steps
    assert not review.errors


def test_ten_frames_are_simulated_and_scrubbed(opened: Any, folder: Path):
    shot = folder / "small.shot.toml"
    shot.write_text(shot.read_text().replace("frames = [1, 4]", "frames = [1, 10]"))
    review: Review = opened("small.shot.toml")
    review.page.get_by_role("button", name="Run", exact=True).click()
    review.until("ringlet.timeline.count == 10 && ringlet.model.timeline.state == 'done'")
    review.get("ringlet.timeline.show(1)")
    review.until("ringlet.timeline.settled")
    first = review.locks()
    review.drag(review.page.get_by_label("Frame", exact=True), 0.02, 0.98)
    review.until("ringlet.timeline.frame == 10 && ringlet.timeline.settled")
    assert np.linalg.norm(review.locks() - first, axis=1).max() > 0.01
    review.choose("shot:strands")
    field = review.page.locator('[data-setting="strands.bend_scale"] > .field-head input.number')
    field.fill("20")
    field.press("Enter")
    review.until("ringlet.model.documents.shot.dirty")
    review.get("ringlet.timeline.show(5)")
    review.page.get_by_label("Run again from this frame", exact=False).click()
    review.until("ringlet.model.timeline.key == 3 || ringlet.model.timeline.state == 'done'")
    review.until("ringlet.timeline.count == 10 && ringlet.model.timeline.state == 'done'")
    assert not review.errors


def test_a_changed_cloth_material_is_simulated(opened: Any, folder: Path):
    write_wear(folder)
    shot = folder / "small.shot.toml"
    shot.write_text(shot.read_text() + SCARF + "[[collider]]\n")
    review: Review = opened(shot.name)
    assert review.page.locator('[data-stage="shot:collider/0"]').inner_text() == "collider"
    review.choose("shot:cloth/0")
    review.page.locator('[data-setting="cloth.0.material"] summary').first.click()
    moved = []
    for density in (0.15, 1.5):
        field = review.page.locator('[data-setting="cloth.0.material.density"] > .field-head input.number')
        field.fill(str(density))
        field.press("Enter")
        review.until(f"ringlet.model.documents.shot.values.cloth[0].material.density == {density}")
        before = review.get("ringlet.model.timeline.key")
        review.page.get_by_role("button", name=re.compile("^Run( again)?$")).click()
        review.until(f"ringlet.model.timeline.key != {before} && ringlet.model.timeline.state == 'done'")
        review.get("ringlet.timeline.show(4)")
        review.until("ringlet.timeline.settled")
        moved.append(np.array(review.get("Array.from(ringlet.timeline.known('shot').bodies)")))
    assert np.abs(moved[1] - moved[0]).max() > 1e-5
    assert tomllib.loads(review.text("shot"))["cloth"][0]["material"]["density"] == 1.5

    groom = ringlet.build_groom(folder / "small.recipe.toml")
    ringlet.write_groom(groom, folder / "groom.usda")
    cache = ringlet.simulate(shot, groom)
    ringlet.write_cache(cache, folder / "groom.usda", folder / "cache.usda")
    review.page.get_by_label("Compare runs and caches").select_option("cache.usda")
    review.until("ringlet.viewer.compared && ringlet.model.timeline.against == 'cache.usda'")
    review.get("ringlet.timeline.show(4)")
    review.until("ringlet.timeline.settled && ringlet.timeline.drawn.against")

    def scarf(side: str) -> np.ndarray:
        at = f"ringlet.viewer.stage.bodies.get(1).geometry('{side}').getAttribute('position').array"
        return np.array(review.get(f"Array.from({at})")).reshape(-1, 3)

    assert np.abs(scarf("b") - cache.cloths[0].points[3]).max() < 1e-6  # each side shows its own cloth
    assert np.array_equal(scarf("a").ravel(), moved[1][-scarf("a").size :])
    review.choose("curl")
    field = review.page.locator('[data-setting="curl.width"] > .field-head input.number')
    field.fill("1.2")
    field.press("Enter")
    review.until("ringlet.model.settled && !ringlet.timeline.drawn.shot")
    rest = review.get("Array.from(ringlet.viewer.stage.bodies.get(1).rest)")
    review.until("!ringlet.timeline.count")
    assert np.array_equal(scarf("a").ravel(), rest)  # cloth at rest, like the hair
    assert not review.errors


def test_a_shot_is_compared_with_a_cache_and_overlays(opened: Any, folder: Path):
    groom = ringlet.build_groom(folder / "small.recipe.toml")
    ringlet.write_groom(groom, folder / "groom.usda")
    cache = ringlet.simulate(folder / "small.shot.toml", groom)
    review: Review = opened("small.shot.toml", pixels=0.25)
    field = "strands.bend_scale"
    review.choose("shot:strands")
    review.page.locator(f'[data-setting="{field}"] > .field-head input.number').fill("0.02")
    review.page.locator(f'[data-setting="{field}"] > .field-head input.number').press("Enter")
    review.until("ringlet.model.documents.shot.dirty")
    review.page.get_by_role("button", name="Run", exact=True).click()
    review.until("ringlet.timeline.count == 4 && ringlet.model.timeline.state == 'done'")
    review.get("ringlet.timeline.show(4)")
    review.until("ringlet.timeline.settled")
    plain = review.clear_picture()
    for overlay in ("stretch", "curl"):
        review.page.get_by_label("Overlay").select_option(overlay)
        assert different(review.clear_picture(), plain) > 0.002  # few hairs cover few pixels
    assert review.page.locator('[data-number="inside"]').is_visible()
    ringlet.write_cache(cache, folder / "groom.usda", folder / "cache.usda")  # the open page is notified
    review.page.get_by_label("Compare runs and caches").select_option("cache.usda")
    review.until("ringlet.viewer.compared && ringlet.model.timeline.against == 'cache.usda'")
    review.until("ringlet.viewer.hair.b.table")
    review.page.get_by_label("Overlay").select_option("")
    review.get("ringlet.timeline.show(4)")
    review.until("ringlet.timeline.settled")
    review.page.get_by_role("button", name="Chart of the swing, and earlier runs").click()
    assert "cache.usda has no speeds" in review.page.locator(".swing-legend").inner_text()
    review.page.get_by_role("button", name="Chart of the swing, and earlier runs").click()
    left, right = np.split(review.clear_picture(), 2, axis=1)
    assert different(left, right) > 0.002
    assert not review.errors


def test_an_earlier_run_is_compared_by_wipe_and_the_chart_shows_its_swing(opened: Any):
    review: Review = opened("small.shot.toml", pixels=0.25)
    page = review.page

    def run() -> None:
        key = review.get("ringlet.model.timeline.key")
        page.get_by_role("button", name=re.compile("^Run( again)?$")).click()
        review.until(f"ringlet.model.timeline.key != {key} && ringlet.model.timeline.state == 'done'")

    review.until("ringlet.model.timeline")
    run()
    change = "{ kind: 'set', file: 'shot', changes: [[['strands', 'bend_scale'], 0.001]], gesture: 1 }"
    review.get(f"ringlet.model.say({change})")
    review.until("ringlet.model.timeline.stale.every((one) => one)")
    assert page.locator(".runs .stale").count() == 1
    run()
    assert page.locator(".runs span").count() == 1 and page.locator(".runs .stale").count() == 0
    page.get_by_role("button", name="Chart of the swing, and earlier runs").click()
    review.get("ringlet.timeline.goTo(4)")
    review.until("ringlet.timeline.settled")
    now = review.clear_picture()
    room = review.get("ringlet.viewer.clear")
    page.get_by_label("Compare runs and caches").select_option("run 1")
    review.until("ringlet.viewer.compared && ringlet.model.timeline.against == 'run 1'")
    page.get_by_label("Arrangement of the looks").select_option("wipe")
    review.get("ringlet.timeline.goTo(4)")
    review.until("ringlet.timeline.settled && ringlet.timeline.drawn.against")
    wiped = review.clear_picture()
    assert review.get("ringlet.viewer.clear") == room  # the chart has the same room before and after its answers
    middle = wiped.shape[1] // 2
    assert different(wiped[:, : middle - 2], now[:, : middle - 2]) < different(wiped[:, middle:], now[:, middle:])
    assert page.get_by_role("button", name="Changes (1)").is_visible()
    chart = page.locator(".swing-plot svg")
    assert chart.is_visible() and "Mean speed in each frame: tips up to" in chart.get_attribute("aria-label")
    assert chart.locator("polyline.tips").count() == 2 and chart.locator("polyline.roots").count() == 1
    assert "tips of run 1" in page.locator(".swing-legend").inner_text()
    box = chart.bounding_box()
    page.mouse.click(box["x"] + 2, box["y"] + 20)
    assert review.get("ringlet.timeline.current") == 1
    page.get_by_role("button", name="Use its settings").click()
    review.until("ringlet.model.said('shot', ['strands', 'bend_scale']) === undefined")
    page.locator(".take", has_text="run 1").click()
    review.until("!ringlet.viewer.compared")
    assert not review.errors


def test_words_of_motion_are_dragged_undone_saved_and_refused_beside_one_another(opened: Any, folder: Path):
    shot = folder / "small.shot.toml"
    shot.write_text(shot.read_text() + "[solver]\nintegrator = 'bdf2'\nsubsteps = 4\n[motion]\nbounce = 6\n")
    review: Review = opened(shot.name, viewport={"width": 1280, "height": 900})
    review.choose("shot:motion")
    review.show_all_settings()
    names = review.page.locator(".settings > .fields > .field").evaluate_all(
        "all => all.map(one => one.dataset.setting)"
    )
    assert [name.removeprefix("motion.") for name in names] == list(
        ringlet.schema()["shot"]["$defs"]["WantedMotion"]["properties"]
    )
    review.drag(review.slider("motion.bounce"), 0.3, 0.5)
    review.until("ringlet.model.documents.shot.dirty")
    dragged = tomllib.loads(review.text("shot"))["motion"]["bounce"]
    assert dragged != 6
    review.get("ringlet.lock.choose(0)")
    review.page.get_by_text(f"bounce {dragged:.3g} Hz, settles").wait_for()
    said = review.page.get_by_label("Motion of this lock").inner_text()
    assert re.fullmatch(r"bounce .* Hz, settles in .* s, swing .* Hz, sag .* %, .* times as stiff as hair", said)
    review.page.locator("main canvas").press("Control+z")
    review.until("ringlet.model.documents.shot.text.includes('bounce = 6')")
    review.unfold("motion.bounce")
    review.page.locator('[data-setting="motion.bounce"] .varies summary').click()
    review.page.locator('[data-setting="motion.bounce.of_hair"] input').click()
    review.until("ringlet.model.documents.shot.text.includes('of_hair = true')")
    field = review.page.locator('[data-setting="motion.sag"] > .field-head input.number')
    field.fill("0.1")
    field.press("Enter")
    review.page.get_by_text("motion.sag is 0.1, but bounce is 6").wait_for()
    assert field.input_value() == "" and "sag" not in review.text("shot")
    review.page.get_by_role("button", name="Save", exact=True).click()
    review.until("!ringlet.model.documents.shot.dirty")
    assert tomllib.loads(shot.read_text())["motion"]["bounce"] == {"value": 6, "of_hair": True}
    assert not review.errors
