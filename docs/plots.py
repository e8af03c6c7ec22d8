"""Draws the errors of the known answers against resolution, from a run of them."""

from __future__ import annotations

import re
from collections import defaultdict
from pathlib import Path

import matplotlib as mpl
from matplotlib.figure import Figure
from ringlet.files import replacing

from ringlet import validate

RESOLUTION = re.compile(r"(?P<curve>.*), (?P<n>\d+) (edges|vertices a turn)$")


def write_convergence(path: Path) -> None:
    """One panel a case: relative error against edges or vertices a turn, one line a quantity; dotted, second order."""
    cases = list(validate.CASES.values())
    figure = Figure(figsize=(11, 2.7 * ((len(cases) + 2) // 3)), layout="constrained")
    panels = figure.subplots((len(cases) + 2) // 3, 3, squeeze=False).ravel()
    for panel, case in zip(panels, cases, strict=False):
        lines: dict[str, list[tuple[int, float]]] = defaultdict(list)
        for row in case.run():
            if match := RESOLUTION.match(row.case):
                lines[match["curve"]].append((int(match["n"]), row.error))
        colors = mpl.colormaps["viridis"].resampled(len(lines) + 1)
        for k, (name, points) in enumerate(lines.items()):
            n, error = zip(*points, strict=True)
            panel.loglog(n, error, "o-", ms=3, lw=1, color=colors(k), label=name)
        n = sorted({n for points in lines.values() for n, _ in points})
        worst = max(error for points in lines.values() for _, error in points)
        panel.loglog(n, [2 * worst * (n[0] / m) ** 2 for m in n], ":", color="gray")
        panel.set_title(case.name, fontsize=10)
        panel.set_xticks(n, [str(m) for m in n], minor=False)
        panel.minorticks_off()
        panel.tick_params(labelsize=7)
        panel.grid(alpha=0.3)
    for panel in panels[len(cases) :]:
        panel.remove()
    figure.supxlabel("edges, or vertices a turn", fontsize=9)
    figure.supylabel("relative error", fontsize=9)
    with replacing(path) as aside:
        figure.savefig(aside)
