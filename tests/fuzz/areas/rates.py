"""The same motion at another frame rate, with as many steps a second, ends in the same place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from judged import same
from moving_scene import moving_scene
from numpy.random import Generator

import ringlet


def attempt(random: Generator, folder: Path) -> None:
    ends, seed = [], int(random.integers(1 << 30))
    for rate in (24, int(random.choice([12, 48]))):
        here = folder / str(rate)
        here.mkdir()
        shot, groom = moving_scene(np.random.default_rng(seed), here, rate=rate, steps=48, slides=True)
        ends.append(ringlet.simulate(shot, groom).points[-1])
    same(ends[1], ends[0], 1e-6, f"rate {rate}")
