"""People together on the review page: names, following, the pointer, asking to edit, and links to a view."""

from __future__ import annotations

from typing import Any

import pytest
from review import Review

EYE = "ringlet.viewer.camera.position.toArray()"


@pytest.fixture
def pair(opened: Any, serve: Any) -> tuple[Review, Review]:
    """A page that leads, and one that follows."""
    server = serve("small.recipe.toml")
    return opened(server), opened(server)


def give_name(review: Review, name: str) -> None:
    review.page.get_by_label("Your name for them").fill(name)
    review.page.get_by_role("button", name="Use this name").click()


def test_people_give_their_name_once_and_see_who_is_there(pair: tuple[Review, Review], serve: Any):
    one, two = pair
    give_name(one, "Ann Lee")
    two.page.get_by_role("button", name="Stay a guest").click()
    two.until("ringlet.model.role.people.some((person) => person.name == 'Ann Lee')")
    assert not one.page.get_by_label("Your name for them").is_visible()
    one.page.keyboard.press("t")
    assert one.page.locator(".tray .author").input_value() == "Ann Lee"
    one.page.keyboard.press("t")
    two.page.get_by_role("button", name="2 people are here").click()
    rows = two.page.get_by_role("list", name="People").get_by_role("listitem").all_inner_texts()
    assert [row.split("\n")[1:] for row in rows] == [["Ann Lee", "edits"], ["Guest 2 (you)", "follows"]]
    assert two.page.locator(".faces .face").all_inner_texts() == ["AL", "G2"]
    two.page.keyboard.press("Escape")
    one.page.reload()
    one.until("window.ringlet?.model.role.people.length == 2")
    assert not one.page.get_by_label("Your name for them").is_visible()
    assert one.get("ringlet.model.role.people.find((person) => person.you).name") == "Ann Lee"


def test_a_follower_sees_what_the_leader_sees_until_it_looks_elsewhere(pair: tuple[Review, Review]):
    one, two = pair
    one.page.keyboard.press("n")
    one.choose("locks")
    one.page.keyboard.press("ArrowLeft")
    two.until("ringlet.model.chosen.place[0] == 'locks' && ringlet.lock.rows.join() == '0'")
    two.until(f"Math.abs({EYE}[0] - {one.get(EYE)[0]}) < 1e-6")
    assert two.get("'follows' in document.documentElement.dataset")
    two.choose("curl")  # what a follower looks at on its own ends that it follows
    one.until("ringlet.model.role.people.some((person) => !person.follows)")
    one.choose("guides")
    one.page.keyboard.press("ArrowLeft")
    two.until("ringlet.model.followed.place[0] == 'guides'")
    assert two.get("ringlet.model.chosen.place[0]") == "curl"
    two.page.keyboard.press("g")
    two.until("ringlet.model.chosen.place[0] == 'guides'")
    two.until(f"Math.abs({EYE}[0] - {one.get(EYE)[0]}) < 1e-6")
    two.page.get_by_role("button", name="Stop following").click()
    assert not two.get("'follows' in document.documentElement.dataset")


def test_a_follower_sees_the_comparison_as_the_leader_arranges_it(pair: tuple[Review, Review]):
    one, two = pair
    one.page.get_by_label("Compare with another look").select_option(index=1)
    for review in pair:
        review.until("ringlet.viewer.compared && ringlet.viewer.hair.b.table")
    one.page.get_by_label("Arrangement of the looks").select_option("wipe")
    one.page.get_by_label("Place of the wipe").press("ArrowRight")
    place = one.get("ringlet.viewer.looks.wipe")
    assert place > 0.5
    two.until(f"ringlet.viewer.looks.arrangement == 'wipe' && ringlet.viewer.looks.wipe == {place}")
    one.page.get_by_role("button", name="Swap the two sides").click()
    two.until("ringlet.viewer.looks.order.join() == 'b,a'")
    assert two.page.get_by_label("Arrangement of the looks").input_value() == "wipe"
    assert two.get("'follows' in document.documentElement.dataset")
    two.page.get_by_label("Arrangement of the looks").select_option("difference")
    one.until("ringlet.model.role.people.some((person) => !person.follows)")  # it looks on its own from now on
    assert one.get("ringlet.viewer.looks.arrangement") == "wipe"


def test_the_pointer_of_the_leader_is_seen_where_it_points(pair: tuple[Review, Review]):
    one, two = pair
    give_name(one, "Ann")
    two.page.get_by_role("button", name="Stay a guest").click()
    for review in pair:
        review.laid_out()  # the question for a name moves the picture
        review.until("ringlet.viewer.idle")
    box = one.page.locator("main canvas").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + 0.35 * box["height"]
    one.page.mouse.move(x - 5, y)
    one.page.mouse.move(x, y)
    pointer = two.page.locator(".pointer")
    pointer.wait_for()
    two.until("document.querySelector('.pointer').innerText == 'Ann'")
    two.until("ringlet.viewer.idle")
    seen = pointer.bounding_box()
    ours, theirs = (page.get("ringlet.viewer.clear") for page in pair)  # the camera sees the height of what is clear
    scale = theirs["height"] / ours["height"]
    across = (x - box["x"] - ours["x"] - ours["width"] / 2) * scale
    down = (y - box["y"] - ours["y"] - ours["height"] / 2) * scale
    assert abs(seen["x"] + 2 - box["x"] - theirs["x"] - theirs["width"] / 2 - across) < 3
    assert abs(seen["y"] + 2 - box["y"] - theirs["y"] - theirs["height"] / 2 - down) < 3
    two.page.set_viewport_size({"width": 800, "height": 500})  # another picture, the same place of the head
    two.until(f"Math.abs(document.querySelector('.pointer').getBoundingClientRect().x - {seen['x']}) > 20")
    one.page.mouse.move(20, 10)
    pointer.wait_for(state="hidden")


def test_who_asks_to_edit_is_named_and_gets_an_answer(pair: tuple[Review, Review]):
    one, two = pair
    give_name(two, "Bo")
    two.page.keyboard.press("Escape")
    two.page.get_by_role("button", name="Ask to edit").click()
    assert two.page.get_by_role("button", name="Asked to edit").is_disabled()
    one.page.locator(".questions", has_text="Bo asks to edit").wait_for()
    one.page.get_by_role("button", name="Not now").click()
    two.page.locator(".notice", has_text="Guest 1 goes on editing").wait_for()
    two.page.get_by_role("button", name="Ask to edit").click()
    one.page.get_by_role("button", name="Hand over").click()
    one.page.locator(".notice", has_text="Bo can edit now").wait_for()
    two.until("ringlet.model.role.leads")
    one.until("!ringlet.model.role.leads")
    assert one.page.locator(".settings[inert]").count() == 1


def test_a_link_opens_the_view_that_it_was_copied_from(opened: Any, serve: Any):
    server = serve("small.recipe.toml")
    one: Review = opened(server, permissions=["clipboard-read", "clipboard-write"])
    one.page.keyboard.press("n")
    one.choose("locks")
    one.page.get_by_label("Light", exact=True).select_option(index=2)
    one.page.get_by_label("Overlay").select_option("pins")
    one.get("(ringlet.viewer.orbit(0.9, 0.2), ringlet.viewer.move())")
    one.page.keyboard.press("l")
    one.page.locator(".notice", has_text="link to this view is copied").wait_for()
    link = one.page.evaluate("navigator.clipboard.readText()")
    assert link.startswith(server.address + "#of=small.recipe.toml&camera=") and "stage=recipe/locks" in link

    class Linked:
        address = link

    two: Review = opened(Linked())
    two.until("ringlet.lock.rows.join() == '0'")
    assert two.get(EYE) == pytest.approx(one.get(EYE), abs=1e-4)
    assert two.get("[ringlet.model.chosen.place.join(), ringlet.model.overlay]") == ["locks", "pin"]
    assert two.page.get_by_label("Light", exact=True).evaluate("e => e.selectedIndex") == 2
    two.page.get_by_role("button", name="Follow Guest 1").wait_for()
    assert not two.errors and not one.errors
