"""Sessions of the review: several pages, and restarts of the server."""

from __future__ import annotations

from typing import Any

from review import Review, different


def test_one_page_edits_and_the_other_follows(opened: Any, serve: Any):
    server = serve("small.recipe.toml")
    one: Review = opened(server)
    two: Review = opened(server, pixels=0.5)
    assert one.get("ringlet.model.role.leads") and not two.get("ringlet.model.role.leads")
    before = two.picture()
    one.drag(one.slider("curl.width"), 0.35, 0.9)
    two.until("ringlet.model.documents.recipe.dirty")
    two.settled()
    assert different(two.picture(), before) > 0.005
    one.choose("locks")
    one.page.get_by_label("Light", exact=True).select_option(index=1)
    one.get("ringlet.viewer.orbit(0.5, 0), ringlet.viewer.move()")
    eye = one.get("ringlet.viewer.camera.position.toArray()")
    two.until("ringlet.model.chosen.place[0] == 'locks'")
    two.until(f"Math.abs(ringlet.viewer.camera.position.x - {eye[0]}) < 1e-6")
    assert (
        two.page.get_by_label("Light", exact=True).input_value()
        == one.page.get_by_label("Light", exact=True).input_value()
    )
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


def test_unanswered_messages_are_resent_after_a_restart(opened: Any, serve: Any):
    server = serve("small.recipe.toml")
    review: Review = opened(server)
    session = review.get("ringlet.model.welcome.session")

    def fill(setting: str, value: str) -> None:
        field = review.page.locator(f'[data-setting="{setting}"] > .field-head input.number')
        field.fill(value)
        field.press("Enter")

    server.pause()  # the server receives no more messages
    fill("curl.width", "1.75")
    server.kill()
    review.until("document.documentElement.dataset.link == 'lost'")
    fill("curl.pitch", "2.25")
    server.start()
    review.until(f"ringlet.model.welcome.session != '{session}'")
    review.until("ringlet.model.documents.recipe.said.curl.pitch == 2.25")
    assert review.get("ringlet.model.documents.recipe.said.curl.width") == 1.75
    review.until("ringlet.model.settled")


def test_a_page_that_is_loaded_again_says_what_was_not_answered(opened: Any, serve: Any):
    server = serve("small.recipe.toml")
    review: Review = opened(server)
    server.pause()
    field = review.page.locator('[data-setting="curl.width"] > .field-head input.number')
    field.fill("1.75")
    field.press("Enter")
    server.kill()
    server.start()
    review.page.reload()
    review.until("window.ringlet?.model.documents.recipe?.said.curl.width == 1.75")
    assert review.get("ringlet.model.role.leads")
    review.until("ringlet.model.settled")
