"""Runs of a shot in the review: earlier takes are kept, compared and taken up again, and their swing is measured."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from pages import Page, page, serving


def run(one: Page, **more: Any) -> dict[str, Any]:
    """Runs the shot; returns the timeline at its end."""
    key = one.latest("timeline")["key"]
    one.send(kind="play", action="start", **more)
    while (timeline := one.receive("timeline", state="done"))["key"] == key:
        pass
    return timeline


def frame(one: Page, number: float, layer: str = "shot") -> dict[str, Any]:
    one.send(kind="watch", **{layer: [number]})
    return one.receive("frame", layer=layer, frame=number)


def bend(one: Page, scale: float, gesture: int) -> None:
    one.send(kind="set", file="shot", changes=[[["strands", "bend_scale"], scale]], gesture=gesture)
    one.receive("document", file="shot")


def test_a_take_of_other_settings_is_kept_compared_and_its_settings_are_used_again(folder: Path):
    with serving(folder, "small.shot.toml") as client, page(client) as one:
        one.receive("numbers", draft=False)
        assert not run(one)["kept"]
        assert not run(one)["kept"]  # the same settings make the same frames
        first = frame(one, 4.0)["points"]
        before = one.latest("document", file="shot")["text"]
        bend(one, 0.02, 1)
        timeline = run(one)
        assert timeline["runs"].tolist() == [3] * 4 and not timeline["stale"].any()
        (kept,) = timeline["kept"]
        assert (kept["number"], kept["first"], kept["last"], kept["same_groom"]) == (2, 1, 4, True)
        assert kept["changes"] == ["strands.bend_scale = –"]
        one.send(kind="against", run=2)
        assert "strands.bend_scale" not in one.latest("compared", side="b", name="run 2")["settings"]
        assert one.latest("compared", side="a", name="now")["settings"]["strands.bend_scale"] == "0.02"
        timeline = one.latest("timeline", against="run 2")
        assert timeline["against_frames"].tolist() == [1, 2, 3, 4] and np.isfinite(timeline["against_swings"][3:]).any()
        assert np.array_equal(frame(one, 4.0, "against")["points"], first)
        one.send(kind="use_run", run=2)
        assert one.receive("document", file="shot")["text"] == before
        while not one.receive("timeline")["stale"].all():
            pass
        one.send(kind="undo")
        assert "bend_scale = 0.02" in one.receive("document", file="shot")["text"]
        one.send(kind="against", run=9)
        assert one.receive_trouble() == "shot: run 9 is not kept; choose one that the timeline lists"


def test_a_take_of_another_groom_is_compared_with_that_groom(folder: Path):
    with serving(folder, "small.shot.toml") as client, page(client) as one:
        one.receive("numbers", draft=False)
        run(one)
        narrow = one.latest("locks", side="a", draft=False)["points"]
        first = frame(one, 4.0)["points"]
        one.send(kind="set", changes=[[["curl", "width"], 1.4]], gesture=1)
        while len((timeline := one.receive("timeline"))["frames"]):
            pass
        assert [(kept["number"], kept["same_groom"]) for kept in timeline["kept"]] == [(1, False)]
        one.send(kind="against", run=1)
        assert np.array_equal(one.latest("locks", side="b")["points"], narrow)
        assert np.array_equal(frame(one, 4.0, "against")["points"], first)


def test_the_swing_of_a_frame_is_the_mean_speed_of_its_tips_and_roots(folder: Path):
    with serving(folder, "small.shot.toml") as client, page(client) as one:
        offsets = one.receive("locks", draft=False)["offsets"]
        one.receive("numbers", draft=False)
        swings = run(one)["swings"].reshape(-1, 3)
        assert np.isnan(swings[0]).all()
        points = [frame(one, float(k))["points"].reshape(-1, 3) for k in (1, 2, 3, 4)]
        for k in (1, 2, 3):
            moved = 24.0 * np.linalg.norm(points[k] - points[k - 1], axis=1)
            expected = moved[offsets[1:] - 1].mean(), moved[offsets[:-1]].mean()
            assert np.allclose(swings[k, :2], expected, rtol=1e-3)
        assert swings[1:, 1].min() > 0.1  # the head turns by 5 degrees a frame
