"""Takes of live hair: the last seconds are kept as a snapshot, which survives and plays on the page."""

from __future__ import annotations

import re
from copy import copy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pages import Page, page, serving
from ringlet.viewer.play.mover import Hand, LiveScene, Mover, rods_message, step_message
from ringlet.viewer.play.takes import TakeRing
from ringlet.viewer.show.live_take import LEAD, SECONDS, LiveTake
from small_example import write_example
from test_viewer_snapshots import LOOK, picture

import ringlet
from ringlet.groom import Groom

FPS = 24.0
LEFT_OUT = 3  # of four steps one


@pytest.fixture(scope="module")
def groom(tmp_path_factory: pytest.TempPathFactory) -> Groom:
    return ringlet.build_groom(write_example(tmp_path_factory.mktemp("takes")) / "small.recipe.toml")


def recorded(groom: Groom, steps: int, *motions: str, wind: str = "") -> tuple[TakeRing, Mover]:
    """A ring with steps of live hair, of which some were left out, and what moved."""
    mover, ring, hand = Mover(LiveScene(groom, None, []), print), TakeRing(), Hand(side=wind)
    ring.begin(rods_message(1, mover), groom, FPS)
    for name in motions:
        hand.motions.put(name)
    for step in range(steps):
        mover.step(hand, 1.0 / FPS)
        if step % 4 != LEFT_OUT:
            ring.add(step_message(1, step, mover, ""), mover.live.wind)
    return ring, mover


def test_a_take_has_the_last_seconds_as_they_were_seen(groom: Groom) -> None:
    ring, mover = recorded(groom, 163, "walk")
    take = ring.take(groom)
    assert take.seconds == pytest.approx(SECONDS, abs=1.5 / FPS)
    assert set(np.diff(take.steps)) == {1, 2}
    assert take.rods_at(-1) == pytest.approx(mover.live.rods.reshape(-1, 3) - groom.origin, abs=2e-6)
    assert take.heads[-1].reshape(3, 4)[:, :3] == pytest.approx(mover.live.head[:3, :3])
    assert len(take.before) >= 0.75 * LEAD * FPS  # of four steps three are there
    again = LiveTake.from_bytes(take.to_bytes())
    assert again.rods_at(40) == pytest.approx(take.rods_at(40), abs=0.0)
    assert again.before == pytest.approx(take.before, abs=0.0)


def test_a_take_of_an_example_is_small(groom: Groom) -> None:
    take = recorded(groom, 120, "nod")[0].take(groom)
    assert len(take.to_bytes()) < 0.5 * 4 * 3 * take.moved.size / 3 + 20_000  # of the same in single precision


def test_wind_of_a_take_is_its_mean(groom: Groom) -> None:
    wind = recorded(groom, 120, wind="left")[0].take(groom).wind
    assert wind[0] == pytest.approx(-6.0, rel=0.1)
    assert wind[1:] == pytest.approx((0.0, 0.0))


def test_without_motion_one_line_says_so(groom: Groom) -> None:
    with pytest.raises(ringlet.UserError, match=r"^take: nothing has moved in the last 5 s; move the head, .*"):
        recorded(groom, 60)[0].take(groom)
    with pytest.raises(ringlet.UserError, match=r"^take: hair does not move live; press L, and move the head$"):
        TakeRing().take(groom)


def test_another_groom_than_the_one_that_moved_is_refused(groom: Groom) -> None:
    ring, _ = recorded(groom, 20, "nod")
    with pytest.raises(ringlet.UserError, match=r"^take: the groom has changed; keep the take once it is shown .*"):
        ring.take(ringlet.Groom(groom.locks, groom.guides, groom.scalp))


@pytest.mark.parametrize("change", [{"steps": [3, 2]}, {"heads": np.full((2, 12), np.nan)}, {"carrier": [99] * 8}])
def test_a_file_that_holds_no_take_is_refused(groom: Groom, change: dict[str, Any]) -> None:
    take = recorded(groom, 2, "nod")
    values = {name: np.asarray(one) for name, one in vars(take[0].take(groom)).items()}
    values |= {name: np.asarray(one, values[name].dtype) for name, one in change.items()}
    with pytest.raises(ValueError, match="do not fit"):
        LiveTake.from_bytes(LiveTake(**values).to_bytes())
    with pytest.raises(ValueError, match=r"."):
        LiveTake.from_bytes(b"no archive")


def nod(one: Page) -> None:
    """Turns live hair on and nods, until the head has moved."""
    one.latest("measured")
    one.send(kind="go_live", on=True)
    one.receive("live_step")
    one.send(kind="move_head", motion="nod")
    while one.receive("live_step")["head"][6] > -0.2:
        pass


def keep(one: Page, **more: Any) -> dict[str, Any]:
    """Keeps a take; returns its snapshot."""
    one.send(kind="keep_take", look=LOOK, picture=picture(), **more)
    while not (found := one.receive("snapshots")["snapshots"]):
        pass
    return found[-1]


def test_a_take_is_a_snapshot_that_plays_for_all_and_survives_a_restart(folder: Path) -> None:
    with serving(folder, "small.shot.toml") as client, page(client) as one, page(client, "two") as two:
        nod(one)
        taken = keep(two, author="Bo", note="a nod")  # a page that follows may, too
        assert taken["seconds"] > 0.1
        one.receive("snapshots", snapshots=[taken])
    files = folder / "small.review/snapshots"
    assert (files / f"{taken['id']}.shot.toml").read_text() == (folder / "small.shot.toml").read_text()
    with serving(folder, "small.shot.toml") as client, page(client) as one, page(client, "two") as two:
        one.receive("measured")
        one.send(kind="compare", to="snapshot", name=taken["id"], side="b")
        assert one.receive("compared", side="b")["take"] == taken["id"]
        take = one.receive("live_take", id=taken["id"])
        assert (take["side"], take["fps"], take["first"]) == ("b", FPS, None)
        assert len(take["heads"]) == 12 * len(take["steps"]) == 12 * len(take["moved"]) / len(take["points"])
        assert two.receive("live_take")["moved"].tolist() == take["moved"].tolist()
        with page(client, "three") as late:
            assert late.receive("live_take")["id"] == taken["id"]
        one.send(kind="delete_snapshot", id=taken["id"])
        one.receive("snapshots", snapshots=[])
    assert not list(files.iterdir())


def test_no_take_of_another_groom_is_kept(groom: Groom) -> None:
    still, moved = recorded(groom, 0)[0], recorded(groom, 2)[0]
    with pytest.raises(ringlet.UserError, match="hair does not move live"):
        still.take(groom)
    with pytest.raises(ringlet.UserError, match="the groom has changed; keep the take once it is shown in motion"):
        moved.take(copy(groom))
    moved.clear()
    with pytest.raises(ringlet.UserError, match="hair does not move live"):
        moved.take(groom)


def test_what_cannot_be_kept_or_played_is_said_in_one_line(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files = folder / "small.review/snapshots"
    with serving(folder) as client, page(client) as one:
        one.receive("measured")
        one.send(kind="keep_take", look=LOOK, picture=picture())
        assert one.receive_trouble() == "take: hair does not move live; press L, and move the head"
        nod(one)
        with monkeypatch.context() as patched:
            patched.setattr(LiveTake, "to_bytes", full)
            one.send(kind="keep_take", look=LOOK, picture=picture())
            assert re.fullmatch(r".*cannot be written \(No space left on device\); .*", one.receive_trouble())
        assert not list(files.iterdir())
        one.send(kind="set", changes=[[["curl", "width"], 2.0]], gesture=1)
        one.receive("live_step", key=one.receive("rods")["key"])
        nod(one)
        taken = keep(one)
        (files / f"{taken['id']}.take.npz").write_bytes(b"damaged")
        one.send(kind="compare", to="snapshot", name=taken["id"], side="b")
        assert re.fullmatch(r"snapshot: .*\.take\.npz holds no take \(.*\); delete the snapshot", one.receive_trouble())


def full(*_: Any) -> bytes:
    raise ringlet.UserError("a.take.npz: cannot be written (No space left on device); choose another place")
