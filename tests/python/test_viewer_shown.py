"""What pages are shown: hairs, shots, caches, and what is measured in them."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pages import page, read, serving
from pxr import Usd
from ringlet.data.errors import UserError
from ringlet.viewer.reel import Run
from small_example import write_head
from test_shot_cloth_files import SCARF, write_wear

import ringlet
from ringlet import io
from ringlet.groom import Groom


def test_hairs_come_in_an_order_of_which_the_beginning_is_spread_over_the_locks(folder: Path):
    with serving(folder) as client, page(client) as one:
        hairs = one.hear("hairs")
        assert sorted(hairs["lock"][:8]) == list(range(8))
        assert np.all(hairs["offset"][:16] == 0.0) and np.any(hairs["offset"][16:] != 0.0)


def test_a_shot_runs_and_its_frames_come(folder: Path):
    with serving(folder, "small.shot.toml") as client, page(client) as one:
        assert one.hear("welcome")["mode"] == "shot"
        one.been_told("timeline", state="still")
        one.say(kind="play", action="start")
        frames = one.watch(1, 2, 3, 4)
        assert [frame["frame"] for frame in frames] == [1, 2, 3, 4]
        assert frames[0]["points"].shape == (8 * 40 * 3,) and len(frames[0]["curl"]) == 8 * 40
        assert np.abs(frames[3]["points"] - frames[0]["points"]).max() > 1e-3
        one.been_told("timeline", state="done")
        one.say(kind="set", file="shot", changes=[[["strands", "bend_scale"], 30.0]], gesture=1)
        one.say(kind="play", action="again_from", frame=2)
        one.hear("timeline", key=3)
        again = one.watch(3, 4)
        assert [frame["frame"] for frame in again] == [3, 4]
        assert np.abs(again[1]["points"] - frames[3]["points"]).max() > 1e-6


def test_a_groom_and_its_cache_are_shown_as_they_are(folder: Path):
    groom = ringlet.build_groom(folder / "small.recipe.toml")
    ringlet.write_groom(groom, folder / "groom.usda")
    ringlet.write_cache(
        ringlet.simulate(folder / "small.shot.toml", groom), folder / "groom.usda", folder / "cache.usda"
    )
    with serving(folder, "groom.usda") as client, page(client) as one:
        assert one.hear("welcome")["mode"] == "stage"
        assert len(one.hear("locks")["ids"]) == 8
        one.say(kind="set", changes=[[["curl", "width"], 2.0]], gesture=1)
        assert "no recipe" in one.hear("trouble")["message"]
    with serving(folder, "cache.usda") as client, page(client) as one:
        assert one.hear("timeline", state="none")["frames"].tolist() == [1, 2, 3, 4]
        last, second = one.watch(4, 2)
        assert (last["frame"], second["frame"]) == (4, 2) and last["points"].shape == (8 * 40 * 3,)
        assert np.abs(last["points"] - second["points"]).max() > 1e-3


def test_cloth_and_colliders_of_a_shot_are_seen_where_they_are(folder: Path):
    write_wear(folder)
    write_head(folder / "hand.usda")
    shot = folder / "small.shot.toml"
    shot.write_text(shot.read_text() + SCARF + '[[collider]]\n[[collider]]\nfile = "hand.usda"\nanimated = false\n')
    groom = ringlet.build_groom(folder / "small.recipe.toml")
    cache = ringlet.simulate(shot, groom)
    assert np.abs(cache.cloths[0].points[3] - cache.cloths[0].points[0]).max() > 1e-3
    with serving(folder, shot.name) as client, page(client) as one:
        one.been_told("timeline", state="still")
        one.say(kind="play", action="start")
        first, last = one.watch(1, 4)
        bodies = {body["index"]: body for body in one.heard if body["kind"] == "body"}
        assert [bodies[k]["name"] for k in range(3)] == ["skin", "scarf", "skin"] and bodies[1]["made_of"] == "cloth"
        head = len(bodies[0]["points"])
        for frame, number in ((first, 0), (last, 3)):
            assert np.abs(frame["bodies"][head : head + 3 * 81] - cache.cloths[0].points[number].ravel()).max() < 1e-6
        assert np.abs(last["bodies"][:head] - first["bodies"][:head]).max() > 0.01
        assert np.array_equal(last["bodies"][head + 3 * 81 :], first["bodies"][:head])
    ringlet.write_groom(groom, folder / "groom.usda")
    ringlet.write_cache(cache, folder / "groom.usda", folder / "cache.usda")
    with serving(folder, "cache.usda") as client, page(client) as one:
        assert {one.hear("body")["made_of"] for _ in range(2)} == {"cloth", "skin"}
        (last,) = one.watch(4)
        scarf = cache.cloths[0].points[3].ravel()
        assert np.abs(last["bodies"][-len(scarf) :] - scarf).max() < 1e-6


def test_a_cloth_that_cannot_be_read_is_told_and_the_groom_is_seen(folder: Path):
    shot = folder / "small.shot.toml"
    shot.write_text(shot.read_text() + SCARF)
    with serving(folder, shot.name) as client, page(client) as one:
        kinds: set[str] = set()
        while "timeline" not in kinds:
            kinds.add(read(one.socket.receive_bytes())["kind"])
        assert {"body", "locks"} <= kinds
        one.say(kind="play", action="start")
        while (message := read(one.socket.receive_bytes()))["kind"] != "trouble":
            pass
        assert "wear.usda: there is no such file" in message["message"]


def test_of_a_cache_no_frame_is_read_but_those_that_are_looked_at(folder: Path, monkeypatch: pytest.MonkeyPatch):
    read: list[float] = []
    points = io.CacheFile.points
    monkeypatch.setattr(io.CacheFile, "points", lambda self, frame: (read.append(frame), points(self, frame))[1])
    write_long_cache(folder, 300)
    with serving(folder, "cache.usda") as client, page(client) as one:
        assert len(one.hear("timeline")["frames"]) == 300
        assert not read and not any(message["kind"] == "frame" for message in one.heard)
        assert one.watch(17, 250)[1]["points"].reshape(-1, 3)[0, 1] > 1.0
        assert read == [17, 250]
    with serving(folder, "small.shot.toml") as client, page(client) as one:
        one.been_told("timeline")
        one.been_told("numbers", draft=False)
        one.say(kind="against", name="cache.usda")
        assert len(one.hear("timeline", against="cache.usda")["beside"]) == 300
        one.say(kind="watch", against=[99])
        assert one.hear("frame")["layer"] == "against" and read == [17, 250, 99]


@pytest.mark.parametrize("suffix", ["usda", "usdc"])
def test_a_cache_that_is_replaced_while_it_plays_is_seen_as_it_is_then(folder: Path, suffix: str):
    groom, cache = small_groom(folder), folder / f"cache.{suffix}"
    write_marked_cache(groom, cache, 1, frames=30)
    with serving(folder, cache.name) as client, page(client) as one:
        assert mark_of(one.watch(7)[0], groom) == 1
        first = one.been_told("timeline")
        write_marked_cache(groom, cache, 2, frames=20)
        one.say(kind="watch", shot=[8, 9, 25])
        there = one.hear("timeline")
        assert there["key"] != first["key"] and there["frames"].tolist() == list(range(1, 21)) and there["last"] == 20
        assert [mark_of(frame, groom) for frame in one.watch(8, 9)] == [2, 2]


def test_no_frame_is_half_of_one_file_and_half_of_the_next(folder: Path):
    """A cache is replaced again and again while a page plays it, and opens it anew."""
    groom, cache = small_groom(folder), folder / "cache.usdc"
    write_marked_cache(groom, cache, 1, frames=20)
    done = threading.Event()

    def write() -> None:
        mark = 1
        while not done.wait(0.01):
            mark += 1
            write_marked_cache(groom, cache, mark, frames=20)

    with serving(folder, "small.shot.toml") as client, page(client) as one:
        one.been_told("numbers", draft=False)
        one.say(kind="against", name=cache.name)
        one.hear("timeline", against=cache.name)
        writer = threading.Thread(target=write)
        writer.start()
        try:
            marks = []
            one.say(kind="watch", against=list(range(1, 21)))
            while len(marks) < 200:
                message = read(one.socket.receive_bytes())
                assert message["kind"] != "trouble", message
                if message["kind"] == "frame":
                    marks.append(mark_of(message, groom))
                    if len(marks) % 50 == 0:
                        one.say(kind="against", name=cache.name)
                if message["kind"] == "timeline" or message.get("frame") == 20:
                    one.say(kind="watch", against=list(range(1, 21)))
        finally:
            done.set()
            writer.join()
        assert len(set(marks)) > 3 and marks == sorted(marks)


def test_a_cache_of_another_groom_in_the_place_of_one_that_plays_is_told(folder: Path):
    groom, cache = small_groom(folder), folder / "cache.usdc"
    write_marked_cache(groom, cache, 1, frames=5)
    with serving(folder, cache.name) as client, page(client) as one:
        one.watch(1)
        recipe = folder / "small.recipe.toml"
        recipe.write_text(recipe.read_text().replace("points = 40", "points = 30"))
        write_marked_cache(small_groom(folder, "other.usda"), cache, 2, 5, under="other.usda")
        one.say(kind="watch", shot=[2])
        assert "is of another groom" in one.hear("trouble")["message"]
        assert not len(one.hear("timeline")["frames"])


def test_a_cache_that_is_gone_goes_on_playing(folder: Path):
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
    """A cache whose frames say by their places and by their statistics which it is: see ``mark_of``."""
    numbers = np.arange(1.0, frames + 1)
    points = np.broadcast_to(groom.locks.points + (0, 10.0 * mark, 0), (frames, *groom.locks.points.shape))
    statistics = [{"wall_ms": float(mark)}] * frames
    ringlet.write_cache(ringlet.Cache(numbers, points.astype(np.float32), statistics), path.with_name(under), path)


def mark_of(frame: dict[str, Any], groom: Groom) -> int:
    """Which cache a frame is of, by its places; its statistics must say the same."""
    mark = round((frame["points"].reshape(-1, 3) - groom.locks.points)[:, 1].mean() / 10.0)
    assert frame["statistics"]["wall_ms"] == mark
    return mark


def test_a_frame_that_cannot_be_read_is_told_and_the_others_are_seen(folder: Path):
    write_long_cache(folder, 3)
    stage = Usd.Stage.Open(str(folder / "cache.usda"))
    stage.GetPrimAtPath("/groom/locks").GetAttribute("points").Set([(0, 0, 0)], 2.0)
    stage.Save()
    with serving(folder, "cache.usda") as client, page(client) as one:
        assert len(one.hear("timeline")["frames"]) == 3
        one.say(kind="watch", shot=[2, 3])
        assert "1 points at frame 2" in one.hear("trouble")["message"]
        assert one.hear("frame")["frame"] == 3


def write_long_cache(folder: Path, frames: int) -> None:
    """A cache in which all rise by 1 cm a frame."""
    groom = ringlet.build_groom(folder / "small.recipe.toml")
    ringlet.write_groom(groom, folder / "groom.usda")
    numbers = np.arange(1.0, frames + 1)
    points = (groom.locks.points + 0.01 * numbers[:, None, None] * (0, 1, 0)).astype(np.float32)
    ringlet.write_cache(ringlet.Cache(numbers, points), folder / "groom.usda", folder / "cache.usda")


def test_frames_that_are_run_are_kept_in_a_file_and_told_where_that_is_full(monkeypatch: pytest.MonkeyPatch):
    run = Run()
    for frame in (1.0, 2.0, 3.0):
        run.add(frame, bytes([int(frame)]) * 1000)
    run.cut(after=2.0)
    run.add(3.0, b"again")
    assert run.frames.tolist() == [1, 2, 3]
    assert (run.message(2.0), run.message(3.0)) == (b"\2" * 1000, b"again")
    run.cut()
    assert not len(run.frames)
    with pytest.raises(UserError, match="no more"):
        run.message(2.0)
    with Path("/dev/full").open("wb", buffering=0) as full:
        monkeypatch.setattr(run, "_file", full)
        with pytest.raises(UserError, match="frame 1 cannot be kept there"):
            run.add(1.0, b"much")
    assert not len(run.frames)


def test_the_page_is_told_what_settings_may_name(folder: Path):
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text() + "[curves.tie]\npoints = [[0, 12, 0], [1, 12, 0]]\n")
    with serving(folder) as client, page(client) as one:
        names = one.hear("names")
        assert names["regions"] == ["scalp"] and names["curves"] == ["tie"]


def test_nails_and_what_is_in_the_head_are_measured_at_rest(folder: Path):
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text() + '[[nail]]\nreach = "1 cm"\n[clean]\nmargin = 0\n')
    text = recipe.read_text().replace("[clean]\nmargin = 0\n", "").replace("length = 5", "length = 5\ndroop = 3")
    with serving(folder) as client, page(client) as one:
        measured = one.hear("measured")
        nail = measured["nail"].reshape(8, 40)
        assert np.all(nail[:, 0] == 255) and np.all(nail[:, -1] == 0)
        one.say(kind="restore", text=text)
        one.say(kind="mute", stages=["clean"])
        one.hear("numbers", draft=False)
        inside = one.hear("measured")
        if inside["inside"] == 0:  # of the recipe alone, before its cleaning was muted
            inside = one.hear("measured")
        assert inside["inside"] > 0 and inside["depth"].max() > 0


def test_frames_tell_what_touches_and_what_is_in_the_head(folder: Path):
    shot = folder / "small.shot.toml"
    shot.write_text(shot.read_text().replace("frames = [1, 4]", "frames = [1, 2]") + "[contact]\nradius = 0.004\n")
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text().replace("length = 5", "length = 5\ndroop = 3"))  # locks lie on the head
    with serving(folder, "small.shot.toml") as client, page(client) as one:
        one.been_told("timeline", state="still")
        one.say(kind="play", action="start")
        frame = one.watch(2)[0]
        assert len(frame["contact"]) == len(frame["depth"]) == 8 * 40
        assert frame["statistics"]["contacts"] > 0 and frame["contact"].max() > 0
        assert frame["statistics"]["inside"] == 0 and frame["depth"].max() == 0
