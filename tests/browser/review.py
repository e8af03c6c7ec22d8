"""The review page in a headless browser with software rendering, for tests and the pictures of the documents."""

from __future__ import annotations

import base64
import io
import json
import os
import shutil
import signal
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

# The headless shell draws no window of a browser around the page, which would take half of the time.
BROWSERS = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
CHROMIUM = next((found for name in BROWSERS if (found := shutil.which(name))), None)
FLAGS = [
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-gpu-compositing",  # panels are drawn without it in a third of the time
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
PATIENCE = 300.0  # [s] after which what is awaited is taken as missing, on a machine that is busy with other things too


@cache
def zygote() -> subprocess.Popen[str]:
    """The process from which servers are forked; it ends with this one."""
    alone = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "OMP_WAIT_POLICY": "passive"}
    program, pipe = [sys.executable, Path(__file__).with_name("zygote.py")], subprocess.PIPE
    return subprocess.Popen(program, env={**os.environ, **alone}, stdin=pipe, stdout=pipe, text=True, bufsize=1)


def ask_zygote(**question: Any) -> dict[str, Any]:
    process = zygote()
    assert process.stdin and process.stdout
    process.stdin.write(json.dumps(question) + "\n")
    line = process.stdout.readline()
    assert line, f"the process of the servers has ended: {process.poll()}"
    return json.loads(line)


class Server:
    """``ringlet view`` in a process of its own, at the same address whenever it is started again."""

    def __init__(self, file: Path) -> None:
        self.file = file
        self.port = self.pid = 0

    @property
    def address(self) -> str:
        return f"http://127.0.0.1:{self.port}/"

    def start(self) -> None:
        answer = ask_zygote(view=str(self.file), port=self.port)
        assert "pid" in answer, answer
        self.pid, self.port = answer["pid"], answer["port"]

    def pause(self) -> None:
        """Lets it receive no more messages."""
        os.kill(self.pid, signal.SIGSTOP)

    def kill(self) -> None:
        if self.pid:
            ask_zygote(kill=self.pid)
        self.pid = 0


# A browser without WebGL, whose page has all but the picture.
BLIND = """
const { getContext } = HTMLCanvasElement.prototype;
HTMLCanvasElement.prototype.getContext = function (kind, ...options) {
    return kind === 'webgl2' ? null : getContext.call(this, kind, ...options);
};
"""

# Each picture is drawn in one go, and only where a test asks for it.
QUIET = """
Object.defineProperty(window, 'ringlet', { configurable: true, set(app) {
    Object.defineProperty(window, 'ringlet', { value: app });
    const { viewer } = app, { pace, painter, view, hair } = viewer, { slice } = pace;
    pace.needed = () => 1;
    pace.slice = (moving) => (moving ? slice.call(pace, true) : { drawing: Infinity, computing: Infinity });
    if (!LIVE) viewer.picture = function* () {
        view.camera.updateMatrixWorld();
        painter.aimAtAll(view);
        [this.lacking, this.fresh] = [0, true];
        this.drawn++;
        this.onPaint();
        return { portion: { drawings: 1, fraction: 1 }, shown: hair.a.count };
    };
} });
"""


def quiet(pixels: float, *, live: bool) -> str:
    """A script after which a page draws as little as a test needs."""
    return coarse(pixels) + QUIET.replace("LIVE", json.dumps(live)) if pixels else BLIND


def coarse(pixels: float) -> str:
    """A script after which a picture has so many pixels for each of the page."""
    return f"Object.defineProperty(window, 'devicePixelRatio', {{ get: () => {pixels} }});"


class Review:
    """An open page of the review.

    pixels: of its picture over those of the page, which is drawn where a test asks for it; 0: there is none, in a
            browser without WebGL; None: as users see it
    live:   whether it is drawn at each change too, once
    """

    def __init__(self, page: Any, address: str, *, pixels: float | None = None, live: bool = False) -> None:
        self.page = page
        self.errors: list[str] = []
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on(
            "console", lambda message: self.errors.append(message.text) if "shader" in message.text.lower() else None
        )
        if pixels is not None:
            page.add_init_script(quiet(pixels, live=live))
        page.goto(address)
        self.until("window.ringlet?.viewer.hair.a.table && ringlet.settled")

    def get(self, expression: str) -> Any:
        return self.page.evaluate(f"() => {expression}")

    def until(self, expression: str, patience: float = PATIENCE) -> None:
        """Waits until an expression holds on the page, which looks at it again and again."""
        held = self.page.evaluate(
            f"""async (patience) => {{
                const end = performance.now() + patience, later = (next) => setTimeout(next, 16);
                while (!({expression}) && performance.now() < end) await new Promise(later);
                return Boolean({expression});
            }}""",
            1000 * patience,
        )
        assert held, f"timeout: {expression}; {self.errors}"

    def text(self, file: str = "recipe") -> str:
        return self.get(f"ringlet.model.documents.{file}.text")

    def answered(self) -> None:
        """Waits until the server has answered all messages so far."""
        self.until("ringlet.model.link.answered")

    def settled(self) -> None:
        """Waits until all that was asked for is built, laid out and drawn."""
        self.until("ringlet.settled")

    def laid_out(self) -> None:
        """Waits until panels and picture have their sizes."""
        self.until("ringlet.laidOut")

    def locks(self) -> np.ndarray:
        """Points of the locks where they are drawn [m], shape (points, 3)."""
        return np.reshape(self.get("Array.from(ringlet.viewer.hair.a.placed)"), (-1, 3))

    def picture(self) -> np.ndarray:
        """Pixels of the canvas, shape (height, width, 3)."""
        self.laid_out()
        return self.picture_of(self.page, "ringlet.viewer")

    def clear_picture(self) -> np.ndarray:
        """Pixels of what panels leave clear, which the picture is composed for, shape (height, width, 3)."""
        picture = self.picture()
        ratio, clear = picture.shape[1] / self.get("ringlet.viewer.size.width"), self.get("ringlet.viewer.clear")
        left, top, width, height = (int(ratio * clear[side]) for side in ("x", "y", "width", "height"))
        return picture[top : top + height, left : left + width]

    @staticmethod
    def picture_of(page: Any, viewer: str) -> np.ndarray:
        """Pixels of the canvas of a viewer with all its drawings, shape (height, width, 3)."""
        data = page.evaluate(
            f"""() => {{
                const {{ pace }} = {viewer}, {{ needed }} = pace;
                delete pace.needed;
                {viewer}.drawNow();
                if (needed !== pace.needed) pace.needed = needed;
                return {viewer}.canvas.toDataURL('image/png');
            }}"""
        )
        return np.asarray(Image.open(io.BytesIO(base64.b64decode(data.split(",")[1]))).convert("RGB"), np.float64)

    def project(self, point: np.ndarray) -> tuple[float, float]:
        """Position of a point [m] on the page [px]."""
        self.get("ringlet.viewer.camera.updateMatrixWorld()")
        x, y = self.page.evaluate(
            "(p) => { const v = ringlet.viewer, to = v.camera.position.clone().fromArray(p).project(v.camera); "
            "return [(0.5 + 0.5 * to.x) * v.element.clientWidth, (0.5 - 0.5 * to.y) * v.element.clientHeight]; }",
            point.tolist(),
        )
        return x, y

    def choose(self, stage: str) -> None:
        self.page.locator(f'[data-stage="{stage}"]').click()

    def show_all_settings(self) -> None:
        """Shows the settings that the panel of the chosen stage hides at first sight, if there are any."""
        more = self.page.get_by_role("button", name="All settings")
        if more.is_visible():
            more.click()

    def unfold(self, setting: str) -> None:
        """Opens a setting that its panel shows in one line, if it does."""
        fold = self.page.locator(f'[data-setting="{setting}"].line > .field-head > .unfold')
        if fold.is_visible():
            fold.click()

    def slider(self, setting: str) -> Any:
        return self.page.locator(f'[data-setting="{setting}"] > input[type=range]')

    def drag(self, locator: Any, *fractions: float) -> None:
        """Drags along an element between fractions of its width and waits for the server."""
        box = locator.bounding_box()
        mouse = self.page.mouse
        mouse.move(box["x"] + fractions[0] * box["width"], box["y"] + box["height"] / 2)
        mouse.down()
        for fraction in fractions[1:]:
            mouse.move(box["x"] + fraction * box["width"], box["y"] + box["height"] / 2, steps=4)
        mouse.up()
        self.answered()


def different(a: np.ndarray, b: np.ndarray) -> float:
    """Fraction of pixels that differ by over 4 of 255: hairs are thin, and the grain of the picture stays the same."""
    return float((np.abs(a - b).max(axis=2) > 4).mean())
