"""Benchmark of the review page in headless Chromium: a drag of a slider until its picture, and orbiting."""

from __future__ import annotations

import os
import statistics
import sys
import tempfile
from pathlib import Path
from typing import Any

from playwright.sync_api import sync_playwright
from view import ROOT, write_recipe

sys.path.insert(0, str(ROOT / "tests/browser"))
from review import CHROMIUM, FLAGS, Review, Server

# Notes when the hand moved, when the page said it, when the locks came, and when the first picture after that was done.
# The hand moves at the time of the event: the wait for a busy page counts.
PROBE = """
(() => {
  const { model, viewer } = ringlet;
  const marks = (window.marks = {});
  const begin = (event) => event.isTrusted && !marks.said && (marks.hand = performance.timeOrigin + event.timeStamp);
  for (const name of ["input", "pointerup"]) addEventListener(name, begin, true);
  const now = () => performance.timeOrigin + performance.now();
  const { say, tell } = model;
  model.say = (message) => {
    if (message.kind === "set" && !marks.said && Boolean(message.resting ?? true) === marks.rests) marks.said = now();
    say.call(model, message);
  };
  const hear = ringlet.hear;
  ringlet.hear = (message) => {
    if (message.kind === "locks" && marks.said && !marks.came && message.draft !== marks.rests) marks.came = now();
    const settled = message.kind === "numbers" && marks.came && marks.server === undefined;
    if (settled && message.draft !== marks.rests) marks.server = message.groom_ms;
    hear.call(ringlet, message);
  };
  const { draw, onDraw } = viewer;
  let began = 0;
  window.drawn = [];
  window.scripts = [];
  viewer.draw = () => { began = now(); draw.call(viewer); scripts.push(now() - began); };
  viewer.onDraw = (statistics) => {
    if (statistics.drawMs !== undefined) drawn.push([statistics.drawMs, statistics.shown]);
    if (marks.came && !marks.done && began > marks.came) marks.done = now();
    onDraw(statistics);
  };
})()
"""
# Turns the camera in each frame of the browser, until the time has passed and there are enough pictures for a median.
ORBIT = """
({ seconds, least }) => new Promise((done) => {
  const { viewer } = ringlet, began = performance.now(), first = viewer.pictures;
  drawn.length = scripts.length = 0;
  const turn = () => {
    const passed = (performance.now() - began) / 1000;
    if (passed > seconds && drawn.length >= least) return done([viewer.pictures - first, passed]);
    viewer.orbit(0.02, 0);
    viewer.move();
    requestAnimationFrame(turn);
  };
  turn();
})
"""
# Presses a key while a picture at rest is drawn: times until the next picture begins and until it is done, and slices.
CANCEL = """
(times) => new Promise((done) => {
  const { viewer } = ringlet, { clock } = viewer, begin = clock.begin, { draw, onDraw } = viewer;
  const waits = [], pictures = [], slices = [];
  let pressed = 0, slice = 0, resting = false;
  clock.begin = () => {
    if (resting && viewer.rest) slices.push(performance.now() - slice);
    [slice, resting] = [performance.now(), Boolean(viewer.rest)];
    begin.call(clock);
  };
  const press = () => {
    if (!viewer.rest || viewer.resting) return setTimeout(press, 50);
    pressed = performance.now();
    viewer.renderer.domElement.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft", bubbles: true }));
  };
  viewer.draw = () => {
    if (pressed && waits.length === pictures.length) waits.push(performance.now() - pressed);
    draw.call(viewer);
  };
  viewer.onDraw = (statistics) => {
    onDraw(statistics);
    if (!pressed || waits.length === pictures.length) return;
    pictures.push(performance.now() - pressed);
    pressed = 0;
    if (pictures.length === times) done([waits, pictures, slices]);
    else setTimeout(press, 1500 + 137 * pictures.length);
  };
  press();
})
"""
FEWEST = 15  # pictures of an orbit
CANCELLED = 12  # pictures at rest
RENDERER = """
(() => {
  const gl = ringlet.viewer.renderer.getContext();
  return gl.getParameter(gl.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER);
})()
"""


def run(
    locks: int = 1389,
    per_lock: int = 36,
    points: int = 60,
    steps: int = 8,
    orbit_locks: int = 2778,
    seconds: float = 10,
) -> dict[str, Any]:
    """Drags the curl width of the example with a pointer ``steps`` times (0: not at all); orbits for some seconds.

    Each time [ms] is the median of the parts of a new picture:

    hand:     from the event of the pointer to the message of the page, with the wait for a picture in progress
    server:   the groom, as the server reports it
    transfer: the rest of the time until the page has the locks: queues, encoding and the socket
    page:     from there to the first picture that shows them

    Of a picture while the camera orbits:

    picture:  from the begin of a drawing until the graphics card reports it as done
    script:   the page's own share of that, also the least, and the most: with light that is computed again
    server:   processor time of the server in the same time

    Of a picture at rest that a key cuts short:

    begin:    from the key to the begin of the next picture, also the most
    picture:  from the key until that picture is done
    slice:    a slice of a picture at rest, the median and the most
    """
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)

        def opened(count: int) -> tuple[Server, Review]:
            place = Path(folder, str(count))  # a server restores what another left unsaved in its folder
            place.mkdir()
            server = Server(write_recipe(place, count, per_lock, points))
            server.start()
            page = browser.new_page(viewport={"width": 1280, "height": 800})
            page.set_default_timeout(600_000)
            review = Review(page, server.address)
            review.get(PROBE)
            return server, review

        times = {}
        if steps:
            server, review = opened(locks)
            try:
                times = {"hairs": review.get("ringlet.model.numbers.hairs"), **drag(review, steps)}
            finally:
                review.page.close()
                server.kill()
        server, review = opened(orbit_locks)
        try:
            review.until("drawn.length > 2", 600.0)  # shaders are compiled
            renderer, before = review.get(RENDERER), processor_ms(server)
            pictures, passed = review.page.evaluate(ORBIT, {"seconds": seconds, "least": FEWEST})
            drawn, scripts = review.get("drawn"), review.get("scripts")
            orbit = {
                "hairs": review.get("ringlet.model.numbers.hairs"),
                "pictures": pictures,
                "pictures_per_s": pictures / passed,
                "picture_ms": statistics.median([took for took, _ in drawn]),
                "script_ms": statistics.median(scripts),
                "least_script_ms": min(scripts),
                "most_script_ms": max(scripts),
                "server_ms": (processor_ms(server) - before) / pictures,
                "hairs_drawn": statistics.median([shown for _, shown in drawn]),
            }
            waits, shown, slices = review.page.evaluate(CANCEL, CANCELLED)
            cancel = {
                "begin_ms": statistics.median(waits),
                "most_begin_ms": max(waits),
                "picture_ms": statistics.median(shown),
                "slice_ms": statistics.median(slices),
                "most_slice_ms": max(slices),
                "slices": len(slices),
            }
        finally:
            server.kill()
    params = {"locks": locks, "per_lock": per_lock, "points": points, "steps": steps}
    params |= {"orbit_locks": orbit_locks, "seconds": seconds}
    return {"name": "page", "params": params, "renderer": renderer, **times, "orbit": orbit, "cancel": cancel}


def drag(review: Review, steps: int) -> dict[str, dict[str, float]]:
    """Drags the slider of the curl width and lets go, ``steps`` times; medians of the parts of each [ms]."""
    review.choose("curl")
    mouse, box = review.page.mouse, review.slider("curl.width").bounding_box()
    assert box
    height = box["y"] + box["height"] / 2
    found: dict[str, list[dict[str, float]]] = {"drag": [], "rest": []}
    for step in range(steps):
        at = box["x"] + box["width"] * (0.2 + 0.3 * step / steps)
        mouse.move(at, height)
        for kind in found:
            review.get(
                "(Object.keys(marks).forEach((name) => delete marks[name]), marks.rests = %s)"
                % ("true" if kind == "rest" else "false")
            )
            if kind == "drag":
                mouse.down()
                mouse.move(at + 4, height)
            else:
                mouse.up()
            review.until("marks.done && marks.server !== undefined", 600.0)
            found[kind].append(parts(review.get("marks")))
    return {
        kind: {part: statistics.median([one[part] for one in times]) for part in times[0]}
        for kind, times in found.items()
    }


def processor_ms(server: Server) -> float:
    """Processor time of a server so far, from /proc [ms]."""
    user, system = Path(f"/proc/{server.pid}/stat").read_text().rsplit(")", 1)[1].split()[11:13]
    return 1e3 * (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")


def parts(marks: dict[str, float]) -> dict[str, float]:
    """Parts of the time from the hand to the picture [ms]."""
    return {
        "whole": marks["done"] - marks["hand"],
        "hand": marks["said"] - marks["hand"],
        "server": marks["server"],
        "transfer": marks["came"] - marks["said"] - marks["server"],
        "page": marks["done"] - marks["came"],
    }
