"""The review server: access, errors and files outside the project."""

from __future__ import annotations

import json
import random
import struct
import threading
import time
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient
from pages import HOST, Page, page, serving
from ringlet.data.errors import UserError, line_of
from ringlet.viewer import protocol
from ringlet.viewer.edit.manipulator import LockManipulator
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import VERSION
from ringlet.viewer.server import REFUSED, WRONG, AccessControl
from ringlet.viewer.session import Session
from ringlet.viewer.wire import MOST, unpack
from starlette.websockets import WebSocketDisconnect


def closed_with(client: TestClient, url: str = "/session", **headers: str) -> int:
    with (
        client.websocket_connect(url, headers={**HOST, **headers}) as socket,
        pytest.raises(WebSocketDisconnect) as end,
    ):
        socket.receive_bytes()
    return end.value.code


def test_a_new_page_receives_document_locks_and_counts(folder: Path):
    with serving(folder) as client, page(client) as one:
        welcome = one.receive("welcome")
        assert one.received[0]["kind"] == "welcome" and welcome["mode"] == "recipe"
        document, locks = one.receive("document"), one.receive("locks")
        assert document["said"]["curl"]["width"] == 1.0
        assert document["values"]["curl"]["width"]["value"] == pytest.approx(0.01)
        assert len(locks["ids"]) == 8 and locks["points"].shape == (8 * 40 * 3,)
        assert one.receive("numbers", draft=False)["hairs"] == 24


def test_a_wrong_token_and_a_foreign_origin_are_refused(folder: Path):
    access = AccessControl("127.0.0.1", "secret")
    with serving(folder, access=access) as client:
        assert closed_with(client) == REFUSED
        assert closed_with(client, "/session?token=wrong") == REFUSED
        for origin in ("http://elsewhere.example", "http://[", "http://[::1", "null", ""):
            assert closed_with(client, "/session?token=secret", origin=origin) == REFUSED
        url = "/session?token=secret"
        with client.websocket_connect(url, headers={**HOST, "origin": "http://localhost"}) as socket:
            one = Page(socket)
            one.send(kind="hello", version=VERSION, client="one")
            assert one.receive("welcome")


def test_a_foreign_host_name_is_refused(folder: Path):
    with serving(folder) as client:
        assert client.get("/", headers={"host": "rebound.example"}).status_code == 421
        assert closed_with(client, host="rebound.example") == REFUSED


def test_a_connection_starts_with_hello(folder: Path):
    with serving(folder) as client, client.websocket_connect("/session", headers=HOST) as socket:
        Page(socket).send(kind="undo")
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
def test_malformed_messages_are_refused_and_the_session_continues(folder: Path, data: bytes):
    with serving(folder) as client, page(client) as one:
        one.socket.send_bytes(data)
        assert one.receive("trouble")["message"].startswith("message:")
        one.send(kind="set", changes=[[["curl", "width"], 1.5]], gesture=1)
        assert one.receive("document", dirty=True)


@pytest.mark.parametrize("error", [RecursionError("deep"), KeyError("x"), RuntimeError("Symlink loop from 'a'")])
def test_no_error_of_a_message_ends_the_connection(folder: Path, monkeypatch, error: Exception):
    def fail(*_):
        raise error

    monkeypatch.setattr(LockManipulator, "isolate", fail)
    with serving(folder) as client, page(client) as one:
        one.send(kind="isolate", locks=[1])
        assert one.receive_trouble()
        one.send(kind="set", changes=[[["curl", "width"], 1.5]], gesture=1)
        assert one.receive("document", dirty=True)


def some_value(rng: random.Random, schema: dict, definitions: dict) -> Any:
    """A value of a schema, sometimes another one."""
    if rng.random() < 0.05:
        return rng.choice([None, True, [], {}, "x", 1.5, [[]]])
    if "$ref" in schema:
        return some_value(rng, definitions[schema["$ref"].rpartition("/")[2]], definitions)
    if "const" in schema or "enum" in schema:
        return schema.get("const", rng.choice(schema.get("enum", [None])))
    if choices := schema.get("anyOf", schema.get("oneOf")):
        return some_value(rng, rng.choice(choices), definitions)
    if "prefixItems" in schema:
        return [some_value(rng, one, definitions) for one in schema["prefixItems"]]
    texts = ["", "a", "\0", "x" * 300, "../x", "loop", "curl", "width", "shape", "é\n", ".", "small.recipe.toml"]
    match schema.get("type"):
        case "object":
            given = schema.get("properties", {}).items()
            needed = schema.get("required", ())
            return {k: some_value(rng, v, definitions) for k, v in given if k in needed or rng.random() < 0.5}
        case "array":
            return [some_value(rng, schema.get("items", {}), definitions) for _ in range(rng.randrange(3))]
        case "integer":
            return rng.choice([0, 1, -1, 2**31, 2**64])
        case "number":
            return rng.choice([0, -1, 0.5, 1e308])
        case "boolean":
            return rng.random() < 0.5
    return rng.choice(texts)


def test_messages_of_any_values_are_handled_or_refused_in_one_line(folder: Path):
    (folder / "loop").symlink_to("loop")
    schema, rng = protocol.FROM_PAGE.json_schema(), random.Random(53)
    kinds = [one["$ref"].rpartition("/")[2] for one in schema["oneOf"]]
    kinds = [kind for kind in kinds if kind not in ("Hello", "Render", "Share", "Proceed")]
    session = Session(folder / "small.recipe.toml", Project(folder))
    one, refused = session.submit(session.join, "one").result(), 0
    for _ in range(400):
        kind = rng.choice(kinds)
        text = json.dumps(some_value(rng, schema["$defs"][kind], schema["$defs"])).encode()
        try:
            session.submit(session.handle, one, unpack(struct.pack("<I", len(text)) + text)).result()
        except Exception as error:
            message = line_of(error)
            assert message is not None and "\n" not in message, (kind, text, error)
            refused += 1
    assert 100 < refused < 400
    session.stop()


def test_invalid_edits_are_refused_in_one_line(folder: Path):
    with serving(folder) as client, page(client) as one:
        for changes in ([[["curl", "width"], -3]], [[["nothing", "here"], 1]], [[[], 1]], [[["shape", 4, "size"], 1]]):
            one.send(kind="set", changes=changes, gesture=1)
            message = one.receive("trouble")["message"]
            assert "\n" not in message and "mistake in Ringlet" not in message
        one.send(kind="redo")
        one.send(kind="set", changes=[[["curl", "width"], 1.5]], gesture=1)
        assert one.receive("document", dirty=True)["said"]["curl"]["width"] == 1.5


def test_locks_that_do_not_exist_are_refused_at_once(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.receive("numbers", draft=False)
        begin = time.monotonic()
        one.send(kind="isolate", locks=list(range(10**12, 10**12 + 1000)))
        assert "there is no lock 1000000000" in one.receive_trouble()
        assert time.monotonic() - begin < 2.0
        for lock in (2**80, 0.5):
            one.send(kind="isolate", locks=[lock])
            assert one.receive_trouble().startswith("message: ")
        assert not one.latest("document")["dirty"]


def test_all_locks_are_isolated_and_returned_in_one_step_each(folder: Path):
    with serving(folder) as client, page(client) as one:
        locks = one.receive("locks")["ids"].astype(int).tolist()
        one.receive("numbers", draft=False)
        one.send(kind="isolate", locks=locks * 2)
        assert len(one.receive("document", dirty=True)["said"]["edit"]) == len(locks)
        one.send(kind="undo")
        assert "edit" not in one.receive("document", dirty=False)["said"]
        one.send(kind="redo")
        one.receive("document", dirty=True)
        one.send(kind="isolate", locks=locks, out=False)
        assert "edit" not in one.receive("document")["said"]


def test_a_long_message_blocks_neither_the_server_nor_its_end(folder: Path, monkeypatch):
    release = threading.Event()
    monkeypatch.setattr(LockManipulator, "isolate", lambda *_: release.wait())
    monkeypatch.setattr("ringlet.viewer.server.LONG", 0.1)
    begin = time.monotonic()
    with serving(folder) as client, page(client) as one:
        one.send(kind="isolate", locks=[1])
        assert one.receive_trouble() == "message: isolate takes over 0.1 s; it is still worked on"
        assert client.get("/none", headers=HOST).status_code == 404
    assert time.monotonic() - begin < 10.0  # the end of the server does not wait for it
    release.set()


@pytest.mark.parametrize("name", ["gone.recipe.toml", "head.usda", "small.shot.toml", ""])
def test_a_recipe_to_compare_with_that_cannot_be_read_is_refused(folder: Path, name: str):
    with serving(folder) as client, page(client) as one:
        one.receive("numbers", draft=False)
        one.send(kind="compare", to="file", name=name)
        message = one.receive_trouble()
        assert (name or folder.name) in message and "mistake" not in message
        one.send(kind="compare", to="saved")
        assert one.receive("locks", side="b")


@pytest.mark.parametrize(
    "change",
    [["scalp", "file"], ["extends"], ["edits"], ["guides", "file"], ["maps", "stiff"], ["curves", "tie", "file"]],
)
@pytest.mark.parametrize("outside", ["../other.usda", "/etc/passwd", "link.usda"])
def test_files_outside_the_project_are_not_read(folder: Path, change: list[str], outside: str):
    (folder.parent / "other.usda").write_text("#usda 1.0\n")
    (folder / "link.usda").symlink_to(folder.parent / "other.usda")
    with serving(folder) as client, page(client) as one:
        one.send(kind="set", changes=[[change, outside]], gesture=1)
        message = one.receive("trouble")["message"]
        assert "outside of the project" in message or "not a setting" in message


@pytest.mark.parametrize("name", ["../new", "/tmp/new", ".hidden", "a/b"])
def test_no_file_is_written_outside_the_project(folder: Path, name: str):
    before = sorted(folder.parent.rglob("*"))
    with serving(folder) as client, page(client) as one:
        one.send(kind="save", name=name)
        assert "save" in one.receive("trouble")["message"]
    assert sorted(folder.parent.rglob("*")) == before


def test_a_file_outside_the_project_is_not_opened(folder: Path):
    with pytest.raises(UserError, match="outside of the project"):
        Session(folder / "small.recipe.toml", Project(folder / "elsewhere"))
