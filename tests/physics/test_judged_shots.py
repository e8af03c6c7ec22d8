"""Nothing passes through anything in shots of the example, says ipctk; `judged_shots.py` plays all of them."""

import itertools

import numpy as np
import pytest
from judged_shots import SHOTS, judged, start
from ringlet.sim.garment import carried


@pytest.mark.parametrize("shot", SHOTS)
def test_nothing_passes_through_anything_in_a_shot_of_the_example(shot):
    """Its first frames, with a part of the locks."""
    motion = start(shot, locks=100)
    frames = list(judged(motion, 3))
    assert len(frames) == 3
    assert all(frame.crossings == 0 and frame.statistics["nan"] == 0 for frame in frames)
    assert all(frame.statistics["contact"]["candidates"] > 0 for frame in frames)
    for frame in frames:
        strain = max(frame.edges["drawn_out"], frame.edges["pressed"])
        assert strain == pytest.approx(frame.statistics["max_stretch"], rel=1e-9)


def test_what_begins_in_the_shirt_comes_out_and_passes_through_nothing_else():
    """Hair that hangs down: some of it starts inside, and is judged against bodies once it is out."""
    motion = start("nod", "down", locks=100)
    frames = list(judged(motion, 3))
    assert 0 < frames[-1].statistics["contact"]["excused"] < sum(found["vertices"] for found in motion.start["inside"])
    assert all(frame.crossings == 0 and frame.statistics["nan"] == 0 for frame in frames)


def test_long_hair_between_a_head_that_turns_and_a_shirt_does_not_stop_them():
    """What hangs on the shirt cannot go along with the head; all bodies stopped for it, for seconds."""
    frames = list(judged(start("nod", "down", locks=300), 26, every=5))
    assert sum(frame.crossings or 0 for frame in frames) == 0
    assert all(frame.statistics["contact"]["fraction"] == 1.0 for frame in frames)


@pytest.mark.parametrize("locks", [100, 150, 200])
def test_cloth_that_is_put_into_hair_passes_through_nothing_and_goes_on_moving(locks):
    """A ribbon pushes locks aside, though the head rests; then it never goes along as if it were rigid for long."""
    motion = start("ribbon", locks=locks)
    (ribbon,), moved = motion.worn, []
    before = ribbon.cloth.positions.copy()
    for frame in judged(motion, 24):
        assert frame.crossings == 0
        after = ribbon.cloth.positions.copy()
        moved.append(np.abs(after - carried(before, before, after)).max())
        before = after
    assert all(max(pair) > 1e-6 for pair in itertools.pairwise(moved))


def test_hair_in_equilibrium_stays_where_no_cloth_comes(tmp_path):
    """A ribbon is put into locks while the head rests: some are pushed aside, those that it does not touch stay."""
    motion = start("ribbon", locks=150, balanced=tmp_path / "ribbon.rest.usdc")
    curves = motion.scene.strands.curves
    begin = motion.scene.positions[: len(curves.points)].copy()
    assert all(frame.crossings == 0 for frame in judged(motion, 12))
    away = np.linalg.norm(motion.scene.positions[: len(begin)] - begin, axis=1)
    moved = np.maximum.reduceat(away, curves.offsets[:-1])
    assert moved.max() > 0.01
    assert np.quantile(moved, 0.8) < 35e-6  # a hair's radius [m]
