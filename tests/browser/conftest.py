"""Fixtures of the browser tests: the review page against the real server."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from review import CHROMIUM, FLAGS, PATIENCE, Review, Server

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))
from small_example import write_example

STATIC = Path(__file__).parents[2] / "python/ringlet/viewer/static/index.html"
REQUIRED = os.environ.get("RINGLET_BROWSER") == "required"  # set in continuous integration


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    reason = ""
    if CHROMIUM is None:
        reason = "there is no Chromium here: apt-get install chromium-headless-shell"
    elif not STATIC.exists():
        reason = "the page was not built: make build"
    else:
        try:
            import playwright.sync_api  # noqa: F401
        except ImportError:
            reason = "playwright is not installed: pip install playwright"
    if reason and REQUIRED:
        pytest.exit(f"browser tests: {reason}", returncode=1)
    for item in items:
        if reason and Path(__file__).parent in item.path.parents:
            item.add_marker(pytest.mark.skip(reason=reason))


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield browser
        browser.close()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The small example with thick hairs: its pictures need the fewest drawings."""
    folder = write_example(tmp_path / "project")
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text() + 'width = "0.3 mm"\n')
    return folder


@pytest.fixture
def serve(folder: Path) -> Iterator[Callable[[str], Server]]:
    servers: list[Server] = []

    def start(file: str) -> Server:
        servers.append(Server(folder / file))
        servers[-1].start()
        return servers[-1]

    yield start
    for server in servers:
        server.kill()


@pytest.fixture
def opened(browser: Any, serve: Callable[[str], Server]) -> Iterator[Callable[..., Review]]:
    contexts: list[Any] = []

    def open_page(
        server: Server | str = "small.recipe.toml", *, pixels: float | None = 0.0, live: bool = False, **more: Any
    ) -> Review:
        """A page in a context of its own; see ``Review`` for its picture."""
        address = (serve(server) if isinstance(server, str) else server).address
        options = {
            "viewport": {"width": 1000, "height": 640},
            "color_scheme": "dark",
            "reduced_motion": "reduce",
            **more,
        }
        contexts.append(browser.new_context(**options))
        contexts[-1].set_default_timeout(1000 * PATIENCE)
        return Review(contexts[-1].new_page(), address, pixels=pixels, live=live)

    yield open_page
    for context in contexts:
        context.close()
