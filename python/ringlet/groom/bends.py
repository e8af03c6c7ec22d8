"""Bends of a braid's centre line, which are sharp where strands on their inner side run backwards."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.groom.operators.operator import evenly

MOST_TURN = 0.75  # [rad] over half a braid's width: strands on the inner side then run back by at most their own width
PASSES = 1000  # of smoothing


def eased(line: NDArray[np.float64], reach: NDArray[np.float64]) -> NDArray[np.float64]:
    """A centre line (points, 3) of even spacing [m], smoothed where it turns by over ``MOST_TURN`` within ``reach``.

    reach: half the width of the braid at each point [m], shape (points,). Both ends stay, and gentle bends do
    """
    for _ in range(PASSES):
        sharp = _sharp(line, reach)
        if not sharp.any():
            break
        smooth = line.copy()
        smooth[1:-1] = 0.25 * (line[:-2] + line[2:]) + 0.5 * line[1:-1]
        line = evenly(np.where(sharp[:, None], smooth, line), len(line))
    return line


def _sharp(line: NDArray[np.float64], reach: NDArray[np.float64]) -> NDArray[np.bool_]:
    """The points within ``reach`` of a bend that is too sharp for it, shape (points,)."""
    edges = np.diff(line, axis=0)
    length = np.linalg.norm(edges, axis=1)
    along = edges / np.maximum(length, 1e-12)[:, None]
    angle = np.arccos(np.clip(np.einsum("ni,ni->n", along[1:], along[:-1]), -1.0, 1.0))
    turned = np.concatenate([[0.0, 0.0], np.cumsum(angle), [angle.sum()]])  # before each point
    at, count = np.arange(len(line)), len(line)
    window = np.maximum(np.rint(reach / max(float(length.mean()), 1e-12)).astype(int), 1)
    first, last = np.maximum(at - window // 2, 0), np.minimum(at - window // 2 + window, count)
    too_sharp = turned[last] - turned[first] > MOST_TURN
    found = np.concatenate([[0], np.cumsum(too_sharp)])
    return found[np.minimum(at + window + 1, count)] > found[np.maximum(at - window, 0)]
