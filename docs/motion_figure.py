"""Draws the characters of motion when the documents are built: a lock of each preset in a hop.

python docs/motion_figure.py FILE.svg draws them alone, in some seconds.
"""

from __future__ import annotations

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from ringlet.data.curves import Curves
from ringlet.data.files import replacing
from ringlet.data.groom import Groom
from ringlet.motion import CoilLengths
from ringlet.shot import parse_shot
from ringlet.shot.motion_presets import PRESETS
from ringlet.sim.shot_strands import make_strands
from ringlet.validate.bounce import SHEET, lock

# The type of hair that each is shown on: braids and locs hang as wavy rods.
TYPES = ("3C", "3B", "3B", "4A", "2C", "2C", "4B")
FPS, SUBSTEPS, SECONDS, HOP, UP = (
    24,
    4,
    1.8,
    0.4,
    0.06,
)  # frames and steps, length of clip and of the hop [s], height [m]
PULL = 0.06  # of the hop sideways [m]
RED, GREY = "#8c3b2a", "#9a9a9a"
SHOT = f"""
ringlet = 2
groom = "lock.usdc"
frames = [1, 2]
[solver]
integrator = "bdf2"
substeps = {SUBSTEPS}
newton = 20
[motion]
preset = "%s"
"""


def moved(preset: str, kind: str) -> tuple[np.ndarray, np.ndarray]:
    """How far a lock opens from where it hangs [%], and how far its tip goes sideways from its root [mm], by frame."""
    locks = Curves.from_list([lock(kind).points])
    locks.curve |= {"root_triangle": np.zeros(1, np.int32), "root_barycentric": np.array([[1.0, 0.0, 0.0]])}
    shot = parse_shot(SHOT % preset)
    strands, lengths = make_strands(shot, Groom(locks, locks, SHEET)), CoilLengths(locks)
    strands.settle(gravity=shot.forces.gravity, tolerance=1e-6, dt=100.0, steps=40)
    at_rest = strands.positions.copy()
    strands.place(at_rest)
    time = np.arange(int(FPS * SECONDS) + 1) / FPS
    way = np.sin(np.pi * np.clip(time - 0.2, 0.0, HOP) / HOP) ** 2
    opened, aside, hop = [0.0], [0.0], np.array([PULL, UP, 0.0])
    for begin, end in pairwise(way):
        for part in (np.arange(SUBSTEPS) + 1) / SUBSTEPS:
            targets = locks.points + (begin + (end - begin) * part) * hop
            strands.step(targets, 1.0 / (FPS * SUBSTEPS), gravity=shot.forces.gravity, solver=shot.solver)
        opened.append(100.0 * (lengths.of(strands.positions)[0] / lengths.of(at_rest)[0] - 1.0))
        aside.append(1e3 * (strands.positions[-1, 0] - at_rest[-1, 0] - end * hop[0]))
    return np.array(opened), np.array(aside)


def write_motion(path: Path) -> None:
    """Writes the picture."""
    figure = Figure(figsize=(8.5, 4), layout="constrained")  # as wide as the page: letters keep their size
    panels = figure.subplots(2, len(PRESETS), sharex=True, sharey="row")
    for column, (preset, kind) in enumerate(zip(PRESETS, TYPES, strict=True)):
        for axes, values in zip(panels[:, column], moved(preset, kind), strict=True):
            time = np.arange(len(values)) / FPS
            axes.axhline(0.0, color=GREY, lw=0.6)
            axes.axvspan(0.2, 0.2 + HOP, color=GREY, alpha=0.15, lw=0)
            axes.plot(time, values, color=RED, lw=1.4)
            axes.tick_params(labelsize=9)
        panels[0, column].set_title("\n".join([*preset.split("_"), kind]), fontsize=10)
        panels[1, column].set_xlabel("s", fontsize=10)
    panels[0, 0].set_ylabel("opens [%]", fontsize=10)
    panels[1, 0].set_ylabel("tip aside [mm]", fontsize=10)
    with replacing(path) as aside:
        figure.savefig(aside)


if __name__ == "__main__":
    write_motion(Path(sys.argv[1]))
