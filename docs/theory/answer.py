"""Expected and computed results, as a drawing and as a table."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import matplotlib as mpl
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter
from numpy.typing import ArrayLike
from ringlet.data.files import replacing


@dataclass
class Panel:
    """A plot: lines by formula, and what Ringlet gives as dots. Both are x and y by what they are called."""

    x: str
    y: str
    exact: dict[str, tuple[ArrayLike, ArrayLike]]
    got: dict[str, tuple[ArrayLike, ArrayLike]]
    equal: bool = False
    log: bool = False


@dataclass
class Answer:
    """The panels of an energy, and rows of numbers: what it is, by formula, as Ringlet gives it."""

    panels: list[Panel]
    rows: list[tuple[str, float, float]] = field(default_factory=list)


def draw(answer: Answer, path: Path) -> None:
    """Lines are exact, dots are Ringlet's; the same colour belongs together."""
    count = len(answer.panels)
    figure = Figure(figsize=(5.2 * count, 3.4), layout="constrained")
    for axes, panel in zip(figure.subplots(1, count, squeeze=False)[0], answer.panels, strict=True):
        names = list(panel.exact | panel.got)
        colors = dict(zip(names, mpl.colormaps["viridis"].resampled(len(names) + 1).colors, strict=False))
        for name, (x, y) in panel.exact.items():
            axes.plot(x, y, lw=1.2, color=colors[name], label=name)
        for name, (x, y) in panel.got.items():
            axes.plot(x, y, "o", ms=3.5, mfc="none", color=colors[name], label=None if name in panel.exact else name)
        if panel.log:
            axes.set_xscale("log")
            axes.set_yscale("log")
            for axis in (axes.xaxis, axes.yaxis):
                axis.set_minor_formatter(NullFormatter())
        if panel.equal:
            axes.set_aspect("equal")
        axes.set_xlabel(panel.x, fontsize=9)
        axes.set_ylabel(panel.y, fontsize=9)
        axes.tick_params(labelsize=8)
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8, frameon=False)
    path.parent.mkdir(exist_ok=True)
    with replacing(path) as aside:
        figure.savefig(aside, metadata={"Date": None} if path.suffix == ".svg" else None)


def tell(answer: Answer, path: Path) -> None:
    """A row a number: by formula, as Ringlet gives it, how far apart."""
    lines = ["| | by formula | Ringlet | apart |", "|---|---|---|---|"]
    lines += [
        f"| {name} | {expected:.5g} | {got:.5g} | {abs(got / expected - 1):.1e} |"
        for name, expected, got in answer.rows
    ]
    path.parent.mkdir(exist_ok=True)
    with replacing(path) as aside:
        aside.write_text("\n".join(lines) + "\n")
