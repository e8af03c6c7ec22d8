"""Layouts of hairs of several grooms as one, for the review page."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

PER_HAIR = ("offset", "tip", "join", "flat", "taper", "root")
PER_POINT = ("profile", "hold", "pace", "blend")  # along hairs, one row a groom
CURL_PER_POINT = ("escaping", "relaxing", "tight", "opening")

Layout = dict[str, Any]


def joined_layout(each: list[Layout], first_locks: list[int]) -> Layout:
    """Layouts of grooms, one after another; ``group`` is the row of each hair's groom, uint8.

    first_locks: row of each groom's first lock among all
    """
    counts = [len(of["tip"]) for of in each]
    knots = max(of["frizz"].shape[1] // 2 for of in each)
    before = np.cumsum([0, *counts[:-1]])
    others = [_others(of, n, first) for of, n, first in zip(each, counts, first_locks, strict=True)]
    firsts = [of["first"][:-1] + n for of, n in zip(each, before, strict=True)]
    return {
        **{name: np.concatenate([of[name] for of in each]) for name in (*PER_HAIR, *PER_POINT)},
        "first": np.concatenate([*firsts, [sum(counts)]]).astype(each[0]["first"].dtype),
        "axis": np.concatenate([of["axis"] for of in each]),
        "frizz": np.concatenate([_with_knots(of["frizz"], knots) for of in each]),
        "other": np.concatenate(others),
        "share": np.concatenate([_filled(of["share"], np.zeros(n)) for of, n in zip(each, counts, strict=True)]),
        "group": np.repeat(np.arange(len(each), dtype=np.uint8), counts),
        **_joined_curl(each, counts, knots),
    }


def _joined_curl(each: list[Layout], counts: list[int], knots: int) -> Layout:
    """Curls of the hairs; zero where those of a groom follow their lock alone."""
    sample = next((of["curl"] for of in each if of["curl"]), None)
    if sample is None:
        return {"curl": {}}

    def of_groom(of: Layout, count: int, name: str) -> NDArray:
        points = len(of["profile"])
        if of["curl"]:
            values = of["curl"][name]
            return _with_knots(values, knots, 1) if name in ("slip", "phase") else values
        if name in CURL_PER_POINT:
            return np.zeros(points)
        width = (knots,) if name in ("slip", "phase") else sample[name].shape[1:]
        return np.zeros((count, *width))

    curl = {
        name: np.concatenate([of_groom(of, n, name) for of, n in zip(each, counts, strict=True)]) for name in sample
    }
    return {"curl": curl}


def joined_windows(each: list[tuple[Layout, int]]) -> NDArray[np.integer]:
    """Points of a turn of each lock's coil, of layouts with their number of locks; empty where no hairs curl."""
    if not any(of["curl"] for of, _ in each):
        return np.empty(0, np.int32)
    return np.concatenate([_filled(of["window"], np.zeros(locks, np.int32)) for of, locks in each])


def _with_knots(values: NDArray, knots: int, size: int = 2) -> NDArray:
    """Values at even knots along hairs, shape (hairs, k · size), at another number of knots, linear between them."""
    count, now = len(values), values.shape[1] // size
    if now == knots:
        return values
    at = np.linspace(0.0, now - 1.0, knots)
    low = np.minimum(at.astype(int), max(now - 2, 0))
    t = (at - low)[:, None]
    grid = values.reshape(count, now, size)
    return ((1.0 - t) * grid[:, low] + t * grid[:, np.minimum(low + 1, now - 1)]).reshape(count, -1)


def _others(of: Layout, count: int, first: int) -> NDArray:
    return of["other"] + first if len(of["other"]) else np.zeros(count)


def _filled(values: NDArray, otherwise: NDArray) -> NDArray:
    return values if len(values) else otherwise
