"""Takes the pictures of the review in the documents, in headless Chromium with software rendering.

    .venv/bin/python docs/review_pictures.py              all pictures
    .venv/bin/python docs/review_pictures.py lock people  those of these names
    .venv/bin/python docs/review_pictures.py --states FOLDER   states of the page in five sizes, to be looked at

``people`` is a review of two pages, as stills of both next to each other. Needs playwright and Chromium.
"""

from __future__ import annotations

import argparse
import io
import re
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from PIL import Image
from playwright.sync_api import Browser, sync_playwright

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "browser"))
from review import CHROMIUM, FLAGS, PATIENCE, Review, Server

DOCS = Path(__file__).parent
IMAGES, EXAMPLE = DOCS / "images", DOCS.parent / "examples/child"
DESKTOP, WIDE, TABLET, LYING, PHONE = (1280, 800), (1920, 1080), (820, 1180), (1180, 820), (390, 844)
COUNTS = {r"count = 1050": "count = 620", r"per_lock = 36": "per_lock = 12"}  # a picture in software takes seconds


class Page(Review):
    """A page of the review, as a picture shows it."""

    def press(self, name: str, role: str = "button") -> None:
        self.page.get_by_role(role, name=name, exact=True).click()

    def stroke(self, *places: tuple[float, float]) -> None:
        """Draws with the pointer through places of the page [pixels]."""
        mouse = self.page.mouse
        mouse.move(*places[0])
        mouse.down()
        for place in places[1:]:
            mouse.move(*place, steps=5)
        mouse.up()

    def taken(self) -> Image.Image:
        """The page once all of its hairs are in the picture."""
        self.settled()
        self.until("ringlet.viewer.idle")
        self.get("ringlet.viewer.drawNow()")  # as fine as the hairs allow, however slow the machine is
        return Image.open(io.BytesIO(self.page.screenshot())).convert("RGB")


@contextmanager
def served(file: str) -> Iterator[Server]:
    """Serves a file of a copy of the example with fewer hairs."""
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(EXAMPLE, folder, dirs_exist_ok=True)
        recipe = Path(folder, "curls.recipe.toml")
        text = recipe.read_text()
        for old, new in COUNTS.items():
            text = re.sub(old, new, text)
        recipe.write_text(text)
        server = Server(Path(folder, file))
        server.start()
        try:
            yield server
        finally:
            server.kill()


def opened(browser: Browser, server: Server, size: tuple[int, int], theme: str, touch: bool = False) -> Page:
    """A new page of a served review."""
    options: dict[str, Any] = {"color_scheme": theme, "has_touch": touch, "is_mobile": touch}
    context = browser.new_context(viewport={"width": size[0], "height": size[1]}, **options)
    context.set_default_timeout(1000 * PATIENCE)
    return Page(context.new_page(), server.address)


@contextmanager
def page_of(browser: Browser, file: str, size: tuple[int, int], theme: str, touch: bool = False) -> Iterator[Page]:
    """A page of a review of its own."""
    with served(file) as server:
        yield opened(browser, server, size, theme, touch)


def review(browser: Browser) -> Image.Image:
    with page_of(browser, "curls.recipe.toml", DESKTOP, "dark") as page:
        page.choose("curl")
        return page.taken()


def lock(browser: Browser) -> Image.Image:
    with page_of(browser, "curls.recipe.toml", DESKTOP, "dark") as page:
        page.choose("curl")
        page.get("ringlet.lock.choose(40)")
        page.press("Isolate")
        page.until("ringlet.viewer.hair.a.locks.marked[40] == 1")
        page.page.get_by_text("values of this lock alone").click()
        return page.taken()


def sculpt(browser: Browser) -> Image.Image:
    with page_of(browser, "curls.recipe.toml", DESKTOP, "dark") as page:
        page.page.keyboard.press("b")
        page.press("comb")
        page.stroke((640, 190), (690, 150), (760, 130))
        page.until("ringlet.model.documents.recipe.edits.includes('[[sculpt]]')")
        return page.taken()


def shot(browser: Browser) -> Image.Image:
    with page_of(browser, "hat.shot.toml", DESKTOP, "light") as page:
        page.choose("shot:strands")
        page.press("Run")
        page.until("ringlet.timeline.count >= 8")
        page.press("Pause")
        page.get("ringlet.timeline.show(6)")
        page.press("Swing and earlier runs")
        page.until("ringlet.timeline.settled")
        return page.taken()


def tablet(browser: Browser) -> Image.Image:
    with page_of(browser, "curls.recipe.toml", TABLET, "light", touch=True) as page:
        page.page.keyboard.press("b")
        return page.taken()


def people(browser: Browser) -> Image.Image:
    """A review of two pages, as stills: the one who leads on the left, the one who follows on the right."""
    stills: list[Image.Image] = []
    with served("curls.recipe.toml") as server:
        one, two = (opened(browser, server, DESKTOP, "dark") for _ in range(2))

        def still() -> None:
            both = Image.new("RGB", (1600, 500))
            for k, page in enumerate((one, two)):
                both.paste(page.taken().resize((800, 500), Image.Resampling.LANCZOS), (800 * k, 0))
            stills.append(both)

        for page, name in ((one, "Ada"), (two, "Ben")):
            page.page.get_by_label("Your name for them").fill(name)
            page.press("Use this name")
        one.choose("guides")
        one.get("(ringlet.viewer.orbit(-0.5, 0.05), ringlet.viewer.move())")
        two.until("ringlet.model.chosen.place[0] == 'guides'")
        still()
        change = "{ kind: 'set', file: 'recipe', changes: [[['guides', 'length', 'value'], 5.5]], gesture: 1 }"
        one.get(f"ringlet.model.say({change})")
        two.until("ringlet.model.value('recipe', ['guides', 'length', 'value']) == 5.5")
        still()
        two.page.keyboard.press("a")
        two.page.get_by_label("Text of the note").fill("Longer over the ear")
        two.press("Arrow")
        two.stroke((880, 260), (800, 330))
        two.press("Keep")
        one.until("ringlet.model.notes.length == 1")
        one.page.keyboard.press("t")
        one.page.get_by_role("tab", name="Notes").click()
        one.press("Show note 1")
        still()
    sheet = Image.new("RGB", (1600, 500 * len(stills)))
    for k, both in enumerate(stills):
        sheet.paste(both, (0, 500 * k))
    return sheet


PICTURES: dict[str, Callable[[Browser], Image.Image]] = {
    made.__name__: made for made in (review, lock, sculpt, shot, tablet, people)
}

# What is pressed from one state of the page to the next: a stage, a key or a button.
STATES = {
    "start": "",
    "curl": '[data-stage="curl"]',
    "brush": "key b",
    "tray": "key t",
    "keys": "key ?",
}


def states(browser: Browser, folder: Path) -> None:
    """Takes each state of the page in each size, in both themes."""
    folder.mkdir(parents=True, exist_ok=True)
    with served("curls.recipe.toml") as server:
        for k, size in enumerate((DESKTOP, WIDE, TABLET, LYING, PHONE)):
            page = opened(browser, server, size, ("dark", "light")[k % 2], touch=size in (TABLET, LYING, PHONE))
            for state, action in STATES.items():
                if action.startswith("key"):
                    page.page.keyboard.press(action[4:])
                elif action:
                    page.get(f"document.querySelector('{action}').click()")
                page.taken().save(folder / f"{state}_{size[0]}x{size[1]}.png")
                page.page.keyboard.press("Escape")
            page.page.context.close()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help=f"of {', '.join(PICTURES)}; all by default")
    parser.add_argument("--states", type=Path, metavar="FOLDER", help="takes states of the page in five sizes")
    options = parser.parse_args()
    if unknown := [name for name in options.names if name not in PICTURES]:
        parser.error(f"there is no picture '{unknown[0]}'; choose of {', '.join(PICTURES)}")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        if options.states:
            states(browser, options.states)
            return
        for name in options.names or PICTURES:
            file = IMAGES / ("review.jpg" if name == "review" else f"review_{name}.jpg")
            PICTURES[name](browser).save(file, quality=85, optimize=True)
            print(file)


if __name__ == "__main__":
    main()
