"""A process that has imported the review and forks a server for each test: what takes seconds is done once.

It answers lines of JSON: ``{"view": FILE, "port": PORT}`` with ``{"pid": PID, "port": PORT}`` as soon as the server
accepts connections, and ``{"kill": PID}`` with ``{}`` when that server has ended. Its servers end with it.
"""

from __future__ import annotations

import gc
import json
import os
import signal
import sys
from importlib import import_module
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit


def main() -> None:
    from ringlet.viewer import edit_lock
    from ringlet.viewer.session import schemas

    import ringlet

    schemas()
    edit_lock.ANSWER_AFTER = 3600.0  # pages answer as the test says, however slow the machine
    ringlet.view  # noqa: B018  imports the server
    for part in ("http.auto", "http.h11_impl", "websockets.auto"):  # which it loads when it starts
        import_module(f"uvicorn.protocols.{part}")
    gc.freeze()  # a collection in a server would copy the pages of all that
    assert len(list(Path("/proc/self/task").iterdir())) == 1, "a process with threads cannot be forked safely"
    servers: set[int] = set()
    for line in sys.stdin:
        asked = json.loads(line)
        if "kill" in asked:
            kill(asked["kill"])
            servers.remove(asked["kill"])
            answer({})
        elif pid := os.fork():
            servers.add(pid)
        else:
            serve(asked["view"], asked["port"])
            return
    for pid in servers:
        kill(pid)


def kill(pid: int) -> None:
    os.kill(pid, signal.SIGKILL)
    os.waitpid(pid, 0)


def serve(file: str, port: int) -> None:
    import ringlet

    nothing = os.open(os.devnull, os.O_RDWR)
    os.dup2(nothing, sys.stdin.fileno())

    def listening(announced: str) -> None:
        address = next(word for word in announced.split() if word.startswith("http"))
        answer({"pid": os.getpid(), "port": urlsplit(address).port})
        os.dup2(nothing, sys.stdout.fileno())

    try:
        ringlet.view(file, port=port, browser=False, told=listening)
    except ringlet.UserError as error:
        answer({"error": str(error)})


def answer(values: dict[str, Any]) -> None:
    sys.stdout.write(json.dumps(values) + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
