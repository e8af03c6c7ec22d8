"""What the server lets in, what it answers, and what it never reads."""

from __future__ import annotations

import struct
from pathlib import Path

import pytest
from fastapi.testclient import TestClient
from pages import HOST, Page, page, serving
from ringlet.data.errors import UserError
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import VERSION
from ringlet.viewer.server import REFUSED, WRONG, Door
from ringlet.viewer.session import Session
from ringlet.viewer.wire import MOST
from starlette.websockets import WebSocketDisconnect


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


def test_a_file_outside_of_the_project_is_not_opened(folder: Path):
    with pytest.raises(UserError, match="outside of the project"):
        Session(folder / "small.recipe.toml", Project(folder / "elsewhere"))
