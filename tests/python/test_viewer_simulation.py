"""Runs of the review: a run that is stopped ends by itself, adds nothing more and keeps nobody waiting."""

from __future__ import annotations

import threading
import time
from types import SimpleNamespace

import numpy as np
from ringlet.shot import parse_shot
from ringlet.viewer.play import simulation
from ringlet.viewer.play.simulation import Simulation


def test_a_run_in_a_long_frame_is_replaced_without_waiting_for_it(monkeypatch):
    shot = parse_shot('ringlet = 2\ngroom = "a.usdc"\nframes = [1, 2]\npreroll = 0')
    release, entered, done = threading.Event(), threading.Event(), threading.Event()

    def start_motion(shot, groom, on_warning):
        slow = not entered.is_set()

        def reach(k: int) -> dict:
            if slow:
                entered.set()
                release.wait()
            return {"slow": slow}

        return SimpleNamespace(
            reach=reach, garments=[], memory={"a": np.zeros(1)}, points=lambda frame: np.zeros((2, 3))
        )

    def frame(layer, number, state, motion) -> bytes:
        return b"slow" if state.statistics["slow"] else b"quick"

    monkeypatch.setattr(simulation, "start_motion", start_motion)
    run = Simulation(iter(range(1, 9)).__next__, lambda: done.set() if run.state == "done" else None, print)
    stage = SimpleNamespace(groom=None, frame=frame, speeds=lambda *_: (0.0, 0.0))
    run.start(shot, "", stage)
    assert entered.wait(10.0)
    begin = time.monotonic()
    run.start(shot, "", stage)
    run.stop()
    run.start(shot, "", stage)
    assert time.monotonic() - begin < 1.0
    release.set()
    assert done.wait(10.0)
    assert [run.take.message(number) for number in run.take.frames] == [b"quick", b"quick"]
