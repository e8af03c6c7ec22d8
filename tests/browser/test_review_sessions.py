"""Sessions of the review: several pages, and restarts of the server."""

from __future__ import annotations

from typing import Any

import numpy as np
from review import Review


def test_one_page_edits_and_the_other_follows(opened: Any, serve: Any):
    server = serve("small.recipe.toml")
    one: Review = opened(server)
    two: Review = opened(server)
    assert one.get("ringlet.model.role.leads") and not two.get("ringlet.model.role.leads")
    before = two.locks()
    one.drag(one.slider("curl.width"), 0.35, 0.9)
    two.until("ringlet.model.documents.recipe.dirty")
    for review in (one, two):
        review.settled()
    assert np.abs(two.locks() - before).max() > 0.002 and np.array_equal(two.locks(), one.locks())
    one.choose("locks")
    one.page.get_by_label("Light", exact=True).select_option(index=1)
    one.get("(ringlet.viewer.orbit(0.5, 0), ringlet.viewer.move())")
    eye = one.get("ringlet.viewer.camera.position.toArray()")
    light = one.page.get_by_label("Light", exact=True).input_value()
    two.until(f"Math.abs(ringlet.viewer.camera.position.x - {eye[0]}) < 1e-6")
    two.until(f"document.querySelector('[aria-label=Light]').value == '{light}'")
    two.until("ringlet.model.chosen.place[0] == 'locks'")
    two.page.mouse.move(500, 500)  # a page that turns the head itself follows no more
    two.page.mouse.down()
    two.page.mouse.move(540, 500, steps=2)
    two.page.mouse.up()
    two.page.get_by_role("button", name="Follow Guest 1").wait_for()
    for answer, leads in (("Not now", False), ("Hand over", True)):
        two.page.get_by_role("button", name="Ask to edit").click()
        two.until("ringlet.model.role.asks")
        one.page.get_by_role("button", name=answer).click()
        two.until("!ringlet.model.role.asks")
        assert two.get("ringlet.model.role.leads") == leads
    one.until("!ringlet.model.role.leads")


def test_no_edit_is_lost_when_the_server_is_killed(opened: Any, serve: Any):
    server = serve("small.recipe.toml")
    review: Review = opened(server)
    review.drag(review.slider("curl.width"), 0.35, 0.9)
    review.until("ringlet.model.documents.recipe.dirty")
    text, session = review.text(), review.get("ringlet.model.welcome.session")
    review.get("(window.before = ringlet.model.documents.recipe)")
    server.kill()
    review.until("document.documentElement.dataset.link == 'lost'")
    server.start()
    review.until(f"ringlet.model.welcome.session != '{session}'")
    review.until("ringlet.model.documents.recipe !== before && ringlet.model.documents.recipe.dirty")
    assert review.text() == text
    assert review.page.get_by_role("button", name="Save", exact=True).is_enabled()
    review.page.keyboard.press("Control+z")  # the restored document is an undo step
    review.until("!ringlet.model.documents.recipe.dirty")
