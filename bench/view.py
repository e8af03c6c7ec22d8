"""Benchmark of the review's latency: dragging and releasing a slider, and playing a cache."""

from __future__ import annotations

import asyncio
import json
import re
import shutil
import socket
import struct
import tempfile
import threading
import time
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from websockets.asyncio.client import ClientConnection, connect

import ringlet

ROOT = Path(__file__).parents[1]
EXAMPLE = ROOT / "examples/child"


def run(locks: int = 1389, per_lock: int = 36, points: int = 60, steps: int = 12, warm_up: int = 2) -> dict[str, Any]:
    """Drags the curl width of the example in ``steps`` steps, with a release after each; plays ``steps`` frames.

    drag:  time from a new value to the locks of the draft
    rest:  time from the release to the final locks
    frame: time from a request to the frame of a cache

    The drawing on the graphics card is not included.
    """
    clock = ringlet.Clock()
    with tempfile.TemporaryDirectory() as folder:
        recipe = write_recipe(Path(folder), locks, per_lock, points)
        with serving(recipe) as port:
            counts = asyncio.run(_drag(port, clock, steps))
        with serving(_cache(recipe, steps)) as port:
            counts |= asyncio.run(_play(port, clock, steps))
    params = {"locks": locks, "per_lock": per_lock, "points": points, "steps": steps}
    medians = {f"{stage}_wall_ms": sorted(clock.wall[stage])[steps // 2] for stage in ("rest", "frame")}
    return clock.result("view", params, per="drag", warm_up=warm_up, **counts, **medians)


@contextmanager
def serving(file: Path) -> Iterator[int]:
    """Serves the review of a file in a thread; yields the port."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    ended = threading.Event()
    server = threading.Thread(
        target=ringlet.view,
        args=(file,),
        kwargs={"port": port, "browser": False, "told": lambda _: None, "until": ended},
        daemon=True,
    )
    server.start()
    try:
        yield port
    finally:
        ended.set()
        server.join()


def write_recipe(folder: Path, locks: int, per_lock: int, points: int) -> Path:
    """Writes the example's recipe with given numbers of locks and hairs."""
    shutil.copy(EXAMPLE / "head.usdc", folder)
    text = (EXAMPLE / "curls.recipe.toml").read_text()
    text = re.sub(r"(\[locks\]\ncount = )\d+(\npoints = )\d+", rf"\g<1>{locks}\g<2>{max(points, 96)}", text)
    text = re.sub(r"per_lock = \d+", f"per_lock = {per_lock}\npoints = {points}", text)
    path = folder / "curls.recipe.toml"
    path.write_text(text)
    return path


def _cache(recipe: Path, steps: int) -> Path:
    """Writes a cache of ``steps`` frames in which the locks of a recipe sway by centimetres."""
    groom, folder = ringlet.load_groom(recipe), recipe.parent
    ringlet.write_groom(groom, folder / "groom.usdc")
    points = groom.locks.points
    from_roots = points - np.repeat(points[groom.locks.offsets[:-1]], groom.locks.counts, axis=0)
    frames = np.arange(1.0, steps + 1)
    swayed = points + 0.2 * np.sin(frames)[:, None, None] * from_roots[:, [1, 2, 0]]
    ringlet.write_cache(ringlet.Cache(frames, swayed.astype(np.float32)), folder / "groom.usdc", folder / "cache.usdc")
    return folder / "cache.usdc"


@asynccontextmanager
async def _page(port: int) -> AsyncIterator[ClientConnection]:
    address = f"ws://127.0.0.1:{port}/session"
    deadline = time.monotonic() + 30.0
    while True:
        try:
            page = await connect(address, max_size=None, compression=None)
            break
        except OSError:
            if time.monotonic() > deadline:
                raise
            await asyncio.sleep(0.1)
    async with page:
        await _send(page, kind="hello", version=_protocol_version(), client="bench")
        yield page


def _protocol_version() -> int:
    """Version of the messages that the source of the page states."""
    source = ROOT / "web/src/protocol.ts"
    version = re.search(r"^export const VERSION = (\d+);$", source.read_text(), re.MULTILINE)
    assert version, f"{source}: states no version"
    return int(version[1])


async def _drag(port: int, clock: ringlet.Clock, steps: int) -> dict[str, Any]:
    async with _page(port) as page:
        hairs, _ = await _receive(page, "hairs")
        _, size = await _receive(page, "locks")
        await _receive(page, "numbers")
        for step in range(steps):
            change = [[["curl", "width", "value"], round(1.0 + 0.02 * step, 3)]]
            with clock("drag"):
                await _send(page, kind="set", changes=change, gesture=step, resting=False)
                while not (await _receive(page, "locks"))[0]["draft"]:
                    pass
            change[0][1] = round(1.01 + 0.02 * step, 3)
            with clock("rest"):
                await _send(page, kind="set", changes=change, gesture=step)
                while (await _receive(page, "locks"))[0]["draft"]:
                    pass
            await _receive(page, "measured")  # sent after the final locks
    return {"hairs": hairs["count"], "locks_bytes": size}


async def _play(port: int, clock: ringlet.Clock, steps: int) -> dict[str, Any]:
    async with _page(port) as page:
        await _receive(page, "timeline")
        size = 0
        for frame in range(1, steps + 1):
            with clock("frame"):
                await _send(page, kind="watch", shot=[frame])
                _, size = await _receive(page, "frame")
    return {"frame_bytes": size}


async def _send(page: ClientConnection, **message: Any) -> None:
    text = json.dumps(message).encode()
    await page.send(struct.pack("<I", len(text)) + text)


async def _receive(page: ClientConnection, kind: str) -> tuple[dict[str, Any], int]:
    """Waits for the next message of a kind; returns its header and its size [bytes]."""
    while True:
        data = await asyncio.wait_for(page.recv(), 60.0)
        assert isinstance(data, bytes)
        length = struct.unpack_from("<I", data)[0]
        message = json.loads(data[4 : 4 + length])
        if message["kind"] == kind and not (kind == "numbers" and message["draft"]):
            return message, len(data)
