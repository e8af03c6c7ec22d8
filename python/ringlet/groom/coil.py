"""The path of a rope of hair that is wound into a knot or a bun: up the middle, over the top, and down around itself.

In the local frame z is the axis, away from the head, and the head is the plane z = 0.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ringlet.groom.scalp import Scalp

HALVINGS = 40  # of the rope's radius
SAMPLES = 64  # of a turn
BEND = 0.8  # radius of the bend over the top, in radii of the rope
INNER = 2.0  # distance of the first winding from the axis, in radii of the rope: it touches what rises in the middle
TUCK_TURN = 0.5  # turns over which the end is tucked in
TUCKS = 24  # steps of its search


@dataclass(frozen=True)
class Coil:
    """A wound rope. Successive windings touch, unless the coil is too narrow for that.

    turns:        number of windings
    rope:         radius of the rope [m]
    outer, top:   distance of the last winding from the axis, and height of the first [m]; the last lies on the head
    bulge:        0: the windings lie on a cone; 1: on a dome
    tuck:         distance that the end is led inwards under the windings [m]
    """

    turns: float
    rope: float
    outer: float
    top: float
    bulge: float
    tuck: float = 0.0

    @classmethod
    def fitted(cls, width: float, height: float, turns: float, bulge: float = 0.5, tuck: float = 1.0) -> Coil:
        """The coil of a width, height [m] and number of turns whose windings touch.

        tuck: 0 leaves the end on the outside, 1 leads it as far inwards as the windings above leave room
        """
        low, high = 0.0, min(0.5 * width / (1.0 + INNER), height / 3.0)
        for _ in range(HALVINGS):
            rope = 0.5 * (low + high)
            coil = cls(turns, rope, 0.5 * width - rope, height - rope, bulge)
            if coil._meridian_length() >= 2.0 * rope * turns:
                low = rope
            else:
                high = rope
        coil = cls(turns, low, 0.5 * width - low, height - low, bulge)
        return replace(coil, tuck=tuck * coil._most_tuck())

    @property
    def rise(self) -> float:
        """Length of the path up to its first winding [m]."""
        bend, eye, first = self._crest()
        return self.top - bend + 0.5 * np.pi * bend + first * eye

    def _crest(self) -> tuple[float, float, float]:
        """Radius of the bend over the top, of the circle on from there to the first winding, and angle there [rad]."""
        bend, inner = BEND * self.rope, INNER * self.rope
        eye = (inner * inner - bend * bend) / (2.0 * inner)  # tangent to the bend, and from within to the winding
        return bend, eye, float(np.arctan2(bend, -eye))

    def path(self) -> NDArray[np.float64]:
        """The centre line of the rope from the head in the middle to the tucked end [m], shape (n, 3)."""
        bend, eye, first = self._crest()
        core = np.linspace([0.0, 0.0, 0.0], [0.0, 0.0, self.top - bend], SAMPLES)[:-1]
        t = np.linspace(0.0, 0.5 * np.pi, SAMPLES)[:-1]
        over = np.stack([0.0 * t, bend * (1.0 - np.cos(t)), self.top - bend + bend * np.sin(t)], axis=1)
        t = np.linspace(0.0, first, SAMPLES)[:-1]
        around = np.stack([eye * (np.cos(t) - 1.0), bend + eye * np.sin(t), self.top + 0.0 * t], axis=1)
        turn = np.linspace(0.0, self.turns, int(SAMPLES * self.turns) + 1)
        distance, height = self._meridian(turn, self.tuck)
        angle = first + 2.0 * np.pi * turn
        wound = np.stack([distance * np.cos(angle), distance * np.sin(angle), height], axis=1)
        return np.concatenate([core, over, around, wound])

    def _meridian(self, turn: NDArray, tuck: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Distance from the axis and height [m] after a number of turns from the top."""
        fine = np.linspace(0.0, 1.0, SAMPLES + 1)
        distance, height = self._profile(fine)
        along = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(distance), np.diff(height)))])
        distance, height = self._profile(np.interp(turn / self.turns * along[-1], along, fine))
        end = np.clip((turn - (self.turns - TUCK_TURN)) / TUCK_TURN, 0.0, 1.0)
        return distance - tuck * end * end * (3.0 - 2.0 * end), height

    def _profile(self, t: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        inner = INNER * self.rope
        out = t + self.bulge * (np.sin(0.5 * np.pi * t) - t)
        down = t + self.bulge * (1.0 - np.cos(0.5 * np.pi * t) - t)
        return inner + (self.outer - inner) * out, self.top + (self.rope - self.top) * down

    def _meridian_length(self) -> float:
        distance, height = self._profile(np.linspace(0.0, 1.0, SAMPLES + 1))
        return float(np.hypot(np.diff(distance), np.diff(height)).sum())

    def _most_tuck(self) -> float:
        """How far the end can be led inwards [m] without coming nearer to the windings above or in the middle."""
        most = max(0.0, min(2.0 * self.rope, self.outer - INNER * self.rope))
        turn = self.turns - TUCK_TURN * np.linspace(1.0, 0.0, SAMPLES)
        above, height_above = self._meridian(turn - 1.0, 0.0)
        for tuck in np.linspace(most, 0.0, TUCKS):
            distance, height = self._meridian(turn, tuck)
            if np.hypot(distance - above, height - height_above).min() >= 1.96 * self.rope:
                return float(tuck)
        return 0.0


def on_scalp(line: NDArray, base: NDArray, up: NDArray, scalp: Scalp) -> NDArray[np.float64]:
    """A line (n, 3) in the local frame of a coil, placed with its axis along a unit direction over a base [m].

    Heights are those over the scalp below each point, so that windings lie on a curved head.
    """
    foot, _ = scalp.nearest(base[None])
    across = np.cross(up, np.eye(3)[np.abs(up).argmin()])
    across /= np.linalg.norm(across)
    flat = foot[0] + line[:, :1] * across + line[:, 1:2] * np.cross(up, across)
    above = np.asarray(scalp.solid.above(np.ascontiguousarray(flat))[0])
    placed: NDArray[np.float64] = flat + (line[:, 2] - above)[:, None] * up
    return placed
