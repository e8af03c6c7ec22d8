"""Live hair of a session: its rods go to all pages while it is on, and it goes on with what changes."""

from __future__ import annotations

import re
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from live_memory import growth
from pages import page, serving
from ringlet.live.rods import VERTICES
from ringlet.viewer.play import calibrator, live_hair
from ringlet.viewer.play.head import MOTIONS, Head, Motion, clip_motion
from ringlet.viewer.play.live_hair import LiveHair
from ringlet.viewer.play.mover import Hand, LiveScene, Mover, neck, rods_message, step_message
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
    mover = Mover(LiveScene(groom, None, []), print)
    live = mover.live
    live.head = turned()
    live.reset()
    rods = split(rods_message(3, mover))[1]
    header, arrays = split(step_message(3, 5, mover, ""))
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


def test_the_neck_is_the_first_narrow_part_below_the_roots(groom: Groom) -> None:
    height, around = np.meshgrid(np.linspace(-0.2, 0.0, 60), np.linspace(0.0, 2.0 * np.pi, 20))
    radius = np.where(height > -0.08, 0.02 + 0.5 * np.abs(height + 0.06), 0.03 + 0.5 * np.abs(height + 0.15))
    places = np.stack([radius * np.cos(around) + 0.01, height, radius * np.sin(around)], axis=-1).reshape(-1, 3)
    body = replace(groom, scalp=replace(groom.scalp, points=places))
    assert neck(body) == pytest.approx([0.01, -0.06, 0.0], abs=0.012)


def test_a_frame_of_the_example_s_locks_is_small(groom: Groom) -> None:
    """100 800 bytes for the 1 050 locks of the example, and a header."""
    message = step_message(1, 1, Mover(LiveScene(groom, None, []), print), "")
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


def test_the_page_says_where_the_stiffness_of_contact_is_from(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(calibrator, "COMMAND", [sys.executable, "-c", "print(3e-4)"])
    monkeypatch.setattr(calibrator, "REST", 0.3)
    with serving(folder) as client, page(client) as leader:
        leader.receive("measured")
        leader.send(kind="go_live", on=True)
        leader.receive("live", contact="default for curls")
        leader.receive("live", contact="calibrated")
        leader.send(kind="set", changes=[[["curl", "width"], 2.0]], gesture=1)
        leader.receive("live", contact="default for curls")
        leader.receive("live", contact="calibrated")


def test_a_page_that_comes_later_sees_it_and_one_that_leaves_lets_go(folder: Path) -> None:
    with serving(folder) as client:
        with page(client) as leader:
            leader.receive("measured")
            leader.send(kind="go_live", on=True)
            leader.receive("live_step")
            leader.send(kind="hold_head", turn=[0.0, 0.5, 0.0])
            while leader.receive("live_step")["head"][2] < 0.4:
                pass
            with page(client, "two") as other:
                rods = other.latest("rods")
                assert other.latest("live", on=True)["fps"] > 0.0
                assert other.receive("live_step", key=rods["key"])["head"][2] > 0.4
        with page(client, "three") as last:
            while abs(last.receive("live_step")["head"][2]) > 0.01:
                pass


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

    live, scene = SimpleNamespace(dt=0.02, wind=(0.0, 0.0, 0.0)), SimpleNamespace(groom=None)
    contact = ""

    def __init__(self, *_: Any) -> None:
        pass

    def change(self, scene: LiveScene) -> bool:
        return False

    def step(self, hand: Hand, seconds: float) -> str:
        time.sleep(0.05)
        return ""

    def stop(self) -> None:
        pass


def run_slow(monkeypatch: pytest.MonkeyPatch, *, seconds: float, watched: bool, step: Any = Slow.step) -> list[Any]:
    """Numbers of the steps that were sent in some seconds, or messages of what failed."""
    sent: list[int] = []
    monkeypatch.setattr(live_hair, "Mover", Slow)
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
    assert sent[-1] == pytest.approx(0.45 / Slow.live.dt, abs=8)


def test_without_a_page_time_stands_still(monkeypatch: pytest.MonkeyPatch) -> None:
    assert run_slow(monkeypatch, seconds=0.1, watched=False) == []


def test_a_step_that_fails_ends_it_with_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: Any) -> str:
        raise ringlet.UserError("live: locks: has no points; give some")

    assert run_slow(monkeypatch, seconds=0.1, watched=True, step=fail) == ["live: locks: has no points; give some"]


def trouble(one: Any) -> str:
    """The next error message."""
    while True:
        header, _ = split(one.socket.receive_bytes())
        if header["kind"] == "trouble":
            return re.sub(r"\s+", " ", header["message"])


STEP = 1.0 / 24.0


def poses(head: Head, seconds: float) -> np.ndarray:
    """Transforms of the head in some seconds, shape (steps, 4, 4)."""
    found = []
    for _ in range(round(seconds / STEP)):
        head.advance(STEP)
        found.append(head.transform)
    return np.array(found)


def away(transforms: np.ndarray) -> np.ndarray:
    """Largest change of an entry from the pose as groomed, of each."""
    return np.abs(transforms - np.eye(4)).reshape(-1, 16).max(axis=1)


def test_a_head_that_is_let_go_returns_within_a_second() -> None:
    head = Head(np.array([0.0, 0.3, 0.0]))
    head.hold(np.array([0.0, 0.9, 0.0]), np.array([0.1, 0.0, 0.0]))
    held = poses(head, 0.2)
    assert held[-1][:3, :3] @ [0.0, 0.0, 1.0] == pytest.approx([np.sin(0.9), 0.0, np.cos(0.9)])
    assert held[-1] @ [0.0, 0.3, 0.0, 1.0] == pytest.approx([0.1, 0.3, 0.0, 1.0])  # the neck stays on the trunk
    assert head.trunk == pytest.approx([0.1, 0.0, 0.0])
    head.let_go()
    back = poses(head, 2.0)
    assert away(back[:1])[0] > 0.3  # no jump
    assert away(back[24:])[:].max() < 0.05
    assert away(back[-1:])[0] < 2e-3


@pytest.mark.parametrize("name", sorted(MOTIONS))
def test_motions_begin_and_end_at_rest_and_never_jump(name: str) -> None:
    head, motion = Head(np.zeros(3)), MOTIONS[name]
    head.play(name, motion)
    goes_on = motion.seconds == np.inf
    first = poses(head, 3.0)
    if goes_on:
        head.play(name, motion)
    moved = np.concatenate([np.eye(4)[None], first, poses(head, 1.0)])
    assert away(moved).max() > 0.01
    assert away(moved[-1:])[0] == 0.0
    assert np.abs(np.diff(moved[:, :3, 3], axis=0)).max() < 0.1  # [m] a step: no throw
    assert np.abs(np.diff(moved[:, :3, :3], axis=0)).max() < 0.3


def test_a_clip_plays_in_a_loop_without_a_jump() -> None:
    clip = np.tile(np.eye(4), (10, 1, 1))
    clip[:, 0, 3] = 0.02 * np.arange(10)
    motion: Motion = clip_motion(clip, np.zeros(3), 24.0)
    shifts = np.array([motion.at(k / 24.0)[1][0] for k in range(60)])
    assert shifts[:10] == pytest.approx(clip[:, 0, 3])
    assert shifts[21:31] == pytest.approx(clip[:, 0, 3], abs=1e-9)  # 9 steps, and 12 back
    assert np.abs(np.diff(shifts)).max() < 0.03
    assert clip_motion(clip[:1], np.zeros(3), 24.0).at(3.0)[1] == pytest.approx(np.zeros(3))


@pytest.mark.parametrize("pose", [((0.0, 9.0, 0.0), (0.0, 0.0, 0.0)), ((0.0, 0.0, 0.0), (5.0, 3.0, 0.0))])
def test_a_head_that_is_thrown_keeps_its_hair_and_says_so(groom: Groom, pose: Any) -> None:
    mover, hand = Mover(LiveScene(groom, None, []), print), Hand(pose)
    notes = [mover.step(hand, STEP) for _ in range(3)]
    assert notes[1:] == ["", ""]
    assert "thrown" in notes[0] and "\n" not in notes[0]
    hand.held = None
    for _ in range(96):
        mover.step(hand, STEP)
    assert np.abs(mover.live.positions - groom.locks.points).max() < 5e-3


def test_wind_blows_hair_to_the_other_side_and_ends(groom: Groom) -> None:
    mover, hand = Mover(LiveScene(groom, None, []), print), Hand(side="left")
    for _ in range(24):
        mover.step(hand, STEP)
    assert (mover.live.positions - groom.locks.points)[groom.locks.offsets[1:] - 1, 0].mean() < -1e-4
    hand.side = ""
    for _ in range(48):
        mover.step(hand, STEP)
    assert np.linalg.norm(mover.live.wind) < 1e-3


def test_the_hand_and_buttons_move_the_head_on_all_pages(folder: Path) -> None:
    with serving(folder, "small.shot.toml") as client, page(client) as leader, page(client, "two") as other:
        leader.receive("measured")
        leader.send(kind="go_live", on=True)
        leader.receive("live_step")
        still = np.eye(4)[:3].ravel().tolist()
        leader.send(kind="hold_head", turn=[0.0, 0.5, 0.0])
        turned_head = [np.cos(0.5), 0.0, np.sin(0.5)]
        while other.receive("live_step")["head"][:3] != pytest.approx(turned_head):
            pass
        other.send(kind="hold_head", turn=[0.0, -0.5, 0.0])  # does not lead
        leader.send(kind="hold_head", turn=None)
        while leader.receive("live_step")["head"] != pytest.approx(still, abs=1e-3):
            assert leader.received[-1]["head"][2] > -0.4
        leader.send(kind="move_head", motion="clip")
        assert leader.receive("live", goes_on=["clip"])["on"]
        while leader.receive("live_step")["head"] == pytest.approx(still, abs=2e-3):
            pass
        leader.send(kind="move_head", motion="clip")
        leader.receive("live", goes_on=[])
        leader.send(kind="blow", side="front")
        leader.receive("live", wind="front")
        leader.send(kind="hold_head", turn=[None, 0.0, 0.0])  # NaN, as JSON says it
        assert trouble(leader) == "message: turn[0] is None; must be a number"


def test_a_hand_pulls_hair_on_all_pages_and_lets_go(folder: Path) -> None:
    with serving(folder) as client, page(client) as leader, page(client, "two") as other:
        leader.receive("measured")
        leader.send(kind="go_live", on=True)
        still = other.receive("rods")["points"].reshape(-1, VERTICES, 3)
        tip = still[0, -1].astype(float)

        def way() -> float:
            """How far the tip is from where it rests [m]."""
            return float(np.linalg.norm(other.receive("live_step")["points"].reshape(still.shape)[0, -1] - tip))

        assert way() < 1e-5
        leader.send(kind="touch_hair", does="pull", at=tip.tolist())
        other.send(kind="touch_hair", does="pat", at=(tip + 0.01).tolist())  # does not lead
        leader.send(kind="touch_hair", does="pull", at=(tip + (0.0, 0.0, 0.02)).tolist())
        while way() < 0.01:
            pass
        leader.send(kind="touch_hair", does=None)
        while way() > 0.002:
            pass
        leader.send(kind="touch_hair", does="pull", at=[0.0, None, 0.0])  # NaN, as JSON says it
        assert trouble(leader) == "message: at[1] is None; must be a number"


def test_without_a_shot_no_clip_plays(folder: Path) -> None:
    with serving(folder) as client, page(client) as leader:
        leader.receive("measured")
        leader.send(kind="go_live", on=True)
        leader.receive("live_step")
        leader.send(kind="move_head", motion="clip")
        assert trouble(leader) == "live: there is no shot whose clip could play; open one"


def test_sliders_of_a_shot_act_at_the_next_step(folder: Path) -> None:
    groom, shot = ringlet.build_groom(folder / "small.recipe.toml"), ringlet.read_shot(folder / "small.shot.toml")
    mover, hand = Mover(LiveScene(groom, shot, []), print), Hand(((0.0, 0.4, 0.0), (0.0, 0.0, 0.0)))
    mover.step(hand, STEP)
    before = mover.live.positions
    strands = shot.strands.model_copy(update={"bend_scale": 7.0})
    forces = shot.forces.model_copy(update={"gravity": (0.0, 9.81, 0.0), "wind": (3.0, 0.0, 0.0)})
    stiffer = shot.model_copy(update={"strands": strands, "forces": forces})
    assert not mover.change(LiveScene(groom, stiffer, []))  # the rods are the same
    assert mover.live.positions == pytest.approx(before, abs=0.0)
    mover.step(hand, STEP)
    assert mover.live.material.bend_scale == 7.0
    assert mover.live.gravity == (0.0, 9.81, 0.0)
    assert mover.live.wind == (3.0, 0.0, 0.0)
    assert mover.change(LiveScene(replace(groom, locks=groom.locks.take(np.arange(4))), stiffer, []))
    assert len(mover.live.rods) == 4


def test_a_slider_of_a_shot_reaches_live_hair(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scenes: list[LiveScene] = []
    change = Mover.change
    monkeypatch.setattr(Mover, "change", lambda self, scene: scenes.append(scene) or change(self, scene))
    with serving(folder, "small.shot.toml") as client, page(client) as leader:
        leader.receive("measured")
        leader.send(kind="go_live", on=True)
        leader.receive("live_step")
        leader.send(kind="set", file="shot", changes=[[["strands", "bend_scale"], 5.0]], gesture=1)
        while not scenes or scenes[-1].shot is None or scenes[-1].shot.strands.bend_scale != 5.0:
            leader.receive("live_step")


def test_two_minutes_of_live_hair_leak_nothing(groom: Groom) -> None:
    """3 000 steps with messages, motions, wind and other grooms; a proof has an hour."""
    few = replace(groom, locks=groom.locks.take(np.arange(5)))
    assert growth(groom, few, 3000) < 5e5
