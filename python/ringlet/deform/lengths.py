"""Lengths of hairs in motion, against those in the groom."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves

SAMPLE = 2000  # hairs that are measured


class HairLengths:
    """How much longer or shorter hairs get than they are at rest: of a sample of them, in the frames that are added.

    change: the largest fraction so far, at the hair ``hair`` (its index) in ``frame``
    """

    def __init__(self, rest: Curves) -> None:
        self._hairs = np.unique(np.linspace(0, len(rest) - 1, SAMPLE).astype(int)) if len(rest) else np.zeros(0, int)
        self._rows = np.concatenate(
            [np.arange(*rest.offsets[hair : hair + 2]) for hair in self._hairs] or [self._hairs]
        )
        self._ends = np.cumsum(rest.counts[self._hairs])[:-1] - 1  # edges from one hair to the next
        self._starts = np.concatenate([[0], self._ends + 1])
        self._lengths = self._measure(rest.points) if len(rest) else np.zeros(0)
        self.change, self.frame, self.hair = 0.0, 0.0, -1

    def add(self, frame: float, points: NDArray[np.floating]) -> None:
        """The positions of all points of hairs at a frame [m], shape (n, 3)."""
        if not len(self._hairs):
            return
        change = np.abs(self._measure(points) / self._lengths - 1.0)
        worst = int(change.argmax())
        if change[worst] > self.change:
            self.change, self.frame, self.hair = float(change[worst]), frame, int(self._hairs[worst])

    def _measure(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        edges = np.linalg.norm(np.diff(np.asarray(points[self._rows], np.float64), axis=0), axis=1)
        edges[self._ends] = 0.0
        return np.add.reduceat(edges, self._starts)
