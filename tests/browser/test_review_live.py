"""Live hair on the review page: rods from the server, hairs on the graphics card."""

from __future__ import annotations

from typing import Any

import numpy as np
from review import Review

HAIRS = "Array.from(ringlet.viewer.hair.a.read(ringlet.viewer.renderer, 1e6))"


def hairs(review: Review) -> np.ndarray:
    """Points of all hairs as they are on the card [m], shape (n, 3)."""
    return np.array(review.get(HAIRS)).reshape(-1, 4)[:, :3]


def test_the_card_carries_hairs_by_their_rods_and_puts_them_back(opened: Any) -> None:
    review: Review = opened(pixels=0.1)
    rest = hairs(review)
    review.page.keyboard.press("l")
    review.until("ringlet.live.step")
    assert np.abs(hairs(review) - rest).max() < 2e-6  # rods that have not moved
    turn = np.array([[0.8, 0.0, 0.6, 0.01], [0.0, 1.0, 0.0, 0.02], [-0.6, 0.0, 0.8, 0.03]])
    review.get(
        f"""(() => {{
            const {{ rods, step }} = ringlet.live, m = {turn.ravel().tolist()}, {{ points }} = rods.message;
            const moved = points.map((_, i) => {{
                const row = i % 3, at = i - row;
                return m[4 * row + 3] + [0, 1, 2].reduce((sum, c) => sum + m[4 * row + c] * points[at + c], 0);
            }});
            ringlet.live.take = () => {{}}; // those of the server
            Object.assign(ringlet.live, {{ step: {{ ...step, head: m, points: moved }} }});
            ringlet.live.show();
        }})()"""
    )
    assert np.abs(hairs(review) - (rest @ turn[:, :3].T + turn[:, 3])).max() < 1e-5
    review.page.get_by_role("button", name="Live hair (L)", exact=False).click()
    review.until("!ringlet.model.live.on")
    assert np.array_equal(hairs(review), rest)
    assert not review.errors


def test_another_groom_begins_where_the_hair_is_seen(opened: Any) -> None:
    review: Review = opened(pixels=0.1)
    review.page.keyboard.press("l")
    review.until("ringlet.live.step")
    review.get("(() => { const t = performance.now(); performance.now = () => t; ringlet.live.take = () => {}; })()")
    before = hairs(review)
    review.get(
        """(() => {
            const { locks } = ringlet.viewer.hair.a, { offsets } = locks;
            const points = locks.points.slice();
            for (let lock = 0; lock + 1 < offsets.length; lock++)
                for (let i = offsets[lock]; i < offsets[lock + 1]; i++)
                    points[3 * i] += (0.006 * (i - offsets[lock])) / (offsets[lock + 1] - offsets[lock]);
            ringlet.model.take({ ...locks, points });
        })()"""
    )
    first = hairs(review)
    review.get("(() => { const t = performance.now() + 2000; performance.now = () => t; ringlet.live.show(); })()")
    now = hairs(review)
    assert np.abs(now - before).max() > 4e-3
    assert np.abs(first - before).mean() < 0.15 * np.abs(now - before).mean()  # about their lock as in the new
    review.get("ringlet.viewer.putAtRest()")
    assert np.abs(hairs(review) - now).max() < 2e-6
    assert not review.errors
