"""A plot of places on a head: three views with marks."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ringlet.data.files import replacing

COLORS = ("#d62728", "#ff7f0e", "#1f77b4", "#2ca02c")
VIEWS = {"front": (0, 1, 1.0), "side": (2, 1, 1.0), "top": (0, 2, -1.0)}  # horizontal axis, vertical axis and its sign


def write_places(
    body: NDArray, locks: NDArray, places: Mapping[str, NDArray], path: Path | str, title: str = ""
) -> None:
    """Writes a PNG with the points of a body and of locks in grey and marked places, in three views.

    body, locks: positions [m], shape (n, 3)
    places:      positions of marks by name [m], shape (n, 3) each
    """
    import matplotlib  # takes half a second, and few need it
    from matplotlib.figure import Figure

    matplotlib.rcParams["svg.hashsalt"] = "ringlet"
    figure = Figure(figsize=(13, 5), layout="constrained")
    figure.suptitle(title)
    for index, (view, (across, up, sign)) in enumerate(VIEWS.items()):
        axes = figure.add_subplot(1, 3, index + 1, aspect="equal", title=view)
        for points, color, size in ((body, "0.75", 1.0), (locks[::3], "0.55", 0.05)):
            axes.scatter(points[:, across], sign * points[:, up], s=size, c=color, linewidths=0)
        for color, (name, points) in zip(COLORS, places.items(), strict=False):
            marks = np.asarray(points).reshape(-1, 3)
            label = f"{name}: {len(marks)}" if index == 0 else None
            axes.scatter(marks[:, across], sign * marks[:, up], s=14, c=color, label=label, linewidths=0)
        axes.set_axis_off()
    figure.legend(loc="lower center", ncols=len(places))
    with replacing(path) as aside:
        figure.savefig(aside, dpi=110)
