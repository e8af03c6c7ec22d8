"""Draws the figures that open the pages of explanation: strand, cloth, contact and speed, when the documents are built.

python docs/figures.py makes proof.png and pinch.png in docs/images, of the contact proof, which takes two minutes.
"""

from __future__ import annotations

import json
import sys
import tomllib
from pathlib import Path

import curl_types
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon
from ringlet.data.files import replacing
from ringlet.shot import Solver

RESULTS = Path(__file__).parents[1] / "bench" / "results"
RED, BLUE, GREY = "#8c3b2a", "#2a5b8c", "#9a9a9a"


def write_figures(folder: Path) -> None:
    """Writes an SVG for each of the figures."""
    for name, draw in {
        "strand": strand,
        "cloth": cloth,
        "contact": contact,
        "speed": speed,
        "curl_types": curl_types.figure,
    }.items():
        with replacing(folder / f"figure_{name}.svg") as aside:
            draw().savefig(aside)


def sketch(axes: Axes) -> None:
    """A drawing: no axes, equal scales."""
    axes.set_aspect("equal")
    axes.axis("off")


def arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float], color: str, style: str = "-|>") -> None:
    """An arrow from start to end."""
    axes.annotate("", end, start, arrowprops={"arrowstyle": style, "color": color, "shrinkA": 0, "shrinkB": 0})


def strand() -> Figure:
    """A lock and its polyline; the stretch of an edge, the bend of a corner and the twist between two directors."""
    figure = Figure(figsize=(11, 3.0), layout="constrained")
    panels = figure.subplots(1, 4, width_ratios=[1.1, 1, 1, 1.2])
    turn = np.linspace(0, 6 * np.pi, 37)
    panels[0].plot(0.15 * turn, np.sin(turn), color=GREY, lw=6, alpha=0.35, solid_capstyle="round")
    panels[0].plot(0.15 * turn, np.sin(turn), "o-", color=RED, ms=3, lw=1)
    panels[0].set_title("a lock is a polyline", fontsize=10)
    panels[1].plot([0, 2.2], [0.6, 0.6], "o--", color=GREY)
    panels[1].plot([0, 2.8], [0, 0], "o-", color=RED)
    panels[1].text(1.1, 0.7, "l̄", color=GREY, ha="center")
    panels[1].text(1.4, -0.35, "‖e‖", color=RED, ha="center")
    panels[1].set_title("stretch: length of an edge", fontsize=10)
    panels[2].plot([0, 1.5, 2.6], [0, 0, 1.0], "o-", color=RED)
    panels[2].plot([1.5, 2.9], [0, 0], ":", color=GREY)
    angle = np.linspace(0, np.arctan2(1.0, 1.1), 20)
    panels[2].plot(1.5 + 0.7 * np.cos(angle), 0.7 * np.sin(angle), color=BLUE)
    panels[2].text(2.35, 0.25, "θ", color=BLUE)
    panels[2].set_title("bend: turning angle at a corner", fontsize=10)
    panels[3].plot([0, 1.4, 2.8], [0, 0.35, 0], "o-", color=RED)
    arrow(panels[3], (0.7, 0.175), (0.5, 0.95), BLUE)
    arrow(panels[3], (2.1, 0.175), (2.7, 0.8), BLUE)
    arrow(panels[3], (2.1, 0.175), (2.2, 1.0), GREY)
    panels[3].text(0.25, 0.95, "D", color=BLUE)
    panels[3].text(2.75, 0.8, "next D", color=BLUE)
    panels[3].text(2.12, 1.05, "D, transported", color=GREY, ha="center", fontsize=9)
    panels[3].text(2.36, 0.62, "τ", color=BLUE, ha="center")
    panels[3].set_title("twist: angle between directors", fontsize=10)
    for axes, (left, right) in zip(panels, ((-0.2, 3.0), (-0.2, 3.0), (-0.2, 3.0), (-0.2, 3.2)), strict=True):
        sketch(axes)
        axes.set_xlim(left, right)
        axes.set_ylim(-1.3, 1.5)
    return figure


def cloth() -> Figure:
    """A triangle with warp and weft, at rest and deformed; the angle of a hinge."""
    figure = Figure(figsize=(9, 2.8), layout="constrained")
    panels = figure.subplots(1, 3)
    shapes = {"rest shape": ((0, 0), (2.0, 0.2), (0.7, 1.6)), "deformed": ((0, 0), (2.4, 0.5), (1.2, 1.5))}
    fibres = {"rest shape": ((0.8, 0.0), (0.0, 0.8)), "deformed": ((0.95, 0.18), (0.32, 0.74))}
    for axes, (title, corners) in zip(panels, shapes.items(), strict=False):
        axes.add_patch(Polygon(corners, facecolor="#f0e4df", edgecolor=RED))
        middle = np.mean(corners, axis=0) - 0.3
        for along, name in zip(fibres[title], ("warp", "weft"), strict=True):
            arrow(axes, tuple(middle), tuple(middle + along), BLUE)
            axes.text(*(middle + np.multiply(1.12, along)), name, color=BLUE, fontsize=9)
        axes.set_title(f"membrane: {title}", fontsize=10)
    hinge = panels[2]
    hinge.add_patch(Polygon(((0, 0), (1.8, 0.3), (-0.6, 1.2)), facecolor="#f0e4df", edgecolor=RED))
    hinge.add_patch(Polygon(((0, 0), (1.8, 0.3), (1.6, -1.1)), facecolor="#dfe7f0", edgecolor=RED))
    hinge.plot([0, 1.8], [0, 0.3], color=RED, lw=2.5)
    hinge.text(1.0, 0.32, "φ", color=BLUE, fontsize=12)
    hinge.set_title("hinge: angle over a common edge", fontsize=10)
    for axes in panels:
        sketch(axes)
        axes.autoscale_view()
        axes.margins(0.1, 0.15)
    return figure


def contact() -> Figure:
    """Two strands with their gap and activation distance, a limited move, and the barrier over the gap."""
    figure = Figure(figsize=(11, 3.2), layout="constrained")
    gap, limited, curve = figure.subplots(1, 3, width_ratios=[1, 1.1, 1])
    for x, color in ((0.0, RED), (2.3, BLUE)):
        gap.add_patch(Circle((x, 0), 1.35, facecolor=color, alpha=0.14, edgecolor="none"))
        gap.add_patch(Circle((x, 0), 1.35, fill=False, edgecolor=color, ls="--", lw=0.8))
        gap.plot([x], [0], "o", color=color, ms=6)
    arrow(gap, (0.08, 0), (2.22, 0), "black", "<|-|>")
    gap.text(1.15, 0.12, "gap g", ha="center", fontsize=9)
    arrow(gap, (0, 0), (-0.95, 0.95), RED)
    gap.text(-0.95, 1.0, "radius", color=RED, fontsize=9, ha="right")
    gap.set_title("two strands across: r is the sum of their radii", fontsize=10)
    limited.plot([0, 3.4], [0, 0], "o-", color=BLUE, lw=3)
    for height, style, color, note in (
        (1.9, "-", RED, "start"),
        (-1.0, ":", GREY, "search direction"),
        (0.3, "--", RED, "limited"),
    ):
        limited.plot([1.0, 2.6], [height, height], "o" + style, color=color)
        limited.text(2.75, height - 0.07, note, color=color, fontsize=9)
    arrow(limited, (1.8, 1.8), (1.8, 0.4), RED)
    limited.set_title("CCD limits each move before the impact", fontsize=10)
    g = np.linspace(0.01, 1.3, 400)
    onset, middle = 0.15, 0.925  # a and s = r − a/2, with r = 1
    phi = np.select(
        [g > 1, g > 1 - onset, g > 0.5 * middle],
        [0, (1 - g) ** 3 / (6 * onset), 0.5 * (middle - g) ** 2 + onset**2 / 24],
        -0.25 * middle**2 * (np.log(2 * g / middle) - 0.5) + onset**2 / 24,
    )
    curve.plot(g, phi, color=RED)
    for place in (0.5 * middle, 1 - onset, 1.0):
        curve.axvline(place, color=GREY, ls=":", lw=0.8)
    curve.set_xticks([0, 0.5 * middle, 1 - onset, 1], ["0", "s/2", "r − a", "r"])
    curve.set_yticks([])
    curve.set_xlabel("gap g", fontsize=9)
    curve.set_ylabel("barrier φ", fontsize=9)
    curve.set_title("a near pair repels", fontsize=10)
    for axes in (gap, limited):
        sketch(axes)
        axes.margins(0.15, 0.15)
    return figure


def proof() -> Figure:
    """Four contact scenes that are linked, at their start and at their end."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "tools" / "proof"))
    from contact_scenes import SCENES

    names = ("hooked_strands", "chain_of_loops", "wound_coils", "knotted_coils")
    figure = Figure(figsize=(11, 5.2), layout="constrained")
    panels = figure.subplots(2, len(names))
    for column, name in zip(panels.T, names, strict=True):
        trial = SCENES[name]()
        curves = trial.scene.strands.curves
        draw_strands(column[0], trial.scene.strands.positions, curves.offsets)
        column[0].set_title(name.replace("_", " "), fontsize=10)
        for k in range(1, trial.steps + 1):
            trial.step(k, Solver(newton=5))
        draw_strands(column[1], trial.scene.strands.positions, curves.offsets)
        column[1].set_title("at the end", fontsize=9, color=GREY)
    return figure


def pinch() -> Figure:
    """A ball goes into a head through the hair of one side; hair of the other side is as without the ball."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "tools" / "proof"))
    import pinches

    played, alone = pinches.ball("by itself"), pinches.ball(None)
    frames = (1, 9, 15, 21, 30)
    figure = Figure(figsize=(13, 2.0), layout="constrained")
    for axes, frame in zip(figure.subplots(1, len(frames), sharex=True, sharey=True), frames, strict=True):
        shift = 4e-3 * frame  # of the head along z, towards the viewer
        axes.add_patch(Circle((0, 0), pinches.RADIUS, color="#eee6de"))
        axes.add_patch(Circle((0.3 - 0.012 * min(frame, 30 - frame), 0), 0.05, fill=False, color=GREY))
        for scene, near, far in ((alone, "none", GREY), (played, RED, BLUE)):
            for k, lock in enumerate(scene.positions[frame - 1].reshape(2 * pinches.NEAR, -1, 3)):
                x, y = (lock - [0.0, 0.0, shift])[:, :2].T
                axes.plot(x, y, color=near if k < pinches.NEAR else far, lw=1.6 if scene is alone else 0.5)
        axes.set_title(f"frame {frame}", fontsize=9)
        axes.set(aspect="equal", xlim=(-0.16, 0.36), ylim=(-0.1, 0.1))
        axes.axis("off")
    return figure


def draw_strands(axes: Axes, points: np.ndarray, offsets: np.ndarray) -> None:
    """Strands in an oblique view, those in front over those behind."""
    view = points @ np.array([[1.0, 0.0], [0.0, 1.0], [-0.35, 0.25]])
    colors = (RED, BLUE, "#c07c3a", "#4d7f6d", "#6f5a8c")
    pieces = [
        (points[v : v + 2, 2].mean(), view[v : v + 2], colors[s % len(colors)])
        for s in range(len(offsets) - 1)
        for v in range(offsets[s], offsets[s + 1] - 1)
    ]
    for order, (_, piece, color) in enumerate(sorted(pieces, key=lambda piece: piece[0])):
        axes.plot(*piece.T, color="white", lw=4.5, zorder=2 * order, solid_capstyle="butt")
        axes.plot(*piece.T, color=color, lw=2, zorder=2 * order + 1, solid_capstyle="round")
    sketch(axes)


def speed() -> Figure:
    """CPU time of a step of the twirl scene against the number of wisps, with and without contact."""
    peers = tomllib.loads((RESULTS / "peers.toml").read_text())["compare"][0]
    figure = Figure(figsize=(7.5, 3.6), layout="constrained")
    axes = figure.subplots()
    for touches, style in ((True, "o-"), (False, "o--")):
        rows = [row for row in peers["row"] if ("in contact" in row["what"]) == touches]
        wisps = [int(row["what"].split(" wisps")[0].replace(" ", "")) for row in rows]
        ours = [
            json.loads((RESULTS / f"{row['result']}.json").read_text())["result"]["cpu_ms"]["median"] for row in rows
        ]
        note = "in contact" if touches else "no contact"
        axes.loglog(wisps, [row["peer"] for row in rows], style, color=GREY, ms=4, label=f"{peers['peer']}, {note}")
        axes.loglog(wisps, ours, style, color=RED, ms=4, label=f"Ringlet, {note}")
    axes.set_xticks([64, 256, 1024, 2048], ["64", "256", "1 024", "2 048"])
    axes.minorticks_off()
    axes.set_xlabel("wisps of 101 vertices", fontsize=9)
    axes.set_ylabel("CPU of a step [ms]", fontsize=9)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8, frameon=False)
    return figure


if __name__ == "__main__":
    for picture in (proof, pinch):
        picture().savefig(Path(__file__).parent / "images" / f"{picture.__name__}.png", dpi=80)
