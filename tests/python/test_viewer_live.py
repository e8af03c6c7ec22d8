"""Live hair of a session: its rods go to all pages while it is on, and it goes on with what changes."""

from __future__ import annotations

import re
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pages import page, serving
from ringlet.viewer.play import live_hair
from ringlet.viewer.play.live_hair import LiveHair, LiveScene, rods_message, step_message
from ringlet.viewer.publisher import Publisher
from ringlet.viewer.show.display_groom import DisplayGroom, GroomEvaluator
from ringlet.viewer.wire import split
from small_example import write_example

import ringlet
from ringlet.groom import Groom


@pytest.fixture(scope="module")
def groom(tmp_path_factory: pytest.TempPathFactory) -> Groom:
    folder = write_example(tmp_path_factory.mktemp("live"))
    return ringlet.build_groom(folder / "small.recipe.toml")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_example(tmp_path)


def turned() -> np.ndarray:
    head = np.eye(4)
    head[:3, :3] = [[0.8, 0.0, 0.6], [0.0, 1.0, 0.0], [-0.6, 0.0, 0.8]]
    head[:3, 3] = 0.1, 0.2, 0.3
    return head


def test_messages_carry_locks_to_where_they_are(groom: Groom) -> None:
    """As the page carries them: a frame along each rod, and a smooth weight between two vertices."""
    live = ringlet.Live(groom)
    live.head = turned()
    live.reset()
    rods = split(rods_message(3, groom, live))[1]
    header, arrays = split(step_message(3, 5, LiveScene(groom, None, []), live, ""))
    assert (header["key"], header["step"]) == (3, 5)
    head = np.reshape(header["head"], (3, 4))
    expected = rods["points"].reshape(-1, 3) @ head[:, :3].T + head[:, 3]
    assert arrays["points"].reshape(-1, 3) == pytest.approx(expected, abs=1e-6)
    assert rods["carrier"].tolist() == list(range(len(groom.locks)))
    vertex, weight = live.places
    at = np.linspace(0.0, 1.0, 40)
    below = np.clip(np.searchsorted(rods["along"], at, side="right") - 1, 0, len(rods["along"]) - 2)
    u = (at - rods["along"][below]) / np.diff(rods["along"])[below]
    assert vertex[:40].tolist() == below.tolist()
    assert weight[:40] == pytest.approx(u * u * (3 - 2 * u), abs=1e-5)


def test_a_frame_of_the_example_s_locks_is_small(groom: Groom) -> None:
    """100 800 bytes for the 1 050 locks of the example, and a header."""
    message = step_message(1, 1, LiveScene(groom, None, []), ringlet.Live(groom), "")
    assert len(message) - 512 < 8 * 12 * len(groom.locks)


def test_hair_moves_live_on_all_pages_and_rests_again(folder: Path) -> None:
    with serving(folder) as client, page(client) as leader, page(client, "two") as other:
        leader.receive("measured")
        leader.send(kind="go_live", on=True)
        for each in (leader, other):
            rods = each.receive("rods")
            steps = [each.receive("live_step") for _ in range(3)]
            assert {one["key"] for one in steps} == {rods["key"]}
            assert steps[0]["step"] < steps[1]["step"] < steps[2]["step"]
            assert steps[2]["points"] == pytest.approx(rods["points"], abs=1e-6)
        assert leader.latest("live", on=True)["fps"] == pytest.approx(24.0)
        leader.send(kind="set", changes=[[["curl", "width"], 2.0]], gesture=1)
        wider = leader.receive("rods")
        assert wider["key"] > rods["key"]
        leader.receive("live_step", key=wider["key"])
        leader.send(kind="go_live", on=False)
        leader.receive("live", on=False)
        leader.send(kind="set", changes=[[["curl", "width"], 1.5]], gesture=2)
        leader.receive("measured")
        assert leader.received[-1]["kind"] != "live_step"


def test_only_the_page_that_leads_turns_it_on(folder: Path) -> None:
    with serving(folder) as client, page(client) as leader, page(client, "two") as other:
        leader.receive("measured")
        other.send(kind="go_live", on=True)
        assert "leads" in trouble(other)


def test_before_the_groom_is_made_one_line_says_so(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    hold = threading.Event()
    make = GroomEvaluator.groom
    monkeypatch.setattr(GroomEvaluator, "groom", lambda *a, **k: hold.wait() and make(*a, **k))
    with serving(folder) as client, page(client) as leader:
        leader.send(kind="go_live", on=True)
        assert trouble(leader) == "live: the groom is still being made; wait until it is shown"
        hold.set()
        leader.receive("measured")


def test_without_locks_one_line_says_so(groom: Groom) -> None:
    with pytest.raises(ringlet.UserError, match=r"^live: there are no locks to move; open .*"):
        LiveScene.of(DisplayGroom(groom, None, False), None, [])


class Slow:
    """Hair whose steps take long."""

    dt = 0.02

    def __init__(self, scene: Any) -> None:
        self.steps = 0

    def step(self) -> str:
        self.steps += 1
        time.sleep(0.05)
        return ""


def run_slow(monkeypatch: pytest.MonkeyPatch, *, seconds: float, watched: bool, step: Any = Slow.step) -> list[Any]:
    """Numbers of the steps that were sent in some seconds, or messages of what failed."""
    sent: list[int] = []
    monkeypatch.setattr(live_hair, "Live", Slow)
    monkeypatch.setattr(Slow, "step", step)
    monkeypatch.setattr(live_hair, "rods_message", lambda *_: b"")
    monkeypatch.setattr(live_hair, "step_message", lambda key, number, *_: sent.append(number) or b"")
    failures: list[str] = []
    hair = LiveHair(Publisher(), lambda do, *arguments: do(*arguments), failures.append, lambda: watched)
    nothing: Any = None
    hair.start(LiveScene(nothing, None, []))
    time.sleep(seconds)
    hair.stop(patience=1.0)
    assert not hair.on
    return failures or sent


def test_a_slow_step_leaves_others_out(monkeypatch: pytest.MonkeyPatch) -> None:
    sent = run_slow(monkeypatch, seconds=0.5, watched=True)
    assert sent[0] == 0
    assert set(np.diff(sent)) & {2, 3, 4}, sent
    assert sent[-1] == pytest.approx(0.45 / Slow.dt, abs=8)


def test_without_a_page_time_stands_still(monkeypatch: pytest.MonkeyPatch) -> None:
    assert run_slow(monkeypatch, seconds=0.1, watched=False) == []


def test_a_step_that_fails_ends_it_with_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(self: Any) -> str:
        raise ringlet.UserError("live: locks: has no points; give some")

    assert run_slow(monkeypatch, seconds=0.1, watched=True, step=fail) == ["live: locks: has no points; give some"]


def trouble(one: Any) -> str:
    """The next error message."""
    while True:
        header, _ = split(one.socket.receive_bytes())
        if header["kind"] == "trouble":
            return re.sub(r"\s+", " ", header["message"])
