"""Live hair that is compared: two materials or two looks move with the same head."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pages import Page, page, serving
from ringlet.viewer.play.mover import Hand, LiveScene, Mover
from ringlet.viewer.play.side_by_side import Followers
from ringlet.viewer.wire import split
from small_example import write_example
from test_viewer_snapshots import take

import ringlet

STEP = 1.0 / 24.0
PATIENCE = 30.0  # [s]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_example(tmp_path)


def scenes(folder: Path) -> tuple[LiveScene, LiveScene]:
    """The small example in its material, and in a stiffer one."""
    groom, shot = ringlet.build_groom(folder / "small.recipe.toml"), ringlet.read_shot(folder / "small.shot.toml")
    strands = shot.strands.model_copy(update={"bend_scale": 40.0})
    return LiveScene(groom, shot, []), LiveScene(groom, shot.model_copy(update={"strands": strands}), [])


def joined(followers: Followers, leader: Mover, compared: dict[Any, LiveScene]) -> dict[str, Any]:
    """Rods of the sides once these are made, by side."""
    keys, end, rods = iter(range(1, 99)), time.monotonic() + PATIENCE, dict[str, Any]()
    while set(rods) != set(compared) and time.monotonic() < end:
        rods |= dict(followers.change(compared, leader, lambda: next(keys)))
        time.sleep(0.01)
    return {side: split(message) for side, message in rods.items()}


def steps(followers: Followers, leader: Mover, hand: Hand, count: int) -> dict[str, list[Any]]:
    """Steps of the leader, with the messages of the others by side."""
    found: dict[str, list[Any]] = {}
    for number in range(count):
        leader.step(hand, STEP)
        for side, message in followers.step(leader, hand, number):
            found.setdefault(side, []).append(split(message))
    return found


def test_the_same_look_moves_the_same_and_another_material_differently(folder: Path) -> None:
    own, stiffer = scenes(folder)
    leader, followers, hand = Mover(own, print), Followers(print), Hand(side="left")
    rods = joined(followers, leader, {"b": own, "c": stiffer})
    assert rods["b"][1]["points"] == pytest.approx(rods["c"][1]["points"], abs=0.0)
    for name in ("nod", "turn"):
        hand.motions.put(name)
    found = steps(followers, leader, hand, 24)
    origin = own.groom.origin
    same, other = (found[side][-1] for side in ("b", "c"))
    assert same[0]["head"] == other[0]["head"]
    assert same[1]["points"] == pytest.approx((leader.live.rods - origin).ravel(), abs=1e-6)
    assert np.abs(other[1]["points"] - same[1]["points"]).max() > 1e-3
    followers.stop()


def test_a_look_that_is_added_in_motion_begins_at_rest_on_the_head_where_that_is(folder: Path) -> None:
    own, stiffer = scenes(folder)
    leader, followers, hand = Mover(own, print), Followers(print), Hand(((0.0, 0.6, 0.0), (0.02, 0.0, 0.0)))
    steps(followers, leader, hand, 30)
    joined(followers, leader, {"b": stiffer})
    points = steps(followers, leader, hand, 1)["b"][0][1]["points"].reshape(-1, 3)
    head = leader.live.head
    groomed = followers._moving["b"][1].live.groomed_rods.reshape(-1, 3)
    assert points + own.groom.origin == pytest.approx(groomed @ head[:3, :3].T + head[:3, 3], abs=2e-3)
    assert dict(followers.change({}, leader, lambda: 0)) == {"b": None}
    assert steps(followers, leader, hand, 1) == {}
    followers.stop()


def test_a_look_that_cannot_move_is_said_and_the_others_go_on(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    own, stiffer = scenes(folder)
    leader, said = Mover(own, print), list[str]()
    followers = Followers(said.append)

    def fail(*_: Any) -> None:
        raise ringlet.UserError("live: locks: has no points; give some")

    with monkeypatch.context() as patched:
        patched.setattr(Mover, "__init__", fail)
        dict(followers.change({"b": stiffer}, leader, lambda: 1))
        while not said:
            time.sleep(0.01)
    assert said == ["live: locks: has no points; give some"]
    assert set(joined(followers, leader, {"c": own})) == {"c"}
    followers.stop()


def live(one: Page) -> None:
    one.latest("measured")
    one.send(kind="go_live", on=True)
    one.receive("live_step")


def test_two_materials_are_compared_live_on_all_pages(folder: Path) -> None:
    with serving(folder, "small.shot.toml") as client, page(client) as one, page(client, "two") as two:
        live(one)
        one.send(kind="compare", to="now", side="b")
        rods = {each: each.receive("rods", side="b") for each in (one, two)}
        one.send(kind="set", file="shot", changes=[[["strands", "bend_scale"], 40.0]], gesture=1)
        a = one.receive("compared", side="a")["settings"]
        b = one.latest("compared", side="b")["settings"]
        assert {name for name in a if a[name] != b.get(name)} == {"strands.bend_scale"}
        one.send(kind="move_head", motion="nod")
        most = 0.0
        while most < 2e-4:
            key = rods[one]["key"]
            here, other = one.receive("live_step", side="a"), one.receive("live_step", side="b", key=key)
            if here["step"] == other["step"]:
                assert here["head"] == pytest.approx(other["head"])
                most = max(most, np.abs(here["points"] - other["points"]).max())
        assert two.receive("live_step", side="b")["key"] == rods[two]["key"]
        one.send(kind="compare", to="none", side="b")
        one.receive("compared", side="b", name="")
        for _ in range(3):  # the thread of the motion has heard of it
            one.receive("live_step", side="a")
        with page(client, "three") as late:
            late.receive("live_step", side="a")
            assert {message["side"] for message in late.received if message["kind"] in ("rods", "live_step")} == {"a"}


def test_a_snapshot_and_another_recipe_move_live_and_a_take_plays(folder: Path) -> None:
    (folder / "wide.recipe.toml").write_text('ringlet = 2\nextends = "small.recipe.toml"\n\n[curl]\nwidth = 2.0\n')
    with serving(folder) as client, page(client) as one:
        one.receive("snapshots")
        taken = take(one)
        live(one)
        one.send(kind="compare", to="snapshot", name=taken["id"], side="b")
        one.send(kind="compare", to="file", name="wide.recipe.toml", side="c")
        rods = {side: one.latest("rods", side=side) for side in ("b", "c")}
        assert one.receive("live_step", side="c")["points"].shape == rods["c"]["points"].shape
