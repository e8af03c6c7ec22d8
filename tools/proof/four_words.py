"""Actions and seconds of "shorter, tighter, parted on the left, redder" in the review of the example, in Chromium.

    .venv/bin/python tools/proof/four_words.py

A script moves the pointer; a person reads and aims besides. Seconds are from the first press until the picture in
software has all four. Prints JSON.
"""

from __future__ import annotations

import json
import shutil
import sys
import tempfile
import time
from pathlib import Path

from playwright.sync_api import sync_playwright

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests" / "browser"))
from review import CHROMIUM, FLAGS, PATIENCE, Review, Server  # noqa: E402

DRAGS = {"guides.length": -12, "curl.width": -12, "guides.part_line.offset": 16, "color.redness": 24}  # [pixels]


def measure() -> dict[str, object]:
    with tempfile.TemporaryDirectory() as name, sync_playwright() as playwright:
        folder = Path(name, "child")
        shutil.copytree(ROOT / "examples" / "child", folder)
        server = Server(folder / "curls.recipe.toml")
        server.start()
        try:
            page = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS).new_page()
            page.set_default_timeout(1000 * PATIENCE)
            review = Review(page, server.address)
            before, began = {of: review.slider(of).input_value() for of in DRAGS}, time.monotonic()
            for of, by in DRAGS.items():
                slider = review.slider(of)
                slider.scroll_into_view_if_needed()
                box = slider.bounding_box()
                place = (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
                page.mouse.move(*place)
                page.mouse.down()
                page.mouse.move(place[0] + by, place[1], steps=5)
                page.mouse.up()
                review.answered()
            said = time.monotonic() - began
            review.until("ringlet.settled && ringlet.viewer.current")
            changes = {of: [float(old), float(review.slider(of).input_value())] for of, old in before.items()}
            assert all((new - old) * DRAGS[of] > 0 for of, (old, new) in changes.items()), changes
            seen = time.monotonic() - began
            return {"name": "four_words", "actions": len(DRAGS), "said_s": said, "seen_s": seen, "changes": changes}
        finally:
            server.kill()


if __name__ == "__main__":
    print(json.dumps(measure()))
