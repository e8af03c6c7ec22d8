"""The head of live hair: taken by hand, let go, and in motions of its own."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ringlet.data.rigid import rotation_matrix, rotation_vector
from ringlet.data.smooth_step import smooth_step

Array = NDArray[np.float64]

FREQUENCY, DAMPING = 1.4, 0.4  # of the spring that brings back a head that is let go [Hz], relative to the critical one
SUBSTEPS = 16  # of the spring in a step
LONGEST = 0.5  # time that the spring goes on in one step [s]
FADE = 0.4  # of a motion that begins or ends anywhere [s]
LOOP = 0.5  # time in which a clip goes back to its first frame [s]

# A way to move: at a time [s] the rotation vector of the head [rad], and the shift of all of the body [m].
Moves = Callable[[float], tuple[Array, Array]]


@dataclass(frozen=True)
class Motion:
    """A motion of the head.

    seconds: after which it ends; infinite for one that goes on until it is stopped
    """

    seconds: float
    at: Moves


def _bell(t: float, seconds: float) -> float:
    """From 0 to 1 and back within some seconds, with no speed at its ends."""
    return math.sin(math.pi * min(max(t / seconds, 0.0), 1.0)) ** 2


def _nod(t: float) -> tuple[Array, Array]:
    return np.array([0.42 * (_bell(t, 0.8) + 0.8 * _bell(t - 0.8, 0.8)), 0.0, 0.0]), np.zeros(3)


def _turn(t: float) -> tuple[Array, Array]:
    return np.array([0.0, 0.8 * (_bell(t, 1.4) - _bell(t - 1.4, 1.4)), 0.0]), np.zeros(3)


def _shake(t: float) -> tuple[Array, Array]:
    return np.array([0.0, 0.4 * _bell(t, 1.8) * math.sin(2.0 * math.pi * 1.8 * t), 0.0]), np.zeros(3)


def _hop(t: float) -> tuple[Array, Array]:
    height = 0.09 * (_bell(t - 0.25, 0.5) + _bell(t - 0.95, 0.5)) - 0.025 * (_bell(t, 0.25) + _bell(t - 0.75, 0.2))
    return np.array([0.06 * (_bell(t, 0.3) + _bell(t - 0.7, 0.3)), 0.0, 0.0]), np.array([0.0, height, 0.0])


def _walk(t: float) -> tuple[Array, Array]:
    """At 1.8 steps a second: up and down with each, from side to side with two."""
    step = 2.0 * math.pi * 1.8 * t
    turn = np.array([0.03 * math.sin(step), 0.05 * math.sin(0.5 * step), 0.03 * math.sin(0.5 * step)])
    return turn, np.array([0.012 * math.sin(0.5 * step), 0.02 * (math.cos(step) - 1.0), 0.0])


MOTIONS = {
    "nod": Motion(1.6, _nod),
    "turn": Motion(2.8, _turn),
    "shake": Motion(1.8, _shake),
    "hop": Motion(1.5, _hop),
    "walk": Motion(math.inf, _walk),
}


def clip_motion(transforms: Array, pivot: Array, fps: float) -> Motion:
    """The rigid motions of a clip in a loop, whose end goes over to its start.

    transforms: shape (frames, 4, 4)
    pivot:      of the head [m]
    """
    count, back = len(transforms), max(1, round(LOOP * fps))
    turns = np.array([rotation_vector(transform[:3, :3]) for transform in transforms])
    shifts = transforms[:, :3, :3] @ pivot + transforms[:, :3, 3] - pivot

    def at(t: float) -> tuple[Array, Array]:
        frame = (t * fps) % (count - 1 + back) if count > 1 else 0.0
        if frame <= count - 1:
            first = min(int(frame), max(count - 2, 0))
            share, ends = frame - first, (first, min(first + 1, count - 1))
        else:
            share, ends = smooth_step((frame - count + 1) / back), (count - 1, 0)
        turn, shift = ((1.0 - share) * of[ends[0]] + share * of[ends[1]] for of in (turns, shifts))
        return turn, shift

    return Motion(math.inf, at)


@dataclass
class _Playing:
    motion: Motion
    time: float = 0.0
    ends: float = math.inf  # when one that goes on has been stopped

    @property
    def over(self) -> bool:
        return self.time >= min(self.motion.seconds, self.ends + FADE)

    def now(self) -> tuple[Array, Array]:
        turn, shift = self.motion.at(self.time)
        if self.motion.seconds < math.inf:
            return turn, shift
        share = smooth_step(self.time / FADE) * (1.0 - smooth_step((self.time - self.ends) / FADE))
        return share * turn, share * shift


@dataclass
class Head:
    """A head on its neck.

    pivot: about which it turns, as groomed [m]
    turn:  rotation vector by the hand [rad]; shift: of all of the body by the hand [m]

    The rest of its pose is that of the motions that play, whose rotation vectors add up.
    """

    pivot: Array
    turn: Array = field(default_factory=lambda: np.zeros(3))
    shift: Array = field(default_factory=lambda: np.zeros(3))

    def __post_init__(self) -> None:
        self._speed = np.zeros(6)
        self._held = False
        self._playing: dict[str, list[_Playing]] = {}

    def hold(self, turn: Array, shift: Array) -> None:
        """A hand has the head in a pose."""
        self._held, self.turn, self.shift, self._speed = True, turn, shift, np.zeros(6)

    def let_go(self) -> None:
        """The hand lets go: the head returns as on a spring."""
        self._held = False

    def play(self, name: str, motion: Motion) -> None:
        """Plays a motion; one that goes on is stopped instead where it plays."""
        playing = self._playing.setdefault(name, [])
        going_on = [one for one in playing if one.motion.seconds == one.ends == math.inf]
        for one in going_on:
            one.ends = one.time
        if not going_on:
            playing.append(_Playing(motion))

    def advance(self, seconds: float) -> None:
        """Time goes on."""
        for name, playing in self._playing.items():
            for one in playing:
                one.time += seconds
            self._playing[name] = [one for one in playing if not one.over]
        if not self._held:
            self._spring(min(seconds, LONGEST))

    def _spring(self, seconds: float) -> None:
        h, omega = seconds / SUBSTEPS, 2.0 * math.pi * FREQUENCY
        pose = np.concatenate([self.turn, self.shift])
        for _ in range(SUBSTEPS):
            self._speed += h * (-(omega**2) * pose - 2.0 * DAMPING * omega * self._speed)
            pose = pose + h * self._speed
        self.turn, self.shift = pose[:3], pose[3:]

    @property
    def trunk(self) -> Array:
        """The shift of what is below the neck [m]."""
        return self.shift + sum((one.now()[1] for one in self._all), np.zeros(3))

    @property
    def transform(self) -> Array:
        """The rigid motion of the head since it was groomed, shape (4, 4)."""
        turn = self.turn + sum((one.now()[0] for one in self._all), np.zeros(3))
        matrix = np.eye(4)
        matrix[:3, :3] = rotation_matrix(turn)
        matrix[:3, 3] = self.pivot + self.trunk - matrix[:3, :3] @ self.pivot
        return matrix

    @property
    def _all(self) -> list[_Playing]:
        return [one for playing in self._playing.values() for one in playing]
