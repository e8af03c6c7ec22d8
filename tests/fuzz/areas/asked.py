"""Lengths, counts and widths are those that are asked for."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from judged import grown, same
from numpy.random import Generator

from ringlet.groom import make_hairs


def attempt(random: Generator, folder: Path) -> None:
    length, vary = 10.0 ** random.uniform(-2.5, -0.6), random.random()
    count, per_lock = int(random.integers(2, 40)), int(random.integers(1, 9))
    width = 10.0 ** random.uniform(-5, -3)
    table = {
        "ringlet": 2,
        "unit": str(random.choice(["mm", "cm", "m", "in"])),
        "scalp": {"region": "scalp"},
        "guides": {
            "count": count,
            "length": {"value": f"{1e3 * length} mm", "vary": vary},
            "gravity_bend": random.uniform(0, 3),
        },
        "collide": {"margin": 0},
        "hairs": {"per_lock": per_lock, "width": {"value": f"{1e3 * width} mm", "vary": 0, "ramp": [[0, 1]]}},
    }
    groom = grown(table)
    lengths = groom.guides.lengths()
    assert len(groom.guides) == count, f"{len(groom.guides)} guides of {count}"
    low, high = length * (1 - vary), length * (1 + vary)
    assert lengths.min() > 0.97 * low - 1e-4 and lengths.max() < 1.01 * high, (
        f"{lengths.min()}, {lengths.max()} of {low}, {high}"
    )
    hairs = make_hairs(groom).curves
    assert len(hairs) == per_lock * len(groom.locks), "hairs of a lock"
    same(hairs.point["width"], np.full(len(hairs.points), width), 1e-3 * width, "width")
