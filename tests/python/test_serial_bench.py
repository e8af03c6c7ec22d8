"""The model of ``ringlet bench serial``: loops of known chunks on several workers."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest

from ringlet import Loop, recorded_loops, run_bench

BENCH = Path(__file__).parents[2] / "bench"
SPEC = importlib.util.spec_from_file_location("serial_bench", BENCH / "serial.py")
assert SPEC is not None and SPEC.loader is not None
serial = importlib.util.module_from_spec(SPEC)
sys.path.insert(0, str(BENCH))  # it uses another benchmark
SPEC.loader.exec_module(serial)
sys.path.remove(str(BENCH))  # there is one with the name of a package


def loop(chunks: list[float], *, before: float = 0.0, dynamic: bool = True) -> Loop:
    """A loop of these chunks, after so much serial work [s]."""
    return Loop("here", before, sum(chunks), dynamic, np.array(chunks, dtype=np.float32))


def test_equal_chunks_follow_amdahl() -> None:
    loops = [loop([1.0] * 64, before=16.0)] * 3
    for workers in (1, 2, 4, 8, 16, 32, 64):
        assert serial.replay(loops, workers, 0.0) == pytest.approx(3 * (16 + 64 / workers))
        assert serial.replay(loops, workers, 0.5) == pytest.approx(3 * (16.5 + 64 / workers))


def test_free_workers_take_the_next_chunk_and_others_have_their_part() -> None:
    chunks = [3.0, 1.0, 1.0, 1.0]
    assert serial.replay([loop(chunks)], 2, 0.0) == 3.0
    assert serial.replay([loop(chunks, dynamic=False)], 2, 0.0) == 4.0
    assert serial.replay([loop(chunks, dynamic=False)], 3, 0.0) == 3.0
    assert serial.replay([loop(chunks[::-1])], 2, 0.0) == 4.0  # the longest comes last
    assert serial.replay([loop(chunks)], 64, 0.0) == 3.0


def test_a_loop_of_one_chunk_is_serial() -> None:
    steps = [[loop([2.0], before=1.0), loop([1.0, 6.0]), loop([], before=2.0)]]
    found = serial.summary(steps, {2: 0.0})
    assert found["serial"] == pytest.approx(5 / 12)
    assert found["serial_parts"] == {"here … here": pytest.approx(3 / 12), "here": pytest.approx(2 / 12)}
    assert found["speed_up"][2] == pytest.approx(12 / 11)


def test_barriers_of_more_threads_grow_with_the_logarithm() -> None:
    assert serial.barrier_of(2, {2: 1.0, 4: 3.0}) == 1.0
    assert serial.barrier_of(16, {2: 1.0, 4: 3.0}) == 6.0


def test_the_core_records_all_of_a_step() -> None:
    with recorded_loops() as steps:
        run_bench("twirl", strands=16, contacts="on", steps=3)
    assert len(steps) == 3
    for step in steps:
        assert len({one.place for one in step}) > 20
        assert step[-1].chunks.size == 0
        for one in step[:-1]:
            assert one.serial >= 0.0
            assert float(one.chunks.sum()) <= one.inside * 1.01 + 1e-6
