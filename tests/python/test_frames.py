"""Frames that are asked for and are not there, and gaps, are refused."""

from __future__ import annotations

import numpy as np
import pytest
from commands import refused, run
from ringlet.data.frames import frames_within, gaps
from ringlet.io import HairWriter, read_hair_frames, write_cache, write_groom
from usd_scenes import hairs_of, make_groom, write_head

from ringlet import Cache, UserError


def cache_of(folder, frames):
    """A groom and a cache with some frames."""
    groom = make_groom(write_head(folder / "head.usdc"))
    write_groom(groom, folder / "groom.usdc")
    points = np.repeat(groom.locks.points[None].astype(np.float32), len(frames), axis=0)
    write_cache(Cache(np.array(frames, float), points), folder / "groom.usdc", folder / "cache.usdc", groom.space)
    return groom


@pytest.mark.parametrize(
    ("held", "asked", "gives"),
    [
        ([1, 2, 3, 4], None, [1, 2, 3, 4]),
        ([1, 2, 3, 4], (2, 3), [2, 3]),
        ([1, 2, 3, 4], (0, 3), "has no frames 0; it holds 1 to 4"),
        ([1, 2, 3, 4], (-5, 9), "has no frames -5 to 0 and 5 to 9"),
        ([1, 2, 3, 4], (7, 9), "has no frame from 7 to 9; it holds 1 to 4"),
        ([0.4, 1.4, 2.4], (0, 3), [0.4, 1.4, 2.4]),
        ([0.4, 1.4, 2.4], (1, 1), "the nearest are 0.4 and 1.4"),
        ([], (1, 2), "nothing in it moves"),
    ],
)
def test_a_range_gives_frames_that_are_there_or_is_refused(held, asked, gives):
    if isinstance(gives, str):
        with pytest.raises(UserError, match=gives):
            frames_within(np.array(held, float), asked, "a.usdc")
    else:
        assert frames_within(np.array(held, float), asked, "a.usdc").tolist() == gives


def test_gaps_are_whole_frames_between_neighbours_more_than_one_apart():
    assert gaps(np.array([1.0, 2.0, 5.0, 6.0])) == [3, 4]
    assert gaps(np.array([0.4, 1.4, 3.4])) == [2, 3]
    assert gaps(np.array([0.4, 0.9, 1.4])) == gaps(np.empty(0)) == []


def test_hairs_of_a_cache_with_a_gap_are_refused_and_those_beside_it_are_made(tmp_path, monkeypatch):
    cache_of(tmp_path, [1, 2, 4])
    before = sorted(tmp_path.iterdir())
    monkeypatch.setattr("ringlet.api.hairs.build_hairs", lambda *_, **__: pytest.fail("made hairs before the check"))
    words = ["hair", tmp_path / "groom.usdc", "--cache", tmp_path / "cache.usdc", "-o", tmp_path / "hair.usdc"]
    refused(run(*words), "cache.usdc: has no frame 3, but those before and after")
    refused(run(*words, "--frames", "1:9"), "has no frames 5 to 9; it holds 1 to 4")
    assert sorted(tmp_path.iterdir()) == before


def test_hairs_with_a_gap_are_refused(tmp_path):
    groom = cache_of(tmp_path, [1, 2, 3, 4])
    hairs = hairs_of(groom)
    with HairWriter(tmp_path / "hair.usdc", groom, hairs, tmp_path / "cache.usdc") as writer:
        for frame in (1.0, 2.0, 4.0):
            writer.add(frame, hairs.points.astype(np.float32))
    with pytest.raises(UserError, match=r"hair\.usdc: has no frame 3"):
        read_hair_frames(tmp_path / "hair.usdc")


def test_an_option_of_frames_that_has_no_effect_is_refused(tmp_path):
    for words, says in ((["--frames", "1:2"], "draw a --sheet"), (["--sheet", "--frame", "1"], "with --frames")):
        refused(run("render", tmp_path / "a.usdc", "-o", tmp_path / "a.png", *words), says)
