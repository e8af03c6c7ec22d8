"""The words of a shot's motion as a table and as a plot."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.extras import need
from ringlet.data.files import replacing
from ringlet.data.motion import MotionWords, Word

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PERCENTILES = {"10 %": 10.0, "median": 50.0, "90 %": 90.0}
OPTIONAL = "asked", "found"  # kinds of values that there need not be


def columns(motion: MotionWords) -> list[str]:
    """Columns of the table: percentiles over the locks of a group, and medians of what was asked and of the locks by
    themselves."""
    asked, found = (any(getattr(word, kind).size for word in motion.words) for kind in OPTIONAL)
    before = ["asked"] if asked else []
    after = [f"found, {name}" for name in PERCENTILES] if found else []
    return ["group", "word", *before, *PERCENTILES, "by itself", *after]


def rows(motion: MotionWords) -> list[list[str]]:
    """A row of each word of each group."""
    asked, found = (any(getattr(word, kind).size for word in motion.words) for kind in OPTIONAL)
    return [
        [
            word.group,
            f"{word.name} [{word.unit or '%'}]",
            *(_percentiles(word, word.asked)[1:2] if asked else []),
            *_percentiles(word, word.shown),
            _percentiles(word, word.by_itself)[1],
            *(_percentiles(word, word.found) if found else []),
        ]
        for word in motion.words
    ]


def _percentiles(word: Word, values: NDArray[np.float64]) -> list[str]:
    """Percentiles of the values that there are, as text."""
    known = values[~np.isnan(values)] * (1.0 if word.unit else 100.0)
    return [f"{of:.3g}" for of in np.percentile(known, [*PERCENTILES.values()])] if known.size else [""] * 3


def plain(motion: MotionWords) -> list[dict[str, Any]]:
    """The same as plain values, fractions as such."""

    def numbers(values: NDArray[np.float64]) -> list[float] | None:
        known = values[~np.isnan(values)]
        return np.percentile(known, [*PERCENTILES.values()]).tolist() if known.size else None

    return [
        {"group": word.group, "word": word.name, "unit": word.unit}
        | {name: numbers(getattr(word, name)) for name in ("asked", "shown", "by_itself", "found")}
        for word in motion.words
    ]


def write_plot(motion: MotionWords, path: Path, title: str) -> None:
    """Draws the distribution of each word over the locks of each group: a row a group, a panel a word."""
    need("matplotlib")
    from matplotlib.figure import Figure  # takes half a second, and few need it

    groups = list(dict.fromkeys(word.group for word in motion.words))
    names = list(dict.fromkeys(word.name for word in motion.words))
    figure = Figure(figsize=(2.9 * len(names), 2.2 * len(groups) + 0.6), layout="constrained")
    panels = figure.subplots(len(groups), len(names), squeeze=False)
    for word in motion.words:
        axes = panels[groups.index(word.group), names.index(word.name)]
        _draw(axes, word)
        axes.set_xlabel(f"{word.name} [{word.unit or '%'}]", fontsize=9)
        if word.name == names[0]:
            axes.set_ylabel(f"{word.group}: part of the locks", fontsize=9)
        axes.tick_params(labelsize=8)
    panels[0, 0].legend(fontsize=8, frameon=False)
    figure.suptitle(title, fontsize=10)
    with replacing(path) as aside:
        figure.savefig(aside, dpi=120)


def _draw(axes: Axes, word: Word) -> None:
    """Histograms of a word, as steps of one colour a kind."""
    kinds = {"shown": "#2a6f97", "by itself": "#999999", "found": "#bc4749"}
    values = {name: getattr(word, name.replace(" ", "_")) * (1.0 if word.unit else 100.0) for name in kinds}
    known = {name: of[np.isfinite(of)] for name, of in values.items()}
    if not (everything := np.concatenate([*known.values()])).size:
        return
    low, high = np.percentile(everything, [1.0, 99.0])
    bins = np.linspace(low, max(high, low + 1e-9), 31)
    for name, of in known.items():
        if of.size:
            axes.hist(
                of.clip(low, high),
                bins=bins,
                weights=np.full(of.size, 1.0 / of.size),
                histtype="step",
                color=kinds[name],
                label=name,
            )
