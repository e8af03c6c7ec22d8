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
