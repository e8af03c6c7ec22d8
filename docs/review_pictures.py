"""Takes the pictures of the review in the documents, in headless Chromium with software rendering.

    .venv/bin/python docs/review_pictures.py              all pictures
    .venv/bin/python docs/review_pictures.py lock people  those of these names
    .venv/bin/python docs/review_pictures.py --states FOLDER   states of the page in five sizes, to be looked at

``people`` is a movie of a review of two pages, ``moving`` one of live hair. Needs playwright and Chromium.
"""

from __future__ import annotations

import argparse
import base64
import io
import re
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from playwright.sync_api import Browser, sync_playwright

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "browser"))
from review import CHROMIUM, FLAGS, PATIENCE, Review, Server

DOCS = Path(__file__).parent
IMAGES, EXAMPLE = DOCS / "images", DOCS.parent / "examples/child"
SMALL, DESKTOP, WIDE, TABLET, LYING, PHONE = (
    (1000, 640),
    (1280, 800),
    (1920, 1080),
    (820, 1180),
    (1180, 820),
    (390, 844),
)
COUNTS = {r"per_lock = 36": "per_lock = 16"}  # a picture in software takes seconds
FEW = {
    r"count = 1050": "count = 300",
    r"per_lock = \d+": "per_lock = 4",
    r"frames = \[1, 30\]": "frames = [1, 4]",
}  # where panels are looked at
SOME = {r"count = 1050": "count = 420", r"per_lock = 36": 'per_lock = 8\nwidth = "0.3 mm"'}  # few and thick, in a movie
RATE, EACH = 24.0, 3  # steps a second of live hair, and one in so many that a movie shows
TIMELESS = "[data-number=draw], [data-number=groom], .live-line .rate { display: none }"  # of a busy machine


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

    def seen(self) -> Image.Image:
        """The page as it is, with as many hairs as it has drawn so far."""
        self.settled()
        self.laid_out()
        return Image.open(io.BytesIO(self.page.screenshot(timeout=600_000))).convert("RGB")

    def taken(self) -> Image.Image:
        """The page once all of its hairs are in the picture."""
        self.settled()
        self.page.add_style_tag(content=TIMELESS)
        self.laid_out()
        self.get("ringlet.viewer.drawNow()")  # as fine as the hairs allow, however slow the machine is
        return Image.open(io.BytesIO(self.page.screenshot(timeout=600_000))).convert("RGB")


@contextmanager
def served(file: str, counts: dict[str, str] = COUNTS) -> Iterator[Server]:
    """Serves a file of a copy of the example with fewer hairs."""
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(EXAMPLE, folder, dirs_exist_ok=True)
        for path in Path(folder).glob("*.toml"):
            text = path.read_text()
            for old, new in counts.items():
                text = re.sub(old, new, text)
            path.write_text(text)
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
        page = opened(browser, server, size, theme, touch)
        yield page
        page.page.context.close()  # it draws on otherwise


def review(browser: Browser) -> Image.Image:
    with page_of(browser, "curls.recipe.toml", DESKTOP, "dark") as page:
        page.choose("curl")
        return page.taken()


# The lock that stands out most to the upper right, where its handles are seen against the wall.
OUTERMOST = """(() => {
    const { locks } = ringlet.viewer.hair.a, m = ringlet.viewer.camera.matrixWorld.elements;
    const at = (row, c) => locks.points[3 * locks.offsets[row + 1] - 3 + c];
    const out = (row) => [0, 1, 2].reduce((sum, c) => sum + at(row, c) * (m[c] + m[4 + c]), 0);
    const rows = [...locks.ids.keys()];
    ringlet.lock.choose(rows.reduce((best, row) => (out(row) > out(best) ? row : best)));
})()"""


def lock(browser: Browser) -> Image.Image:
    with page_of(browser, "curls.recipe.toml", DESKTOP, "dark") as page:
        page.choose("curl")
        page.get("(ringlet.viewer.orbit(0.5, 0.1), ringlet.viewer.move())")
        page.get(OUTERMOST)
        page.press("Isolate")
        page.until("ringlet.viewer.hair.a.locks.marked[ringlet.lock.rows[0]] == 1")
        page.settled()
        tip = page.page.locator(".handles circle").last.bounding_box()
        assert tip
        page.stroke((tip["x"] + 6, tip["y"] + 6), (tip["x"] + 46, tip["y"] + 16))
        page.page.get_by_text("values of this lock alone").click()
        return page.taken()


MOMENTS = (0.25, 0.5, 1.0, 2.0)  # after a page is asked for [s]


def start(browser: Browser) -> Image.Image:
    """What a page shows in its first two seconds: the last frame that the browser had at each moment.

    The example has all of its locks and hairs, and was open before in the same server and browser.
    """
    with served("curls.recipe.toml", {}) as server:
        opened(browser, server, SMALL, "dark").page.close()
        page = browser.contexts[-1].new_page()
        frames: list[tuple[float, str]] = []
        session = page.context.new_cdp_session(page)

        def take(frame: dict[str, Any]) -> None:
            frames.append((frame["metadata"]["timestamp"], frame["data"]))
            session.send("Page.screencastFrameAck", {"sessionId": frame["sessionId"]})

        session.on("Page.screencastFrame", take)
        session.send("Page.startScreencast", {"format": "png"})
        page.goto(server.address, wait_until="commit")
        page.wait_for_timeout(1000 * (MOMENTS[-1] + 2.0))  # frames come later than they are shown
        begin = page.evaluate("performance.timeOrigin") / 1000
        page.context.close()
    strip = Image.new("RGB", (400 * len(MOMENTS), 256))
    for k, moment in enumerate(MOMENTS):
        shown = [data for time, data in frames if time <= begin + moment]
        if shown:
            still = Image.open(io.BytesIO(base64.b64decode(shown[-1]))).convert("RGB")
            strip.paste(still.resize((400, 256), Image.Resampling.LANCZOS), (400 * k, 0))
    return strip


def sculpt(browser: Browser) -> Image.Image:
    with page_of(browser, "curls.recipe.toml", DESKTOP, "dark") as page:
        page.page.keyboard.press("b")
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
        page.press("Chart of the swing, and earlier runs")
        page.until("ringlet.timeline.settled")
        return page.taken()


def live(browser: Browser) -> Image.Image:
    """Live hair on a head that turns."""
    with page_of(browser, "curls.recipe.toml", DESKTOP, "dark") as page:
        page.page.keyboard.press("l")
        page.until("ringlet.live.step")
        page.press("Turn")
        page.until("ringlet.live.step.head[2] > 0.45 || ringlet.live.step.head[2] < -0.2")
        page.get("(ringlet.live.take = () => {})()")  # this step stays
        return page.taken()


def tablet(browser: Browser) -> Image.Image:
    with page_of(browser, "curls.recipe.toml", LYING, "light", touch=True) as page:
        page.page.keyboard.press("b")
        return page.taken()


# Looks and views [degrees] of the comparison with path-traced pictures, their size [pixels] and samples.
COMPARED, VIEWS, SQUARE, SAMPLES = ("types/3B", "types/4C", "looks/box_braids"), ((0, 5), (140, 10), (90, 5)), 320, 32
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def decoded(url: str) -> NDArray[np.float64]:
    return np.asarray(Image.open(io.BytesIO(base64.b64decode(url.split(",")[1]))).convert("RGB"), np.float64)


def pair(page: Page, look: str, azimuth: float, elevation: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Path-traced and live picture from a side. Prints the ratio of their mean luminance of the hair."""
    page.get(f"ringlet.viewer.frame({azimuth}, {elevation}, {{ x: 0, y: 0, width: {SQUARE}, height: {SQUARE} }})")
    page.page.get_by_label("Samples per pixel").evaluate(
        f"(list) => {{ list.append(new Option('', '{SAMPLES}')); list.value = '{SAMPLES}'; }}"
    )
    page.get(f"ringlet.render.start({{ width: {SQUARE}, height: {SQUARE} }})")
    page.until(f"ringlet.render.picture?.samples == {SAMPLES}", 1800.0)
    read = "(r = new FileReader(), r.onload = () => done(r.result), r.readAsDataURL(ringlet.render.picture.png))"
    render = decoded(page.get(f"new Promise((done) => {{ let r; {read}; }})"))
    page.get("ringlet.viewer.pace.needed = () => 5")  # drawings: all hairs of 4C take 48
    drawn = f"ringlet.viewer.drawAt({SQUARE}, {SQUARE}, false).toDataURL('image/png')"
    live, bare = (decoded(page.get(f"(ringlet.viewer.showHair({hair}), {drawn})")) for hair in ("true", "false"))
    page.get("ringlet.viewer.showHair(true)")
    hair = np.abs(live - bare).max(axis=2) > 8
    mean = [(picture[hair] @ LUMINANCE).mean() for picture in (live, render)]
    print(f"{look}, {azimuth}°: {mean[0] / mean[1]:.2f}")
    return render, live


def comparison(browser: Browser) -> Image.Image:
    """Pairs of a path-traced and a live picture: looks in rows, at their own density, from three sides."""
    rows = []
    for look in COMPARED:
        with tempfile.TemporaryDirectory() as folder:
            for part in ("types", "looks", "child"):
                shutil.copytree(EXAMPLE.parent / part, Path(folder, part))
            file = Path(folder, "look.recipe.toml")
            file.write_text(f'ringlet = 2\nextends = "{look}.recipe.toml"\nname = "{Path(look).name}"\n')
            server = Server(file)
            server.start()
            try:
                page = opened(browser, server, SMALL, "dark")
                rows.append(np.hstack([picture for view in VIEWS for picture in pair(page, look, *view)]))
                page.page.context.close()
            finally:
                server.kill()
    whole = Image.fromarray(np.vstack(rows).astype(np.uint8))
    return whole.resize((whole.width * 3 // 4, whole.height * 3 // 4), Image.Resampling.LANCZOS)


class Movie:
    """Pages next to each other, as a movie of stills."""

    def __init__(self, *pages: Page) -> None:
        self.pages = pages
        self.stills: list[Image.Image] = []
        self.times: list[int] = []

    def still(self, ms: int) -> None:
        """Adds the pages as they are, for a time [ms]."""
        all_pages = Image.new("RGB", (800 * len(self.pages), 512))
        for k, page in enumerate(self.pages):
            all_pages.paste(page.taken().resize((800, 512), Image.Resampling.LANCZOS), (800 * k, 0))
        self.stills.append(all_pages)
        self.times.append(ms)

    def save(self, path: Path) -> None:
        self.stills[0].save(path, save_all=True, append_images=self.stills[1:], duration=self.times, loop=0, quality=70)


def people(browser: Browser) -> Movie:
    """A review of two pages: who leads on the left, who follows on the right. A note, a snapshot, a wipe."""
    with served("curls.recipe.toml", SOME) as server:
        one, two = (opened(browser, server, SMALL, "dark") for _ in range(2))
        movie = Movie(one, two)
        for page, name in ((one, "Ada"), (two, "Ben")):
            page.page.get_by_label("Your name for them").fill(name)
            page.press("Use this name")
        one.choose("guides")
        two.until("ringlet.model.chosen.place[0] == 'guides'")
        movie.still(1500)
        for _ in range(2):
            one.get("(ringlet.viewer.orbit(-0.2, 0.02), ringlet.viewer.move())")
            movie.still(500)
        two.page.keyboard.press("a")
        two.page.get_by_label("Text of the note").fill("Shorter, to see the ear")
        two.press("Arrow")
        two.laid_out()
        clear = two.get("ringlet.viewer.clear")
        ear = (clear["x"] + 0.57 * clear["width"], clear["y"] + 0.52 * clear["height"])
        two.stroke((ear[0] + 80, ear[1] + 50), (ear[0] + 10, ear[1] + 6))
        movie.still(2000)
        two.press("Keep")
        two.page.locator("main canvas").focus()
        one.until("ringlet.model.notes.length == 1")
        one.page.keyboard.press("t")
        one.page.get_by_role("tab", name="Notes").click()
        one.press("Show note 1")
        movie.still(2000)
        one.page.keyboard.press("s")
        one.until("ringlet.model.snapshots.length == 1 && ringlet.model.pictures.size == 1")
        one.page.get_by_role("tab", name="Snapshots").click()
        movie.still(1500)
        shorter = "{ kind: 'set', file: 'recipe', changes: [[['guides', 'length', 'value'], 6]], gesture: 1 }"
        one.get(f"ringlet.model.say({shorter})")
        for page in movie.pages:
            page.until("ringlet.model.said('recipe', ['guides', 'length', 'value']) == 6")
        movie.still(1200)
        one.page.get_by_role("button", name="Compare with ‘").click()
        for page in movie.pages:
            page.until("ringlet.viewer.compared && ringlet.viewer.hair.b.table")
        for page in movie.pages:
            page.page.keyboard.press("t")
        one.page.get_by_label("Arrangement of the looks").select_option("wipe")
        line = one.page.get_by_label("Place of the wipe")
        for presses in (0, 6):
            for _ in range(presses):
                line.press("ArrowRight")
            movie.still(1500)
        return movie


def moving(browser: Browser) -> Movie:
    """Live hair that nods, turns and is blown at. Each third step is drawn, however long that takes."""
    with served("curls.recipe.toml", SOME) as server:
        page = opened(browser, server, SMALL, "dark")
        page.page.keyboard.press("l")
        page.until("ringlet.model.live.fps && ringlet.live.step")
        page.get("(window.steps = [], ringlet.live.take = (step) => { steps.push(step); })")
        for say, seconds in (
            ("{ kind: 'move_head', motion: 'nod' }", 1.8),
            ("{ kind: 'move_head', motion: 'turn' }", 1.6),
            ("{ kind: 'blow', side: 'left' }", 1.2),
        ):
            first = page.get("steps.length ? steps.at(-1).step : 0")
            page.get(f"ringlet.model.say({say})")
            page.until(f"steps.length && steps.at(-1).step >= {first + round(RATE * seconds)}", 300.0)
        movie, rows = Movie(page), page.get("steps.map((step) => step.step)")
        last = rows[0] - EACH
        for row, step in enumerate(rows):
            if step - last < EACH:
                continue
            page.get(f"(ringlet.live.step = steps[{row}], ringlet.live.show())")
            movie.still(round(1000 * (step - last) / RATE))
            last = step
        return movie


PICTURES: dict[str, Callable[[Browser], Image.Image | Movie]] = {
    made.__name__: made for made in (start, review, lock, sculpt, shot, live, tablet, comparison, people, moving)
}

SIZES = (DESKTOP, WIDE, TABLET, LYING, PHONE)
STATES = ("start", "curl", "brush", "presets", "snapshots", "note", "keys")
SHOT_STATES = ("shot", "swing", "wipe")


def reach(page: Page, state: str) -> None:
    """Brings the page from one state to another."""
    keyboard = page.page.keyboard
    match state:
        case "curl":
            page.get("document.querySelector('[data-stage=curl]').click()")
            if page.page.locator(".sheets").is_visible():
                page.press("Settings")
        case "brush":
            keyboard.press("b")
        case "presets":
            if page.page.locator(".sheets").is_visible():
                page.press("Stages")
            page.press("Looks and presets…")
        case "snapshots":
            keyboard.press("t")
        case "note":
            keyboard.press("t")
            keyboard.press("a")
        case "keys":
            keyboard.press("?")
        case "swing":
            page.press("Chart of the swing, and earlier runs")
            page.get("ringlet.timeline.goTo(ringlet.model.timeline.frames[1])")
            page.until("ringlet.timeline.settled")
        case "wipe":
            page.page.get_by_label("Compare runs and caches").select_option("run 1")
            page.until("ringlet.viewer.compared")
            page.page.get_by_label("Arrangement of the looks").select_option("wipe")


def run_twice(page: Page) -> None:
    """Runs the shot with two values of a setting."""
    page.until("ringlet.model.timeline")
    for _ in range(2):
        key = page.get("ringlet.model.timeline.key")
        page.page.get_by_role("button", name=re.compile("^Run( again)?$")).click()
        page.until(f"ringlet.model.timeline.key != {key} && ringlet.model.timeline.state == 'done'", 600.0)
        change = "{ kind: 'set', file: 'shot', changes: [[['strands', 'bend_scale'], 0.2]], gesture: 1 }"
        page.get(f"ringlet.model.say({change})")
        page.until("ringlet.model.settled")


def states(browser: Browser, folder: Path, shot_alone: bool) -> None:
    """Takes each state of the page in each size, with the themes in turn."""
    folder.mkdir(parents=True, exist_ok=True)
    files = {"curls.recipe.toml": STATES, "hat.shot.toml": SHOT_STATES}
    for file, names in list(files.items())[shot_alone:]:
        with served(file, FEW) as server:
            for k, size in enumerate(SIZES):
                theme = ("dark", "light")[(k + (names is SHOT_STATES)) % 2]
                page = opened(browser, server, size, theme, touch=size in (TABLET, LYING, PHONE))
                if names is SHOT_STATES and not k:
                    run_twice(page)
                for state in names:
                    reach(page, state)
                    page.seen().save(folder / f"{state}_{size[0]}x{size[1]}.png")
                    page.page.keyboard.press("Escape")
                page.page.context.close()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help=f"of {', '.join(PICTURES)}; all by default")
    parser.add_argument("--states", type=Path, metavar="FOLDER", help="takes states of the page in five sizes")
    parser.add_argument("--shot", action="store_true", help="with --states: those of a shot alone")
    options = parser.parse_args()
    if unknown := [name for name in options.names if name not in PICTURES]:
        parser.error(f"there is no picture '{unknown[0]}'; choose of {', '.join(PICTURES)}")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        if options.states:
            states(browser, options.states, options.shot)
            return
        for name in options.names or PICTURES:
            made = PICTURES[name](browser)
            file = IMAGES / ("review.jpg" if name == "review" else f"review_{name}.jpg")
            if isinstance(made, Movie):
                file = file.with_suffix(".webp")
                made.save(file)
            else:
                made.save(file, quality=85, optimize=True)
            print(file)


if __name__ == "__main__":
    main()
