"""Playback of caches that are long, damaged, replaced or deleted."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pages import page, read, serving
from pxr import Usd
from ringlet.data.errors import UserError
from ringlet.viewer.play.frame_cache import FrameCache

import ringlet
from ringlet import io
from ringlet.groom import Groom


def test_only_requested_frames_of_a_cache_are_read(folder: Path, monkeypatch: pytest.MonkeyPatch):
    read: list[float] = []
    points = io.CacheFile.points
    monkeypatch.setattr(io.CacheFile, "points", lambda self, frame: (read.append(frame), points(self, frame))[1])
    write_long_cache(folder, 300)
    with serving(folder, "cache.usda") as client, page(client) as one:
        assert len(one.receive("timeline")["frames"]) == 300
        assert not read and not any(message["kind"] == "frame" for message in one.received)
        assert one.watch(17, 250)[1]["points"].reshape(-1, 3)[0, 1] > 1.0
        assert read == [17, 250]
    with serving(folder, "small.shot.toml") as client, page(client) as one:
        one.latest("timeline")
        one.latest("numbers", draft=False)
        one.send(kind="against", name="cache.usda")
        assert len(one.receive("timeline", against="cache.usda")["against_frames"]) == 300
        one.send(kind="watch", against=[99])
        assert one.receive("frame")["layer"] == "against" and read == [17, 250, 99]


@pytest.mark.parametrize("suffix", ["usda", "usdc"])
def test_a_replaced_cache_is_reloaded_during_playback(folder: Path, suffix: str):
    groom, cache = small_groom(folder), folder / f"cache.{suffix}"
    write_marked_cache(groom, cache, 1, frames=30)
    with serving(folder, cache.name) as client, page(client) as one:
        assert mark_of(one.watch(7)[0], groom) == 1
        first = one.latest("timeline")
        write_marked_cache(groom, cache, 2, frames=20)
        one.send(kind="watch", shot=[8, 9, 25])
        there = one.receive("timeline")
        assert there["key"] != first["key"] and there["frames"].tolist() == list(range(1, 21)) and there["last"] == 20
        assert [mark_of(frame, groom) for frame in one.watch(8, 9)] == [2, 2]


def test_no_frame_mixes_two_versions_of_a_cache(folder: Path):
    """A cache is replaced repeatedly while a page plays and reopens it."""
    groom, cache = small_groom(folder), folder / "cache.usdc"
    write_marked_cache(groom, cache, 1, frames=20)
    done = threading.Event()

    def write() -> None:
        mark = 1
        while not done.wait(0.01):
            mark += 1
            write_marked_cache(groom, cache, mark, frames=20)

    with serving(folder, "small.shot.toml") as client, page(client) as one:
        one.latest("numbers", draft=False)
        one.send(kind="against", name=cache.name)
        one.receive("timeline", against=cache.name)
        writer = threading.Thread(target=write)
        writer.start()
        try:
            marks = []
            one.send(kind="watch", against=list(range(1, 21)))
            while len(marks) < 200:
                message = read(one.socket.receive_bytes())
                assert message["kind"] != "trouble", message
                if message["kind"] == "frame":
                    marks.append(mark_of(message, groom))
                    if len(marks) % 50 == 0:
                        one.send(kind="against", name=cache.name)
                if message["kind"] == "timeline" or message.get("frame") == 20:
                    one.send(kind="watch", against=list(range(1, 21)))
        finally:
            done.set()
            writer.join()
        assert len(set(marks)) > 3 and marks == sorted(marks)


@pytest.mark.parametrize(("old", "new"), [("points = 40", "points = 30"), ("ringlet = 2", "ringlet = 2\nseed = 2")])
def test_replacing_a_cache_by_one_of_another_groom_is_reported(folder: Path, old: str, new: str):
    groom, cache = small_groom(folder), folder / "cache.usdc"
    write_marked_cache(groom, cache, 1, frames=5)
    with serving(folder, cache.name) as client, page(client) as one:
        one.watch(1)
        recipe = folder / "small.recipe.toml"
        recipe.write_text(recipe.read_text().replace(old, new))
        write_marked_cache(small_groom(folder, "other.usda"), cache, 2, 5, under="other.usda")
        one.send(kind="watch", shot=[2])
        assert "belongs to another groom" in one.receive("trouble")["message"]
        assert not len(one.receive("timeline")["frames"])


def test_a_deleted_cache_keeps_playing(folder: Path):
    groom, cache = small_groom(folder), folder / "cache.usdc"
    write_marked_cache(groom, cache, 1, frames=5)
    with serving(folder, cache.name) as client, page(client) as one:
        one.watch(1)
        cache.unlink()
        assert mark_of(one.watch(4)[0], groom) == 1


def small_groom(folder: Path, name: str = "groom.usda") -> Groom:
    groom = ringlet.build_groom(folder / "small.recipe.toml")
    ringlet.write_groom(groom, folder / name)
    return groom


def write_marked_cache(groom: Groom, path: Path, mark: int, frames: int, under: str = "groom.usda") -> None:
    """Writes a cache whose positions and statistics encode a mark, see ``mark_of``."""
    numbers = np.arange(1.0, frames + 1)
    points = np.broadcast_to(groom.locks.points + (0, 10.0 * mark, 0), (frames, *groom.locks.points.shape))
    statistics = [{"wall_ms": float(mark)}] * frames
    ringlet.write_cache(ringlet.Cache(numbers, points.astype(np.float32), statistics), path.with_name(under), path)


def mark_of(frame: dict[str, Any], groom: Groom) -> int:
    """The mark of the cache that a frame belongs to; its positions and statistics must agree."""
    mark = round((frame["points"].reshape(-1, 3) - groom.locks.points)[:, 1].mean() / 10.0)
    assert frame["statistics"]["wall_ms"] == mark
    return mark


def test_an_unreadable_frame_is_reported_and_the_others_shown(folder: Path):
    write_long_cache(folder, 3)
    stage = Usd.Stage.Open(str(folder / "cache.usda"))
    stage.GetPrimAtPath("/groom/locks").GetAttribute("points").Set([(0, 0, 0)], 2.0)
    stage.Save()
    with serving(folder, "cache.usda") as client, page(client) as one:
        assert len(one.receive("timeline")["frames"]) == 3
        one.send(kind="watch", shot=[2, 3])
        assert "1 points at frame 2" in one.receive("trouble")["message"]
        assert one.receive("frame")["frame"] == 3


def write_long_cache(folder: Path, frames: int) -> None:
    """Writes a cache in which locks rise by 1 cm a frame."""
    groom = ringlet.build_groom(folder / "small.recipe.toml")
    ringlet.write_groom(groom, folder / "groom.usda")
    numbers = np.arange(1.0, frames + 1)
    points = (groom.locks.points + 0.01 * numbers[:, None, None] * (0, 1, 0)).astype(np.float32)
    ringlet.write_cache(ringlet.Cache(numbers, points), folder / "groom.usda", folder / "cache.usda")


def test_simulated_frames_are_stored_in_a_file_and_a_full_disk_is_reported(monkeypatch: pytest.MonkeyPatch):
    cache = FrameCache()
    for frame in (1.0, 2.0, 3.0):
        cache.add(frame, bytes([int(frame)]) * 1000)
    assert [cache.message(frame) for frame in (3.0, 1.0)] == [b"\3" * 1000, b"\1" * 1000]
    with Path("/dev/full").open("wb", buffering=0) as full:
        monkeypatch.setattr(cache, "_file", full)
        with pytest.raises(UserError, match="frame 1 cannot be kept there"):
            cache.add(1.0, b"much")
