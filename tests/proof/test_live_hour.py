"""An hour of live hair, 86 400 steps, leaks nothing; `make test` has a minute and a half."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from live_memory import growth

import ringlet

CURLS = Path(__file__).parents[2] / "examples" / "child" / "curls.recipe.toml"


def test_an_hour_of_live_hair_leaks_nothing():
    groom = ringlet.build_groom(CURLS)
    few, fewer = (replace(groom, locks=groom.locks.take(np.arange(count))) for count in (24, 16))
    assert growth(few, fewer, 86_400) < 1e6
