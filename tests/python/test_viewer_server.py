"""What the server lets in, what it answers, and what it never reads."""

from __future__ import annotations

import json
import struct
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient
from ringlet.errors import UserError
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import VERSION
from ringlet.viewer.server import REFUSED, WRONG, Door, make_app
from ringlet.viewer.session import Session
from ringlet.viewer.wire import MOST
from small_example import write_example
from starlette.testclient import WebSocketTestSession
from starlette.websockets import WebSocketDisconnect

HOST = {"host": "localhost"}


class Page:
    """A page without a browser."""

    def __init__(self, socket: WebSocketTestSession) -> None:
        self.socket = socket
        self.heard: list[dict[str, Any]] = []

    def say(self, **message: Any) -> None:
        text = json.dumps(message).encode()
        self.socket.send_bytes(struct.pack("<I", len(text)) + text)

    def hear(self, kind: str, **wanted: Any) -> dict[str, Any]:
        """The next message of a kind that has the wanted values."""
        for _ in range(200):
            message = read(self.socket.receive_bytes())
            self.heard.append(message)
            if message["kind"] == kind and all(message[name] == value for name, value in wanted.items()):
                return message
        raise AssertionError(f"no {kind} among {[m['kind'] for m in self.heard]}")

    def been_told(self, kind: str, **wanted: Any) -> dict[str, Any]:
        """The same, of those that were heard already, too: subjects come in no order of their own."""
        for message in reversed(self.heard):
            if message["kind"] == kind and all(message[name] == value for name, value in wanted.items()):
                return message
        return self.hear(kind, **wanted)


def read(data: bytes) -> dict[str, Any]:
    length = struct.unpack_from("<I", data)[0]
    message = json.loads(data[4 : 4 + length])
    at = 4 + length
    for name, kind, size in message.pop("arrays"):
        message[name] = np.frombuffer(data, np.dtype(kind), size, at)
        at += -(-size * np.dtype(kind).itemsize // 8) * 8
    return message


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_example(tmp_path / "project")


@contextmanager
def serving(folder: Path, file: str = "small.recipe.toml", door: Door | None = None) -> Iterator[TestClient]:
    session = Session(folder / file, Project(folder))
    with TestClient(make_app(session, door or Door("127.0.0.1", "")), base_url="http://localhost") as client:
        yield client


@contextmanager
def page(client: TestClient, name: str = "one", hello: bool = True, **headers: str) -> Iterator[Page]:
    with client.websocket_connect("/session", headers={**HOST, **headers}) as socket:
        found = Page(socket)
        if hello:
            found.say(kind="hello", version=VERSION, client=name)
        yield found


def closed_with(client: TestClient, url: str = "/session", **headers: str) -> int:
    with (
        client.websocket_connect(url, headers={**HOST, **headers}) as socket,
        pytest.raises(WebSocketDisconnect) as end,
    ):
        socket.receive_bytes()
    return end.value.code


def test_a_page_is_told_all_there_is(folder: Path):
    with serving(folder) as client, page(client) as one:
        welcome = one.hear("welcome")
        assert one.heard[0]["kind"] == "welcome" and welcome["mode"] == "recipe"
        document, locks = one.hear("document"), one.hear("locks")
        assert document["said"]["curl"]["width"] == 1.0
        assert document["values"]["curl"]["width"]["value"] == pytest.approx(0.01)
        assert len(locks["ids"]) == 8 and locks["points"].shape == (8 * 40 * 3,)
        assert one.hear("numbers", draft=False)["hairs"] == 24


def test_an_edit_changes_the_groom_and_the_document_and_saving_writes_it(folder: Path):
    with serving(folder) as client, page(client) as one:
        before = one.hear("locks")["points"]
        one.hear("numbers")
        one.say(kind="set", changes=[[["curl", "width"], 2.0]], gesture=1)
        assert one.hear("document")["dirty"]
        after = one.hear("locks", draft=False)["points"]
        assert np.abs(after - before).max() > 0.002
        one.say(kind="undo")
        assert np.allclose(one.hear("locks", draft=False)["points"], before)
        one.say(kind="redo")
        one.say(kind="save")
        one.hear("saved")
        assert "width = 2.0" in (folder / "small.recipe.toml").read_text()


def test_hairs_come_in_an_order_of_which_the_beginning_is_spread_over_the_locks(folder: Path):
    with serving(folder) as client, page(client) as one:
        hairs = one.hear("hairs")
        assert sorted(hairs["lock"][:8]) == list(range(8))
        assert np.all(hairs["offset"][:16] == 0.0) and np.any(hairs["offset"][16:] != 0.0)


def test_muting_leaves_the_file_alone(folder: Path):
    with serving(folder) as client, page(client) as one:
        curled = one.hear("locks")["points"]
        one.hear("numbers")
        one.say(kind="mute", stages=["curl"])
        assert not one.hear("document")["dirty"]
        assert np.abs(one.hear("locks", draft=False)["points"] - curled).max() > 0.002


def test_one_leads_and_the_others_follow(folder: Path):
    with serving(folder) as client, page(client, "one") as one, page(client, "two") as two:
        assert one.hear("role", leads=True) and two.hear("role", leads=False)
        two.say(kind="set", changes=[[["curl", "width"], 2.0]], gesture=1)
        assert "leads" in two.hear("trouble")["message"]
        one.say(kind="set", changes=[[["curl", "width"], 1.4]], gesture=1)
        assert two.hear("document", dirty=True)["said"]["curl"]["width"] == 1.4
        two.say(kind="lead")
        assert two.hear("role", leads=True) and one.hear("role", leads=False)


def test_a_wrong_token_and_a_foreign_origin_are_refused(folder: Path):
    door = Door("127.0.0.1", "secret")
    with serving(folder, door=door) as client:
        assert closed_with(client) == REFUSED
        assert closed_with(client, "/session?token=wrong") == REFUSED
        assert closed_with(client, "/session?token=secret", origin="http://elsewhere.example") == REFUSED
        url = "/session?token=secret"
        with client.websocket_connect(url, headers={**HOST, "origin": "http://localhost"}) as socket:
            one = Page(socket)
            one.say(kind="hello", version=VERSION, client="one")
            assert one.hear("welcome")


def test_a_name_that_is_not_ours_gets_nothing(folder: Path):
    with serving(folder) as client:
        assert client.get("/", headers={"host": "rebound.example"}).status_code == 421
        assert closed_with(client, host="rebound.example") == REFUSED


def test_nothing_but_a_hello_opens_the_talk(folder: Path):
    with serving(folder) as client, client.websocket_connect("/session", headers=HOST) as socket:
        Page(socket).say(kind="undo")
        with pytest.raises(WebSocketDisconnect) as end:
            socket.receive_bytes()
        assert end.value.code == WRONG


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\1\0",
        struct.pack("<I", 400) + b"{}",
        struct.pack("<I", 2) + b"{}",
        struct.pack("<I", 4) + b"\xff\xfe\xfd\xfc",
        b"\0" * (MOST + 1),
    ],
)
def test_malformed_messages_are_told_and_do_no_harm(folder: Path, data: bytes):
    with serving(folder) as client, page(client) as one:
        one.socket.send_bytes(data)
        assert one.hear("trouble")["message"].startswith("message:")
        one.say(kind="set", changes=[[["curl", "width"], 1.5]], gesture=1)
        assert one.hear("document", dirty=True)


def test_edits_that_make_no_sense_are_told_in_one_line(folder: Path):
    with serving(folder) as client, page(client) as one:
        for changes in ([[["curl", "width"], -3]], [[["nothing", "here"], 1]], [[[], 1]], [[["shape", 4, "size"], 1]]):
            one.say(kind="set", changes=changes, gesture=1)
            message = one.hear("trouble")["message"]
            assert "\n" not in message and "mistake in Ringlet" not in message
        one.say(kind="redo")
        one.say(kind="set", changes=[[["curl", "width"], 1.5]], gesture=1)
        assert one.hear("document", dirty=True)["said"]["curl"]["width"] == 1.5


@pytest.mark.parametrize(
    "change",
    [["scalp", "file"], ["extends"], ["edits"], ["guides", "file"], ["maps", "stiff"], ["curves", "tie", "file"]],
)
@pytest.mark.parametrize("outside", ["../other.usda", "/etc/passwd", "link.usda"])
def test_files_outside_of_the_project_are_never_read(folder: Path, change: list[str], outside: str):
    (folder.parent / "other.usda").write_text("#usda 1.0\n")
    (folder / "link.usda").symlink_to(folder.parent / "other.usda")
    with serving(folder) as client, page(client) as one:
        one.say(kind="set", changes=[[change, outside]], gesture=1)
        message = one.hear("trouble")["message"]
        assert "outside of the project" in message or "not a setting" in message


@pytest.mark.parametrize("name", ["../new", "/tmp/new", ".hidden", "a/b"])
def test_nothing_is_written_outside_of_the_project(folder: Path, name: str):
    before = sorted(folder.parent.rglob("*"))
    with serving(folder) as client, page(client) as one:
        one.say(kind="save", name=name)
        assert "save" in one.hear("trouble")["message"]
    assert sorted(folder.parent.rglob("*")) == before


def test_a_variant_says_only_what_differs(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.say(kind="set", changes=[[["curl", "width"], 1.5]], gesture=1)
        one.say(kind="save", name="wide", variant=True)
        one.hear("saved")
    text = (folder / "wide.recipe.toml").read_text()
    assert 'extends = "small.recipe.toml"' in text and "width = 1.5" in text and "pitch" not in text


def test_a_server_that_was_started_anew_takes_back_what_a_page_still_had(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.say(kind="set", changes=[[["curl", "width"], 1.7]], gesture=1)
        text = one.hear("document", dirty=True)["text"]
    with serving(folder) as client, page(client) as one:
        assert not one.hear("document")["dirty"]
        one.say(kind="restore", text=text)
        document = one.hear("document", dirty=True)
        assert document["said"]["curl"]["width"] == 1.7 and document["undo"]


def test_while_a_hand_moves_drafts_are_made_and_the_whole_when_it_rests(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.hear("numbers", draft=False)
        one.say(kind="set", changes=[[["curl", "width"], 1.5]], gesture=1, resting=False)
        assert one.hear("locks")["draft"]
        time.sleep(0.05)
        one.say(kind="set", changes=[[["curl", "width"], 1.6]], gesture=1)
        assert one.hear("locks", draft=False)
        one.say(kind="undo")
        assert one.hear("document", dirty=False)


def test_a_file_outside_of_the_project_is_not_opened(folder: Path):
    with pytest.raises(UserError, match="outside of the project"):
        Session(folder / "small.recipe.toml", Project(folder / "elsewhere"))


def test_a_shot_runs_and_its_frames_come(folder: Path):
    with serving(folder, "small.shot.toml") as client, page(client) as one:
        assert one.hear("welcome")["mode"] == "shot"
        one.been_told("timeline", state="still")
        one.say(kind="play", action="start")
        frames = [one.hear("frame") for _ in range(4)]
        assert [frame["frame"] for frame in frames] == [1, 2, 3, 4]
        assert frames[0]["points"].shape == (8 * 40 * 3,) and np.all(frames[0]["overlay"] <= 1.0)
        assert np.abs(frames[3]["points"] - frames[0]["points"]).max() > 1e-3
        one.been_told("timeline", state="done")
        one.say(kind="set", file="shot", changes=[[["strands", "bend_scale"], 30.0]], gesture=1)
        one.say(kind="play", action="again_from", frame=2)
        again = [one.hear("frame") for _ in range(2)]
        assert [frame["frame"] for frame in again] == [3, 4]
        assert np.abs(again[1]["points"] - frames[3]["points"]).max() > 1e-6


def test_a_groom_and_its_cache_are_shown_as_they_are(folder: Path):
    import ringlet

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
        assert one.hear("frame", frame=4)["points"].shape == (8 * 40 * 3,)
        assert one.been_told("timeline", state="none")["last"] == 4


def test_a_lock_that_is_not_isolated_is_not_dragged(folder: Path):
    with serving(folder) as client, page(client) as one:
        lock = int(one.hear("locks")["ids"][0])
        one.hear("numbers")
        one.say(kind="drag", lock=lock, point=20, to=[0, 0.2, 0], gesture=1)
        assert "isolate" in one.hear("trouble")["message"]
        one.say(kind="isolate", locks=[lock])
        assert one.hear("locks", draft=False)["marked"][0] == 1
        one.say(kind="isolate", locks=[lock], out=False)
        assert one.hear("locks", draft=False)["marked"][0] == 0
