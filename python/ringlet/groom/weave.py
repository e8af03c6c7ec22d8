"""Paths of strands in the cross-section of a braid, and the radius at which strands on them touch.

Strand k of n is at the phase 2πk/n ahead of the first, so that all follow one closed path through the cross-section.
Seen from the front, strands cross where their paths have the same x; the one with the larger z passes in front.
"""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from ringlet import _core

Pattern = Literal["over", "under", "fishtail", "rope"]

SAMPLES = 96  # of a turn, for distances of strands
HALVINGS = 24  # of the radius
FORWARD = np.array([0.0, 0.0, 0.25])  # beside the unit direction away from the head
FISHTAIL_CROSSING = 0.7  # part of a turn in which an outer strand crosses to the other side, times the strands
FISHTAIL_FRONT = 1.2  # part of a turn in which it is in front, in crossings


def refusal(pattern: Pattern, strands: int) -> str | None:
    """Why a number of strands makes no such braid; None where it does."""
    if strands < 2:
        return f"weaves {strands} strand; give locks.sections.strands at least 2"
    if pattern == "fishtail" and (strands < 5 or strands % 2 == 0):
        return f"weaves {strands} strands; a fishtail has 5, 7, 9 or 11"
    return None


def path(pattern: Pattern, strands: int, phase: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Place in the cross-section at phases [rad], any shape: x across and z towards the front, each from −1 to 1.

    ``over``: x = sin φ, and z has n − 1 waves a turn, so that a strand passes over one neighbour and under the next;
    for three strands z = sin 2φ. ``under`` is its mirror image. ``rope`` is a circle. ``fishtail``: the outermost
    strand of a side crosses in front of all to the other side.
    """
    if pattern == "rope":
        return np.sin(phase), np.cos(phase)
    if pattern == "fishtail":
        return _fishtail(strands, phase)
    wave = (np.sin if strands % 2 else np.cos)((strands - 1) * phase)
    return np.sin(phase), wave if pattern == "over" else -wave


def waves(pattern: Pattern, strands: int) -> int:
    """Times that a strand comes to the front in a turn, or as fast as it does so."""
    return {"rope": 1, "fishtail": strands}.get(pattern, strands - 1)


def _fishtail(strands: int, phase: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    crossing = FISHTAIL_CROSSING / strands
    turn = (phase / (2.0 * np.pi)) % 1.0
    side, along = np.where(turn < 0.5, 1.0, -1.0), turn % 0.5
    left = (along - (0.5 - crossing)) / crossing  # of the crossing: 0 as it begins, 1 at its end
    outward = np.sin(0.5 * np.pi * along / (0.5 - crossing))
    x = np.where(left < 0.0, outward, np.cos(0.5 * np.pi * np.clip(left, 0.0, 1.0)))
    away = np.abs((along - (0.5 - 0.5 * crossing) + 0.25) % 0.5 - 0.25)  # from the middle of the nearest crossing
    t = np.clip(1.0 - away / (FISHTAIL_FRONT * crossing), 0.0, 1.0)
    return side * x, 2.0 * t * t * (3.0 - 2.0 * t) - 1.0


def touching_radius(pattern: Pattern, strands: int, width: float, depth: float, pitch: float) -> float:
    """Largest radius [m] of round strands that do not overlap in a braid of that width, depth and pitch [m].

    The braid is measured over its strands, so that their paths are narrower by two radii.
    """
    low, high = 0.0, 0.5 * min(width, depth)
    for _ in range(HALVINGS):
        radius = 0.5 * (low + high)
        if _least_distance(pattern, strands, 0.5 * width - radius, 0.5 * depth - radius, pitch) >= 2.0 * radius:
            low = radius
        else:
            high = radius
    return low


def _least_distance(pattern: Pattern, strands: int, across: float, front: float, pitch: float) -> float:
    """Least distance between the paths of the first strand and any other [m]."""
    x, z, ahead = _apart(pattern, strands)
    square = (across * x) ** 2 + (front * z) ** 2 + (pitch * ahead) ** 2
    return float(np.sqrt(square.min()))


@cache
def _apart(pattern: Pattern, strands: int) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Places of the other strands from that of the first, up to half a turn behind and ahead of it.

    x, z: across and towards the front, shape (strands - 1, SAMPLES, 2 SAMPLES); ahead: turns, shape (2 SAMPLES,)
    """
    turn = np.arange(SAMPLES) / SAMPLES
    ahead = np.arange(2 * SAMPLES) / (2 * SAMPLES) - 0.5
    behind = (np.arange(1, strands) / strands)[:, None, None]
    x, z = path(pattern, strands, 2.0 * np.pi * turn)
    other_x, other_z = path(pattern, strands, 2.0 * np.pi * (turn[:, None] + ahead + behind))
    return other_x - x[:, None], other_z - z[:, None], ahead


def braid_word(places: NDArray) -> list[tuple[int, int]]:
    """The word of a braid: its crossings from root to tip, freely reduced.

    places: x and z of each strand in the cross-sections along the braid, shape (strands, points, 2)

    A crossing is (place, sign): the left strand's place in the order from left to right, and +1 where it passes in
    front of the other, −1 where it passes behind.
    """
    order = list(np.argsort(places[:, 0, 0], kind="stable"))
    word: list[tuple[int, int]] = []
    for a, b in pairwise(np.moveaxis(places, 1, 0)):
        for left, right, sign in _exchanges(a, b, order):
            at = order.index(left)
            order.remove(left)
            order.insert(order.index(right) + 1, left)
            if word and word[-1] == (at, -sign):
                word.pop()
            else:
                word.append((at, sign))
    return word


def _exchanges(a: NDArray, b: NDArray, order: list[int]) -> list[tuple[int, int, int]]:
    """Pairs of strands that change places between two cross-sections (strands, 2), in turn: left, right, sign."""
    found = []
    for i, left in enumerate(order):
        for right in order[i + 1 :]:
            before, after = a[right, 0] - a[left, 0], b[right, 0] - b[left, 0]
            if before >= 0.0 > after:
                t = before / (before - after)
                front = (1.0 - t) * (a[left, 1] - a[right, 1]) + t * (b[left, 1] - b[right, 1])
                found.append((t, left, right, 1 if front > 0.0 else -1))
    return [(left, right, sign) for _, left, right, sign in sorted(found)]


def frames(line: NDArray, middle: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Axes along the centre line (points, 3) of a braid: across it and towards its front, shape (points, 3) each.

    They are rotation-minimising. Half-way along the line the front faces away from ``middle`` [m], or forward where the
    line itself leads away from it.
    """
    line = np.ascontiguousarray(line, np.float64)
    tangent = line[1] - line[0]
    any_axis = np.ascontiguousarray(np.eye(3)[np.abs(tangent).argmin()][None])
    axes = _core.curve_frames(line, np.array([0, len(line)], np.int32), any_axis)
    a, b, t = (axes[:, :, k] for k in range(3))
    half = len(line) // 2
    away = line[half] - middle
    chord = (line[-1] - line[0]) / max(float(np.linalg.norm(line[-1] - line[0])), 1e-12)
    facing = (away - (away @ chord) * chord) / max(float(np.linalg.norm(away)), 1e-12) + FORWARD
    angle = np.arctan2(facing @ b[half], facing @ a[half])
    front: NDArray[np.float64] = np.cos(angle) * a + np.sin(angle) * b
    return np.asarray(np.cross(front, t), np.float64), front


def cross_sections(strands: NDArray, middle: NDArray) -> NDArray[np.float64]:
    """Places x, z of strands (strands, points, 3) in the cross-sections of their braid, shape (strands, points, 2) [m].

    The cross-sections are those of the mean strand, at its points; ``middle`` is that of ``frames``.
    """
    line = strands.mean(axis=0)
    axes = np.stack(frames(line, middle))
    run = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    places = np.empty((*strands.shape[:2], 2))
    for number, strand in enumerate(strands):
        at = np.minimum(np.asarray(KDTree(line).query(strand)[1]), len(line) - 2)
        edge = line[at + 1] - line[at]
        t = np.sum((strand - line[at]) * edge, axis=1) / np.sum(edge * edge, axis=1)
        foot = line[at] + t[:, None] * edge
        along = np.maximum.accumulate(run[at] + t * (run[at + 1] - run[at]))
        for k in range(2):
            places[number, :, k] = np.interp(run, along, np.sum((strand - foot) * axes[k, at], axis=1))
    return places
