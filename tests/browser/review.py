"""The review page in a headless browser with software rendering, for tests and the pictures of the documents."""

from __future__ import annotations

import base64
import io
import os
import shutil
import socket
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

CHROMIUM = next(
    (found for name in ("chromium", "chromium-browser", "google-chrome") if (found := shutil.which(name))), None
)
FLAGS = [
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
PATIENCE = 90.0  # [s] for slow software rendering


class Server:
    """``ringlet view`` in its own process."""

    def __init__(self, file: Path) -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.file = file
        self.process: subprocess.Popen[bytes] | None = None

    @property
    def address(self) -> str:
        return f"http://127.0.0.1:{self.port}/"

    def start(self) -> None:
        program = "from ringlet.cli import main; main()"
        arguments = ["view", str(self.file), "--port", str(self.port), "--no-browser"]
        environment = {**os.environ, "OMP_NUM_THREADS": "1", "OMP_WAIT_POLICY": "passive"}
        self.process = subprocess.Popen(
            [sys.executable, "-c", program, *arguments], env=environment, stdout=subprocess.DEVNULL
        )
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            try:
                socket.create_connection(("127.0.0.1", self.port), 1.0).close()
                return
            except OSError:
                time.sleep(0.1)
        raise AssertionError("the server did not start")

    def kill(self) -> None:
        if self.process:
            self.process.kill()
            self.process.wait()


class Review:
    """An open page of the review."""

    def __init__(self, page: Any, address: str) -> None:
        self.page = page
        self.errors: list[str] = []
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on(
            "console", lambda message: self.errors.append(message.text) if "shader" in message.text.lower() else None
        )
        page.goto(address)
        self.until("window.ringlet?.viewer.hair.a.table && ringlet.model.settled")
        self.laid_out()

    def get(self, expression: str) -> Any:
        return self.page.evaluate(f"() => {expression}")

    def until(self, expression: str, patience: float = PATIENCE) -> None:
        """Waits until an expression holds on the page."""
        deadline = time.monotonic() + patience
        while time.monotonic() < deadline:
            if self.get(f"Boolean({expression})"):
                return
            time.sleep(0.05)
        raise AssertionError(f"timeout: {expression}; {self.errors}")

    def text(self, file: str = "recipe") -> str:
        return self.get(f"ringlet.model.documents.{file}.text")

    def answered(self) -> None:
        """Waits until the server has processed all messages so far, by an exchange of the edit lock."""
        self.get("(window.role = ringlet.model.role, ringlet.model.say({ kind: 'lead' }))")
        self.until("ringlet.model.role !== role")

    def settled(self) -> None:
        """Waits until all requests are built and drawn."""
        before = self.get("ringlet.viewer.pictures")
        self.until("ringlet.model.settled")
        self.get("ringlet.viewer.invalidate()")
        self.until(f"ringlet.viewer.pictures > {before}")

    def laid_out(self) -> None:
        """Waits until panels have their sizes, which the picture is composed for: the same in two frames in a row.

        The browser reports a new size of a panel in the frame after the change.
        """
        self.page.evaluate(
            "async () => { for (let now = '', before; now !== before; ) { before = now; "
            "await new Promise(requestAnimationFrame); now = JSON.stringify(ringlet.viewer.clear); } }"
        )

    def picture(self) -> np.ndarray:
        """Pixels of the canvas, shape (height, width, 3)."""
        self.laid_out()
        return self.picture_of(self.page, "ringlet.viewer")

    def clear_picture(self) -> np.ndarray:
        """Pixels of what panels leave clear, which the picture is composed for, shape (height, width, 3)."""
        picture, clear = self.picture(), self.get("ringlet.viewer.clear")
        return picture[clear["y"] :, clear["x"] :][: clear["height"], : clear["width"]]

    @staticmethod
    def picture_of(page: Any, viewer: str) -> np.ndarray:
        """Pixels of the canvas of a viewer, shape (height, width, 3)."""
        data = page.evaluate(
            f"() => {{ {viewer}.drawNow(); return {viewer}.renderer.domElement.toDataURL('image/png') }}"
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
