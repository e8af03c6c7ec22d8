"""A run that breaks off anywhere and is resumed has the frames of one that did not, to the bit."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

from judged import same
from moving_scene import moving_scene
from numpy.random import Generator

import ringlet


def attempt(random: Generator, folder: Path) -> None:
    shot, groom = moving_scene(random, folder)
    ringlet.write_groom(groom, folder / "g.usdc")
    groom = ringlet.read_groom(folder / "g.usdc")
    whole = ringlet.simulate(shot, groom)
    stops = int(random.integers(1, len(whole.frames)))

    def stop(frame: float, statistics: dict[str, Any]) -> None:
        if frame >= shot.frames[0] + stops:
            raise InterruptedError

    files = folder / "g.usdc", folder / "c.usdc"
    with suppress(InterruptedError):
        ringlet.write_simulation(shot, groom, *files, checkpoints=folder / "p", on_frame=stop)
    assert not (folder / "c.usdc").exists(), "a cache of a part of the frames"
    ringlet.write_simulation(shot, groom, *files, checkpoints=folder / "p", resume=True)
    read = ringlet.read_cache(folder / "c.usdc")
    same(read.frames, whole.frames, 0.0, "frames")
    same(read.points, whole.points, 1e-6, "resumed")
    for frame in random.permutation(read.frames)[:2]:
        with ringlet.open_cache(folder / "c.usdc") as cache:
            same(cache.points(float(frame)), whole.points[int(frame - whole.frames[0])], 1e-6, f"frame {frame}")
