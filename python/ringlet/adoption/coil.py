"""Fits a coil to each lock: a smooth centre line, and the width, pitch and hand of the curl about it.

A lock is P(s) = C(s) + U(s) cos 2πNs + V(s) sin 2πNs, with s from root to tip, N turns, and cubic B-splines C, U and V
whose knots are farther apart than a turn. Given N the fit is linear (complex demodulation, in space). The spectrum of
the tangents proposes N; the least error among its neighbours decides.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline

from ringlet import _core

FEWEST_TURNS = 0.75  # below, a coil looks like a bend
POINTS_PER_TURN = 6.5  # fewest points of a turn that can be fitted
STEP = 1.03  # ratio of the numbers of turns that are tried
AROUND = 8  # steps up and down from the proposal
LEAST_GAIN = 0.35  # share of the deviation from a smooth line that a coil must explain
LEAST_SHARE = 0.5  # of the radius of a coil, by which a smooth line must miss the lock (root mean square)
LEAST_RADIUS = 2e-4  # [m] a narrower coil is frizz
LEAST_WIDTH = 0.085  # over the pitch: what winds less is a bend, and hardly longer than its line
ENDS = 0.12  # part of a lock at either end that is left out of the averages
LONGEST = 1.05  # centre line, relative to the lock that winds about it
PADDED = 8  # zero-padding of the spectrum

Array = NDArray[np.float64]


@dataclass
class Coils:
    """What was fitted to each lock.

    center: centre lines [m], shape (locks, points, 3), from the root on
    width:  diameter [m], shape (locks,); 0 for a lock without a coil
    pitch:  rise of a turn along the centre line [m], shape (locks,)
    hand:   1 for right-handed, -1 for left-handed, shape (locks,)
    turns:  number of turns, shape (locks,)
    around: points relative to the centre line [m], as fitted, shape (locks, points, 3)
    """

    center: Array
    width: Array
    pitch: Array
    hand: Array
    turns: Array
    around: Array

    @property
    def coiled(self) -> NDArray[np.bool_]:
        """Which locks have a coil, shape (locks,)."""
        return self.width > 0.0


def fit_coils(points: Array) -> Coils:
    """Fits coils to locks.

    points: evenly spaced by arc length [m], shape (locks, points, 3)
    """
    count, size, _ = points.shape
    most = size / POINTS_PER_TURN
    grid = FEWEST_TURNS * STEP ** np.arange(int(np.log(max(most / FEWEST_TURNS, 1.01)) / np.log(STEP)) + 1)
    proposal = np.searchsorted(grid, _proposed_turns(points, grid[-1]))
    best, error = np.zeros(count, np.int64), np.full(count, np.inf)
    for step in range(-AROUND, AROUND + 1):
        tried = np.clip(proposal + step, 0, len(grid) - 1)
        for which in np.unique(tried):
            rows = np.flatnonzero(tried == which)
            basis = np.concatenate(_bases(float(grid[which]), size), axis=1)
            left = np.linalg.norm(_residual(basis, points[rows]), axis=(1, 2))
            left *= _penalty(basis, size)
            better = left < error[rows]
            best[rows[better]], error[rows[better]] = which, left[better]
    center, around = np.empty_like(points), np.empty_like(points)
    for which in np.unique(best):
        rows = np.flatnonzero(best == which)
        smooth, coil = _bases(float(grid[which]), size)
        solved = np.linalg.lstsq(np.concatenate([smooth, coil], axis=1), _columns(points[rows]), rcond=1e-9)[0]
        center[rows] = _rows(smooth @ solved[: smooth.shape[1]], len(rows))
        around[rows] = _rows(coil @ solved[smooth.shape[1] :], len(rows))
    return _measured(points, center, around, np.asarray(grid[best], np.float64))


def no_coils(points: Array) -> Coils:
    """Locks as their own centre lines, without a curl."""
    count, none = len(points), np.zeros(len(points))
    return Coils(points, none, np.full(count, np.inf), np.ones(count), none, np.zeros_like(points))


def _proposed_turns(points: Array, most: float) -> Array:
    """Number of turns at which the spectrum of the tangents is strongest, shape (locks,)."""
    tangents = np.diff(points, axis=1)
    tangents = tangents / np.maximum(np.linalg.norm(tangents, axis=2, keepdims=True), 1e-12)
    size = tangents.shape[1]
    smooth = np.asarray(np.polynomial.legendre.legvander(np.linspace(-1, 1, size), 2), np.float64)
    bent = _residual(smooth, tangents) * np.hanning(size)[:, None]
    power = (np.abs(np.fft.rfft(bent, PADDED * size, axis=1)) ** 2).sum(axis=2)
    turns = np.arange(power.shape[1]) / PADDED
    power[:, (turns < FEWEST_TURNS) | (turns > most)] = 0.0
    return turns[power.argmax(axis=1)]


def _bases(turns: float, size: int) -> tuple[Array, Array]:
    """Values of the functions of C, shape (size, k), and of those of U and V times cosine and sine, shape (size, m)."""
    s = np.linspace(0.0, 1.0, size)
    smooth = _splines(s, _center_functions(turns))
    slow = _splines(s, round(turns / 2.0) + 2)
    phase = 2.0 * np.pi * turns * s[:, None]
    return smooth, np.concatenate([slow * np.cos(phase), slow * np.sin(phase)], axis=1)


def _center_functions(turns: float) -> int:
    """Number of the functions of C, whose knots are farther apart than a turn."""
    return round(turns / 1.5) + 3


def _splines(s: Array, count: int) -> Array:
    """Values of ``count`` B-splines, at most cubic, on even knots, shape (len(s), count)."""
    count = max(count, 2)
    degree = min(3, count - 1)
    knots = np.concatenate([np.zeros(degree), np.linspace(0.0, 1.0, count - degree + 1), np.ones(degree)])
    return BSpline.design_matrix(s, knots, degree).toarray()


def _penalty(basis: Array, size: int) -> float:
    """Factor on an error for the number of functions (generalised cross-validation)."""
    return 1.0 / max(1.0 - basis.shape[1] / size, 0.05)


def _residual(basis: Array, values: Array) -> Array:
    """What a least-squares fit of functions, shape (size, k), leaves of values (count, size, 3)."""
    orthonormal = np.linalg.qr(basis)[0]
    columns = _columns(values)
    return _rows(columns - orthonormal @ (orthonormal.T @ columns), len(values))


def _columns(values: Array) -> Array:
    return values.transpose(1, 0, 2).reshape(values.shape[1], -1)


def _rows(columns: Array, count: int) -> Array:
    return columns.reshape(len(columns), count, 3).transpose(1, 0, 2)


def _measured(points: Array, center: Array, around: Array, turns: Array) -> Coils:
    """Widths, pitches and hands of fitted coils; locks that a coil does not explain have none."""
    count, size, _ = points.shape
    frames = _frames(center)
    x, y = (np.einsum("lpk,lpk->lp", around, frames[..., axis]) for axis in (0, 1))
    inner = slice(int(ENDS * size), size - int(ENDS * size))
    angle = np.unwrap(np.arctan2(y, x), axis=1)[:, inner]
    run = _arc_length(center)
    along = run[:, inner]
    along = along - along.mean(axis=1, keepdims=True)
    slope = (along * (angle - angle.mean(axis=1, keepdims=True))).sum(axis=1) / (along**2).sum(axis=1)
    radius = np.hypot(x, y)[:, inner].mean(axis=1)
    line = _splines(np.linspace(0.0, 1.0, size), 4)
    straight = np.linalg.norm(_residual(line, points), axis=(1, 2))
    smooth = np.empty(count)
    for row in range(count):
        alone = _splines(np.linspace(0.0, 1.0, size), _center_functions(float(turns[row])))
        smooth[row] = np.linalg.norm(_residual(alone, points[row : row + 1]))
    left = np.linalg.norm(points - center - around, axis=(1, 2))
    unexplained = np.minimum(smooth, straight)
    coiled = (left < LEAST_GAIN * unexplained) & (radius > LEAST_RADIUS)
    coiled &= unexplained > LEAST_SHARE * radius * np.sqrt(size)
    coiled &= np.abs(slope) * run[:, -1] > 2.0 * np.pi * FEWEST_TURNS
    coiled &= run[:, -1] < LONGEST * np.linalg.norm(np.diff(points, axis=1), axis=2).sum(axis=1)
    pitch = 2.0 * np.pi / np.maximum(np.abs(slope), 1e-6)
    coiled &= 2.0 * radius > LEAST_WIDTH * pitch
    center = np.where(coiled[:, None, None], center, points)
    return Coils(
        _rooted(center, points[:, 0], pitch),
        np.where(coiled, 2.0 * radius, 0.0),
        np.where(coiled, pitch, np.inf),
        np.where(slope >= 0.0, 1.0, -1.0),
        np.where(coiled, run[:, -1] / pitch, 0.0),
        np.where(coiled[:, None, None], around, 0.0),
    )


def _arc_length(lines: Array) -> Array:
    """Arc length from the first point of each line [m], shape (locks, points)."""
    edges = np.linalg.norm(np.diff(lines, axis=1), axis=2)
    return np.concatenate([np.zeros((len(lines), 1)), np.cumsum(edges, axis=1)], axis=1)


def _frames(center: Array) -> Array:
    """Rotation-minimising frames of centre lines, shape (locks, points, 3, 3)."""
    count, size, _ = center.shape
    first = center[:, 1] - center[:, 0]
    across = np.cross(first, np.eye(3)[np.abs(first).argmin(axis=1)])
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-12)
    packed = np.ascontiguousarray(center.reshape(-1, 3))
    offsets = (size * np.arange(count + 1)).astype(np.int32)
    return _core.curve_frames(packed, offsets, np.ascontiguousarray(across)).reshape(count, size, 3, 3)


def _rooted(center: Array, roots: Array, pitch: Array) -> Array:
    """Centre lines that begin at the roots, bent towards them over a turn."""
    run = _arc_length(center)
    reach = np.minimum(pitch, 0.5 * run[:, -1])
    t = np.clip(1.0 - run / np.maximum(reach, 1e-9)[:, None], 0.0, 1.0)
    return center + (t * t * (3.0 - 2.0 * t))[..., None] * (roots - center[:, 0])[:, None]
