"""How long live hair of the example takes from what a hand does to the message that shows it, in a session.

    .venv/bin/python tools/proof/live_lag.py 40

Measured between pages without a browser and a server in one process: a page draws later. Prints JSON: medians and
nine in ten [ms]. Up to a step of these, 42 ms, are waited until the hair moves on.
"""

from __future__ import annotations

import json
import shutil
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests" / "python"))
from pages import Page, page, serving  # noqa: E402

PAUSE = 1.5  # between two changes, after which hair moves by less in a step [s]
MOVES = 2e-4  # [m]


def measure(times: int) -> dict[str, Any]:
    """Lags of a head that is taken, of gravity that changes, and of a slider of the groom that is dragged.

    The locks of that slider come first, carried by the rods that are there, and its own rods later.
    """
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name, "child")
        shutil.copytree(ROOT / "examples" / "child", folder)
        with serving(folder, "nod.shot.toml") as client, page(client) as leader:
            leader.receive("measured")
            leader.send(kind="go_live", on=True)
            leader.receive("live_step")
            lags = {of.__name__: lags_of(of, leader, times) for of in (head, gravity, locks, rods)}
    return {"name": "live_lag", "params": {"times": times}, **lags}


def lags_of(change: Callable[[Page, int], None], leader: Page, times: int) -> dict[str, float]:
    found = list[float]()
    for k in range(times):
        end = time.monotonic() + PAUSE + k % 5 / 100  # at any time of a step
        while time.monotonic() < end:
            leader.receive("live_step")
        began = time.monotonic()
        change(leader, k)
        found.append(1e3 * (time.monotonic() - began))
    return {"median_ms": statistics.median(found), "ninetieth_ms": statistics.quantiles(found, n=10)[-1]}


def head(leader: Page, k: int) -> None:
    before = leader.received[-1]["head"]
    leader.send(kind="hold_head", turn=[0.0, 0.2 - 0.4 * (k % 2), 0.0])
    while np.allclose(leader.receive("live_step")["head"], before, rtol=0.0, atol=1e-3):
        pass


def gravity(leader: Page, k: int) -> None:
    before = leader.received[-1]["points"]
    down = 9.81 if k % 2 else 3.0
    leader.send(kind="set", file="shot", changes=[[["forces", "gravity"], [0.0, -down, 0.0]]], gesture=1000 + k)
    while np.allclose(leader.receive("live_step")["points"], before, rtol=0.0, atol=MOVES):
        pass


def locks(leader: Page, k: int) -> None:
    drag_width(leader, 1.2 - 0.01 * k)
    leader.receive("locks")


def rods(leader: Page, k: int) -> None:
    drag_width(leader, 1.2 + 0.01 * k)
    leader.receive("live_step", key=leader.receive("rods")["key"])


def drag_width(leader: Page, width: float) -> None:
    leader.send(kind="set", changes=[[["curl", "width", "value"], width]], gesture=2000, resting=False)


if __name__ == "__main__":
    print(json.dumps(measure(int(sys.argv[1]))))
