"""The Ringlet process of this Blender: started when it is needed, restarted when it ends, polled by a timer."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from . import installation
from .link import Message, RingletProcess

PROTOCOL = 1
MOST_STARTS, WITHIN = 3, 60.0  # a process that ends so often within so many seconds is not started again


@dataclass
class Request:
    """A request without its answer.

    done, failed: called with the answer, or with a line
    lost:         called with a line when the process ended before it answered; ``failed`` by default
    progress:     called with stage, steps done and their number
    warned:       called with a sentence
    canceled:     called with the answer that it was canceled
    """

    done: Callable[[Message], None]
    failed: Callable[[str], None]
    lost: Callable[[str], None] | None = None
    progress: Callable[[str, int, int], None] | None = None
    warned: Callable[[str], None] | None = None
    canceled: Callable[[Message], None] | None = None


class Session:
    """Requests to Ringlet and their answers. No method waits.

    version: of Ringlet; empty before its first answer
    error:   why there is no process; empty while there may be one
    epoch:   number of the process: a new one knows no files of the one before
    """

    def __init__(self) -> None:
        self.version, self.error, self.epoch = "", "", 0
        self._process: RingletProcess | None = None
        self._open: dict[int, Request] = {}
        self._starts: list[float] = []

    @property
    def busy(self) -> bool:
        """Whether an answer is outstanding."""
        return bool(self._open)

    def send(self, do: str, request: Request, arrays: Mapping[str, Any] | None = None, **fields: Any) -> int:
        """Sends a request; 0 where there is no process, and ``failed`` has been called with the reason."""
        process = self._running()
        if process is None:
            request.failed(self.error)
            return 0
        number = process.send(do, arrays, **fields)
        self._open[number] = request
        return number

    def cancel(self, number: int) -> None:
        """Cancels a request that is not answered."""
        if self._process is not None and number in self._open:
            self._process.send("cancel", request=number)

    def poll(self) -> None:
        """Takes the answers that have arrived, and notices a process that has ended."""
        process = self._process
        if process is None:
            return
        for message in process.poll():
            self._take(message)
        if not process.alive and process is self._process:
            self._process = None
            lost, self._open = self._open, {}
            why = process.last_words or "it was ended from outside"
            for request in lost.values():
                (request.lost or request.failed)(f"Ringlet ended ({why[:200]}); it is started again")

    def stop(self) -> None:
        """Ends the process."""
        if self._process is not None:
            self._process.stop()
        self._process, self._open, self.version = None, {}, ""

    def retry(self) -> None:
        """Forgets failed starts, so that the next request starts a process."""
        self._starts, self.error = [], ""

    def _running(self) -> RingletProcess | None:
        if self._process is not None and self._process.alive:
            return self._process
        now = time.monotonic()
        self._starts = [start for start in self._starts if now - start < WITHIN]
        if len(self._starts) >= MOST_STARTS:
            self.error = f"Ringlet ended {MOST_STARTS} times within a minute; mend the installation and press Restart"
            return None
        command = installation.command()
        if command is None:
            self.error = "Ringlet is not installed: choose its command or install it in the extension's preferences"
            return None
        try:
            self._process = RingletProcess([*command, "serve"], clean_environment())
        except OSError as error:
            self.error = (
                f"{command[0]}: cannot be started ({error.strerror}); choose another command in the preferences"
            )
            return None
        self._starts.append(now)
        self.epoch, self.error = self.epoch + 1, ""
        self._open[self._process.send("hello")] = Request(self._greeted, self._set_error)
        return self._process

    def _greeted(self, message: Message) -> None:
        self.version = message.header["version"]
        if message.header["protocol"] != PROTOCOL:
            self.stop()
            self._starts = [time.monotonic()] * MOST_STARTS
            self.error = f"Ringlet {message.header['version']} does not fit this extension; install the same version"

    def _set_error(self, line: str) -> None:
        self.error = line

    def _take(self, message: Message) -> None:
        header = message.header
        request = self._open.get(header.get("id"))
        if request is None:
            return
        kind = header["kind"]
        if kind == "progress":
            if request.progress:
                request.progress(header["stage"], header["done"], header["total"])
        elif kind == "warning":
            if request.warned:
                request.warned(header["message"])
        else:
            del self._open[header["id"]]
            if kind == "result":
                request.done(message)
            elif kind == "canceled" and request.canceled:
                request.canceled(message)
            elif kind == "error":
                request.failed(header["message"])


def clean_environment() -> dict[str, str]:
    """The environment without the variables by which another Python would load Blender's libraries."""
    return {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}


session = Session()
