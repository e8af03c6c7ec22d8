"""The review server, and pages without a browser."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from fastapi.testclient import TestClient
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import VERSION
from ringlet.viewer.server import AccessControl, make_app
from ringlet.viewer.session import Session
from ringlet.viewer.wire import split
from starlette.testclient import WebSocketTestSession

HOST = {"host": "localhost"}


class Page:
    """A connected page without a browser; collects the messages that it receives."""

    def __init__(self, socket: WebSocketTestSession) -> None:
        self.socket = socket
        self.received: list[dict[str, Any]] = []

    def send(self, **message: Any) -> None:
        text = json.dumps(message).encode()
        self.socket.send_bytes(struct.pack("<I", len(text)) + text)

    def receive(self, kind: str, **wanted: Any) -> dict[str, Any]:
        """Waits for the next message of a kind with the wanted values."""
        for _ in range(200):
            message = read(self.socket.receive_bytes())
            self.received.append(message)
            if message["kind"] == kind and all(message[name] == value for name, value in wanted.items()):
                return message
            assert message["kind"] != "trouble", message["message"]
        raise AssertionError(f"no {kind} among {[m['kind'] for m in self.received]}")

    def receive_trouble(self) -> str:
        """Waits for the next error message."""
        return self.receive("trouble")["message"]

    def watch(self, *frames: float) -> list[dict[str, Any]]:
        """Waits until frames are simulated, requests them and returns them."""
        timeline = self.latest("timeline")
        while not set(frames) <= set(timeline["frames"].tolist()):
            timeline = self.receive("timeline")
        self.send(kind="watch", shot=frames)
        return [self.receive("frame") for _ in frames]

    def latest(self, kind: str, **wanted: Any) -> dict[str, Any]:
        """The latest message of a kind with the wanted values, or the next one; kinds arrive in any order."""
        for message in reversed(self.received):
            if message["kind"] == kind and all(message[name] == value for name, value in wanted.items()):
                return message
        return self.receive(kind, **wanted)


def read(data: bytes) -> dict[str, Any]:
    header, arrays = split(data)
    return {**header, **arrays}


@contextmanager
def serving(folder: Path, file: str = "small.recipe.toml", access: AccessControl | None = None) -> Iterator[TestClient]:
    session = Session(folder / file, Project(folder))
    with TestClient(make_app(session, access or AccessControl("127.0.0.1", "")), base_url="http://localhost") as client:
        yield client


@contextmanager
def page(client: TestClient, name: str = "one", hello: bool = True, **headers: str) -> Iterator[Page]:
    with client.websocket_connect("/session", headers={**HOST, **headers}) as socket:
        found = Page(socket)
        if hello:
            found.send(kind="hello", version=VERSION, client=name)
        yield found
