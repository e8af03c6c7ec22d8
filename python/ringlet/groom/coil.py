"""The path of a rope of hair that is wound into a knot or a bun: up the middle, over the top, and down around itself.

In the local frame z is the axis, away from the head, and the head is the plane z = 0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

HALVINGS = 40  # of the rope's radius
SAMPLES = 64  # of a turn
OVER = 1.3  # how far the rope bends out over the top, in radii of its first winding
CREST = 1.6  # height of the knot over the middle of its first winding, in radii of the rope
TUCK_TURN = 0.5  # turns over which the end is tucked in


@dataclass(frozen=True)
class Coil:
    """A wound rope. Successive windings touch, unless the coil is too narrow for that.

    turns:        number of windings
    rope:         radius of the rope [m]
    inner, outer: distances of the first winding, at the top, and of the last from the axis [m]
    top:          height of the first winding [m]; the last lies on the head
    bulge:        0: the windings lie on a cone; 1: on a dome
    tuck:         distance that the end is led inwards under the windings [m]
    """

    turns: float
    rope: float
    inner: float
    outer: float
    top: float
    bulge: float
    tuck: float

    @classmethod
    def fitted(cls, width: float, height: float, turns: float, bulge: float = 0.5, tuck: float = 1.0) -> Coil:
        """The coil of a width, height [m] and number of turns whose windings touch, and a tuck of 0 to 1."""
        low, high = 0.0, min(width / 6.0, height / (CREST + 2.0))
        for _ in range(HALVINGS):
            rope = 0.5 * (low + high)
            coil = cls._of(rope, width, height, turns, bulge, tuck)
            if coil._meridian_length() >= 2.0 * rope * turns:
                low = rope
            else:
                high = rope
        return cls._of(low, width, height, turns, bulge, tuck)

    @classmethod
    def _of(cls, rope: float, width: float, height: float, turns: float, bulge: float, tuck: float) -> Coil:
        outer, inner = 0.5 * width - rope, 2.0 * rope
        room = max(0.0, min(2.0 * rope, outer - inner))
        return cls(turns, rope, inner, outer, height - CREST * rope, bulge, tuck * room)

    def path(self) -> NDArray[np.float64]:
        """The centre line of the rope from the head in the middle to the tucked end [m], shape (n, 3)."""
        turn = np.linspace(0.0, self.turns, int(SAMPLES * self.turns) + 1)
        radius, height = self._meridian(turn / self.turns)
        end = np.clip((turn - (self.turns - TUCK_TURN)) / TUCK_TURN, 0.0, 1.0)
        radius = radius - self.tuck * end * end * (3.0 - 2.0 * end)
        angle = 2.0 * np.pi * turn
        wound = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
        crest = self.top + 0.3 * self.rope
        core = np.linspace([0.0, 0.0, 0.0], [0.0, 0.0, crest - self.rope], SAMPLES)[:-1]
        over = _hermite(
            np.array([0.0, 0.0, crest - self.rope]),
            np.array([0.0, 0.0, OVER * self.inner]),
            wound[0],
            OVER * self.inner * (wound[1] - wound[0]) / np.linalg.norm(wound[1] - wound[0]),
        )
        return np.concatenate([core, over[:-1], wound])

    def _meridian(self, t: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Distance from the axis and height [m] of the winding's surface from its top (t = 0) to the head (1)."""
        fine = np.linspace(0.0, 1.0, SAMPLES + 1)
        radius, height = self._profile(fine)
        along = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(radius), np.diff(height)))])
        at = np.interp(t * along[-1], along, fine)
        return self._profile(at)

    def _profile(self, t: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        out = t + self.bulge * (np.sin(0.5 * np.pi * t) - t)
        down = t + self.bulge * (1.0 - np.cos(0.5 * np.pi * t) - t)
        return self.inner + (self.outer - self.inner) * out, self.top + (self.rope - self.top) * down

    def _meridian_length(self) -> float:
        radius, height = self._profile(np.linspace(0.0, 1.0, SAMPLES + 1))
        return float(np.hypot(np.diff(radius), np.diff(height)).sum())


def _hermite(start: NDArray, leaving: NDArray, end: NDArray, arriving: NDArray) -> NDArray[np.float64]:
    """Cubic from one point and tangent to another, shape (SAMPLES, 3)."""
    t = np.linspace(0.0, 1.0, SAMPLES)[:, None]
    return (
        (2 * t**3 - 3 * t**2 + 1) * start
        + (t**3 - 2 * t**2 + t) * leaving
        + (3 * t**2 - 2 * t**3) * end
        + (t**3 - t**2) * arriving
    )
