"""Draws what the documents show from runs: errors of the known answers, and strands that are let go far from rest."""

from __future__ import annotations

import json
import re
import sys
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from ringlet.data.curves import Curves
from ringlet.data.files import replacing
from ringlet.shot import Material
from ringlet.sim import Strands

from ringlet import validate

sys.path.insert(0, str(Path(__file__).parents[1] / "tools" / "proof"))
from releases import PRESCRIBED, scenes

RESULTS = Path(__file__).parents[1] / "bench" / "results"
FRAMES = RESULTS / "frames.json"
TIPS = RESULTS / "tips_threads_1.json"
LIVE = RESULTS / "live_locks_300_threads_1.json"
SERIAL = RESULTS / "serial_turns_3.json"
AT_ONE_RESOLUTION = {"plucked-coil", "bounce", "friction", "push", "nest"}  # cases without a panel, which take long
RESOLUTION = re.compile(r"(?P<curve>.*), (?P<n>\d+) (edges|vertices a turn)$")


def errors(case: validate.Case) -> dict[str, list[tuple[int, float]]]:
    """Of every quantity that a case computes at several resolutions: each with its relative error."""
    lines: dict[str, list[tuple[int, float]]] = defaultdict(list)
    for row in case.run():
        if match := RESOLUTION.match(row.case):
            lines[match["curve"]].append((int(match["n"]), row.error))
    return lines


def write_convergence(path: Path) -> None:
    """One panel a case: relative error against edges or vertices a turn, one line a quantity; dotted, second order."""
    runs = {name: errors(case) for name, case in validate.CASES.items() if name not in AT_ONE_RESOLUTION}
    figure = Figure(figsize=(11, 2.7 * ((len(runs) + 2) // 3)), layout="constrained")
    panels = figure.subplots((len(runs) + 2) // 3, 3, squeeze=False).ravel()
    for panel, (title, lines) in zip(panels, runs.items(), strict=False):
        colors = mpl.colormaps["viridis"].resampled(len(lines) + 1)
        for k, (name, points) in enumerate(lines.items()):
            n, error = zip(*points, strict=True)
            panel.loglog(n, error, "o-", ms=3, lw=1, color=colors(k), label=name)
        n = sorted({n for points in lines.values() for n, _ in points})
        worst = max(error for points in lines.values() for _, error in points)
        panel.loglog(n, [2 * worst * (n[0] / m) ** 2 for m in n], ":", color="gray")
        panel.set_title(title, fontsize=10)
        panel.set_xticks(n, [str(m) for m in n], minor=False)
        panel.minorticks_off()
        panel.tick_params(labelsize=7)
        panel.grid(alpha=0.3)
    for panel in panels[len(runs) :]:
        panel.remove()
    figure.supxlabel("edges, or vertices a turn", fontsize=9)
    figure.supylabel("relative error", fontsize=9)
    with replacing(path) as aside:
        figure.savefig(aside)


@contextmanager
def chart(path: Path, across: str, up: str) -> Iterator[Axes]:
    """Axes with the names of what they show, to be drawn into; writes them to a file."""
    figure = Figure(figsize=(8, 3.4), layout="constrained")
    axes = figure.subplots()
    yield axes
    axes.set_xlabel(across, fontsize=9)
    axes.set_ylabel(up, fontsize=9)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8, frameon=False)
    with replacing(path) as aside:
        figure.savefig(aside)


def write_memory(path: Path) -> None:
    """Resident memory over the frames of a long shot and of its hairs, and what all frames together would take."""
    result = json.loads(FRAMES.read_text())["result"]
    frames = np.arange(len(result["megabytes"])) * result["params"]["every"] + 1
    all_kept = result["megabytes"][0] + frames / result["params"]["frames"] * result["megabytes_of_checkpoints"]
    with chart(path, "frame", "resident memory [MB]") as axes:
        axes.plot(frames, result["megabytes"], color="#8c3b2a", label="while it is simulated")
        axes.plot(frames, result["megabytes_hairs"], color="#2a5b8c", label="then, while its hairs are written")
        axes.plot(frames, all_kept, ":", color="gray", label="simulated with all frames kept (reckoned)")
        axes.set_ylim(0, None)


def write_tips(path: Path) -> None:
    """How far the median tip is from its place in the first frame: without contact, converged, and at settings."""
    result = json.loads(TIPS.read_text())["result"]
    frames = 1 + np.arange(len(result["free_mm"]))
    colors = mpl.colormaps["viridis"].resampled(len(result["trials"]) + 1)
    with chart(path, "frame", "distance of the median tip [mm]") as axes:
        axes.plot(frames, result["free_mm"], ":", color="gray", lw=1.5, label="without contact")
        axes.plot(frames, result["converged_mm"], color="black", lw=2.5, alpha=0.6, label="converged")
        for k, trial in enumerate(result["trials"]):
            axes.plot(frames, trial["tips_mm"], color=colors(k), lw=1.2, label=f"{trial['iterations']} iterations")
        axes.set_ylim(0, None)


def write_live_tips(path: Path) -> None:
    """How the median tip moves in the nod, live and in a shot in contact, along the line on which it moves most."""
    tips = json.loads(LIVE.read_text())["result"]["tips_mm"]
    frames = 1 + np.arange(len(tips["shot"]))
    with chart(path, "frame", "motion of the median tip [mm]") as axes:
        axes.plot(frames, tips["shot"], color="black", lw=2.5, alpha=0.6, label="in contact, 12 iterations")
        axes.plot(frames, tips["default"], "--", color="#2a5b8c", lw=1.2, label="live, by default")
        axes.plot(frames, tips["calibrated"], color="#8c3b2a", lw=1.5, label="live, calibrated")


def write_speed_up(path: Path) -> None:
    """The speed-up of a step by workers: of the model, as measured with two threads, and without serial parts."""
    scenes = json.loads(SERIAL.read_text())["result"]["scenes"]
    workers = [1, *map(int, next(iter(scenes.values()))["speed_up"])]
    with chart(path, "workers", "speed-up of a step") as axes:
        for color, (name, scene) in zip(("#8c3b2a", "#2a5b8c"), scenes.items(), strict=True):
            axes.plot(
                workers, [1, *scene["speed_up"].values()], "o-", ms=3, lw=1.5, color=color, label=f"{name}, model"
            )
            axes.plot(2, scene["measured_2"], "x", ms=8, mew=2, color=color, label=f"{name}, two threads measured")
        axes.plot(workers, workers, ":", color="gray", label="without serial parts")
        axes.set_xscale("log", base=2)
        axes.set_xticks(workers, [str(count) for count in workers])
        axes.set_ylim(1, 1.2 * max(max(scene["speed_up"].values()) for scene in scenes.values()))


RELEASED = {
    "right-handed coil, 12 vertices a turn, jitter 1 cm": "jitter, 1 cm",
    "right-handed coil, 12 vertices a turn, straightened": "straightened",
    "right-handed coil, 12 vertices a turn, flattened": "flattened",
    "right-handed coil, 12 vertices a turn, compressed": "compressed",
    "zigzag, jitter 0.5 cm": "zigzag, jitter 0.5 cm",
    "coil with straight middle, jitter 0.5 cm": "straight middle",
}


def write_release(path: Path) -> None:
    """One column a scene of the stability table, one row a moment, from the side; gray: the rest shape."""
    steps = (0, 2, 12, 48, 300)
    chosen = [(rest, start) for name, rest, start in scenes() if name in RELEASED]
    rest = Curves.from_list([shape for shape, _ in chosen])
    strands = Strands(rest, Material(), PRESCRIBED)
    strands.place(np.concatenate([start for _, start in chosen]))
    figure = Figure(figsize=(11, 11), layout="constrained")
    panels = figure.subplots(len(steps), len(chosen), sharey="col")
    for row, before, step in zip(panels, (0, *steps), steps, strict=False):
        for _ in range(before, step):
            strands.step(rest.points, 1 / 24)
        now = rest.with_points(strands.positions)
        for k, panel in enumerate(row):
            panel.plot(*(100 * rest[k][:, :2].T), color="lightgray", lw=1.5)
            panel.plot(*(100 * now[k][:, :2].T), color="#8c3b2a", lw=0.8)
            panel.set_aspect("equal", adjustable="datalim")
            panel.tick_params(labelsize=6)
        row[0].set_ylabel(f"{step} steps" if step else "let go", fontsize=9)
    for panel, title in zip(panels[0], RELEASED.values(), strict=True):
        panel.set_title(title, fontsize=9)
    with replacing(path) as aside:
        figure.savefig(aside)
