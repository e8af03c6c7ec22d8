"""Takes and comparisons of live hair on the review page, with the real server."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from review import Review


def kept(review: Review) -> None:
    """Lets hair move live, nods, and keeps a take."""
    review.page.keyboard.press("l")
    review.until("ringlet.live.step")
    review.page.get_by_role("button", name="Nod", exact=True).click()
    review.until("ringlet.live.step.head[6] < -0.2")
    review.page.keyboard.press("k")
    review.until("ringlet.model.snapshots.length")


def test_a_take_is_kept_and_plays_and_becomes_a_shot_that_is_compared_by_a_wipe(opened: Any, folder: Path) -> None:
    review: Review = opened(pixels=0.1)
    kept(review)
    review.page.keyboard.press("t")
    review.page.get_by_role("button", name="Play the take").click()
    review.until("ringlet.viewer.hair.b.motions && ringlet.viewer.looks.arrangement === 'flip'")
    seen = review.get("Array.from(ringlet.viewer.hair.b.motions)")
    review.until(f"ringlet.viewer.hair.b.motions.some((x, i) => Math.abs(x - {seen}[i]) > 1e-3)")
    review.page.get_by_role("button", name="End", exact=True).click()
    review.until("!ringlet.viewer.hair.b.motions")
    review.page.get_by_role("button", name="Make a shot of the take").click()
    review.page.get_by_label("Name of the shot").fill("nodding")
    review.page.get_by_role("button", name="Make the shot").click()
    review.until("ringlet.model.welcome.name === 'nodding.shot.toml' && ringlet.model.timeline?.frames.length > 2")
    review.until("ringlet.viewer.hair.b.motions && ringlet.viewer.looks.arrangement === 'wipe'")
    review.get("ringlet.timeline.goTo(3)")
    review.until("ringlet.timeline.settled")
    points = "Array.from(ringlet.viewer.stage.bodies.get(0).surface('{}').points)"
    shown, taken = (points.format(side) for side in "ab")  # a step of the take comes on its own, after the frame
    review.until(f"((taken) => {shown}.every((x, i) => Math.abs(x - taken[i]) < 1e-4))({taken})")  # the same head
    assert (folder / "nodding.head.usdc").exists()
    assert not review.errors


def test_two_materials_move_with_the_same_head(opened: Any) -> None:
    review: Review = opened("small.shot.toml", pixels=0.1)
    review.page.keyboard.press("l")
    review.until("ringlet.live.step")
    review.get("ringlet.model.say({ kind: 'compare', to: 'now', name: '', side: 'b' })")
    review.until("ringlet.viewer.hair.b.motions")
    review.get(
        "ringlet.model.say({ kind: 'set', file: 'shot', changes: [[['strands', 'bend_scale'], 40]], gesture: 99 })"
    )
    review.page.get_by_role("button", name="Turn", exact=True).click()
    far = "ringlet.viewer.hair.a.motions.some((x, i) => Math.abs(x - ringlet.viewer.hair.b.motions[i]) > 0.01)"
    review.until(far)
    assert review.get("document.querySelector('.head-handle').hidden") is False
    review.page.keyboard.press("l")
    review.until("!ringlet.viewer.hair.a.motions && !ringlet.viewer.hair.b.motions")
    assert not review.errors
