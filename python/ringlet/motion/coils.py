"""How far coils open and close, and the vibration that this shows."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.motion.stepping import SETTLED, shown_by_itself

Array = NDArray[np.float64]

PADDED = 8  # length of a spectrum, in lengths of its lock
LEAST_FRAMES = 12  # in which a vibration can be found, and in which it can be seen to settle
CALM = 0.5  # acceleration of a root that no longer drives a vibration [m/s²]
STILL = 1e-4  # change of a lock's length, relative to it, in which none can


class CoilLengths:
    """Lengths of locks along their coils: of the curve that remains when each turn is averaged.

    This curve is the mean over the vertices of a turn, so its edges are the chords across one turn by their number. A
    turn has the wavelength that is strongest in the second differences of the groomed lock.
    """

    def __init__(self, groomed: Curves) -> None:
        turns = np.array([_vertices_a_turn(groomed[row]) for row in range(len(groomed))])
        lock = np.repeat(np.arange(len(groomed)), groomed.counts)
        has_end = np.arange(len(lock)) + turns[lock] < groomed.offsets[lock + 1]
        self._begin, self._lock = np.flatnonzero(has_end), lock[has_end]
        self._turn = turns[self._lock]

    def of(self, points: NDArray[np.floating]) -> Array:
        """Lengths at positions [m] of shape (n, 3): [m], shape (count,)."""
        points = np.asarray(points, np.float64)
        chords = np.linalg.norm(points[self._begin + self._turn] - points[self._begin], axis=1)
        return np.bincount(self._lock, chords / self._turn).astype(np.float64)


def _vertices_a_turn(lock: NDArray[np.floating]) -> int:
    """The number of vertices in a turn; 1 for a lock of less than two turns."""
    bends = np.diff(lock.astype(np.float64), 2, axis=0)
    tapered = (bends - bends.mean(axis=0)) * np.hanning(len(bends))[:, None]
    power = np.sum(np.abs(np.fft.rfft(tapered, PADDED * len(lock), axis=0)) ** 2, axis=1)
    turns = power[: len(power) // 2].argmax() / PADDED
    return max(1, round(len(lock) / turns)) if turns >= 2.0 else 1


@dataclass
class SeenMotion:
    """What locks show over the frames of a simulation, shapes (count,).

    opens, closes: how much longer a lock is along its coil than it is groomed, at most and at least, as a fraction

    bounce: of the vibration along the lock [Hz], as in ``Words``; NaN where none is found
    settle: of that vibration once the root has come to rest [s], as in ``Words``; NaN where it does not for twelve
            frames
    """

    opens: Array
    closes: Array
    bounce: Array
    settle: Array


def seen_motion(
    groomed: Curves, frames: Iterable[NDArray[np.floating]], gravity: tuple[float, float, float], rate: float
) -> SeenMotion:
    """Measures the motion of locks in ``frames``: positions [m], shape (n, 3) each.

    gravity: [m/s²]
    rate:    frames a second

    The vibration is that of a damped spring which the acceleration of the root along the lock drives. Its length y
    under the load u is fitted by y₂ = a y₁ + b y₀ + c u₂ + d u₁ + e in least squares (an ARX model), and z² = a z + b.
    Its damping is not used: other modes and contact are noise, which makes it several times too large. The time to
    settle is that in which energy is lost after the last drive.
    """
    lengths, before, lasts = CoilLengths(groomed), groomed.offsets[:-1], groomed.offsets[1:] - 1
    rest, stretch, roots, axes = lengths.of(groomed.points), list[Array](), list[Array](), list[Array]()
    for points in frames:
        along = points[lasts].astype(np.float64) - points[before]
        stretch.append(lengths.of(points) / rest - 1.0)
        roots.append(points[before].astype(np.float64))
        axes.append(along / np.maximum(np.linalg.norm(along, axis=1), 1e-12)[:, None])
    y, places = np.array(stretch), np.array(roots)
    bounce, settle = np.full((2, len(groomed)), np.nan)
    if len(y) >= LEAST_FRAMES:
        accelerations = rate**2 * np.diff(places, 2, axis=0)
        load = np.einsum("kli,kli->kl", np.asarray(gravity) - accelerations, np.array(axes)[1:-1])
        driven = np.linalg.norm(accelerations, axis=2) > CALM
        calm = np.where(driven.any(axis=0), len(y) - 1 - driven[::-1].argmax(axis=0), 0)
        for lock in np.flatnonzero(np.ptp(y, axis=0) > STILL):
            bounce[lock] = _frequency(y[:, lock], load[:, lock], rate)
            free = y[calm[lock] :, lock]
            if len(free) >= LEAST_FRAMES and np.ptp(free) > STILL:
                settle[lock] = _settling(free) / rate
    return SeenMotion(y.max(axis=0), y.min(axis=0), bounce, settle)


def _frequency(y: Array, load: Array, rate: float) -> float:
    """Frequency [Hz] of a series under a load at its inner frames."""
    known = np.stack([y[1:-2], y[:-3], load[1:], load[:-1], np.ones(len(y) - 3)], axis=1)
    a, b = np.linalg.lstsq(known, y[2:-1], rcond=None)[0][:2]
    z = np.roots([1.0, -a, -b])
    return float(shown_by_itself(rate * np.log(z[np.abs(z).argmax()].astype(np.complex128)))[0])


def _settling(y: Array) -> float:
    """Frames in which a free vibration goes to a twentieth, by its energy from each frame to the end (Schroeder 1965).

    That integral has no ripples. Its logarithm falls along a line, which is fitted until a twentieth of it is left.
    """
    energy = np.cumsum(np.diff(y)[::-1] ** 2)[::-1]
    left = np.maximum(energy / energy[0], SETTLED**4)  # it may lie still at last
    below = np.flatnonzero(left < SETTLED)
    fall = np.log(left[: below[0] + 1 if below.size else None])
    return float(2.0 * np.log(SETTLED) / np.polyfit(np.arange(len(fall)), fall, 1)[0])
