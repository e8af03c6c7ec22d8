"""A quick drawing of curves for notebooks, as SVG: from the front and from the side, what is near in front."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

CURVES, POINTS = 400, 48  # drawn at most, and of each
SIZE, GAP = 240, 16  # height of the drawing, and space between both views [pixels]
SHADES = 8  # from far to near


def sketch(points: NDArray, offsets: NDArray) -> str:
    """An SVG of curves; of many a share that is evenly spaced.

    points:  positions [m], shape (n, 3)
    offsets: of the curves, shape (count + 1,)
    """
    count = len(offsets) - 1
    if not count:
        return ""
    chosen = np.unique(np.linspace(0, count - 1, min(count, CURVES)).astype(int))
    lines = [_thinned(points[offsets[row] : offsets[row + 1]]) for row in chosen]
    every = np.concatenate(lines)
    low, high = every.min(axis=0), every.max(axis=0)
    scale = SIZE / max(float((high - low).max()), 1e-9)
    width = scale * (high - low)
    views = [_view(lines, low, high, scale, axes) for axes in ((0, 1, 2), (2, 1, 0))]
    across = int(width[0] + GAP + width[2]) + 2
    moved = f'<g transform="translate({width[0] + GAP:.0f} 0)">{views[1]}</g>'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{across}" height="{int(width[1]) + 2}" fill="none">'
        f"{views[0]}{moved}</svg>"
    )


def _thinned(points: NDArray) -> NDArray:
    return points[np.unique(np.linspace(0, len(points) - 1, min(len(points), POINTS)).astype(int))]


def _view(lines: list[NDArray], low: NDArray, high: NDArray, scale: float, axes: tuple[int, int, int]) -> str:
    """Paths of one view, one for each shade, from far to near; ``axes`` go to the right, up and to the viewer."""
    across, up, near = axes
    depth = np.array([line[:, near].mean() for line in lines])
    shade = np.minimum(SHADES - 1, (SHADES * (depth - low[near]) / max(high[near] - low[near], 1e-9)).astype(int))
    parts = list[str]()
    for level in range(SHADES):
        places = (
            np.stack([scale * (line[:, across] - low[across]), scale * (high[up] - line[:, up])], axis=1) + 1.0
            for line, of in zip(lines, shade, strict=True)
            if of == level
        )
        path = "".join("M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in place.tolist()) for place in places)
        gray = 190 - 150 * level // (SHADES - 1)
        parts.append(f'<path d="{path}" stroke="rgb({gray},{gray},{gray})" stroke-width="0.7"/>')
    return "".join(parts)
