"""Answers the requests of a host: grooms on one thread, shots on another, so that either may go on meanwhile."""

from __future__ import annotations

import os
import threading
from importlib.metadata import version
from typing import Any, BinaryIO

from ringlet.data.errors import UserError, failure, one_line
from ringlet.data.explain import shown
from ringlet.data.reads import unrecorded
from ringlet.host import grooms, requests, scene_files, shots, texts
from ringlet.host.link import BrokenMessage, Message, read_message, write_message
from ringlet.viewer.worker import SerialWorker

PROTOCOL = 1  # version of the messages
LONG = (requests.Simulate, requests.Hairs)
Answer = tuple[dict[str, Any], dict[str, Any]]


class Canceled(Exception):
    """Raised inside a request that was canceled."""


class Server:
    """Reads requests until its input ends, and answers each once: ``result``, ``error`` or ``canceled``.

    In between a request is answered with ``progress`` and ``warning``.
    """

    def __init__(self, source: BinaryIO, answers: BinaryIO) -> None:
        self._source, self._answers = source, answers
        self._writing = threading.Lock()
        self._canceled: dict[int, threading.Event] = {}
        self._groomer = grooms.Groomer()
        self._workers = SerialWorker("grooms"), SerialWorker("shots")

    def run(self) -> None:
        """Answers until the input ends; then what is in progress is canceled."""
        while self.take_next():
            pass
        for canceled in list(self._canceled.values()):
            canceled.set()

    def take_next(self) -> bool:
        """Takes the next message, whatever it is; returns whether there was one."""
        number = None
        try:
            message = read_message(self._source)
            if message is None:
                return False
            number = message.header.get("id")
            self._take(message)
        except BrokenMessage as error:
            self._fail(error.id, error)
        except Exception as error:
            self._fail(number, error)
        return True

    def _take(self, message: Message) -> None:
        request = requests.parse_request(message.header)
        if isinstance(request, requests.Cancel):
            if canceled := self._canceled.get(request.request):
                canceled.set()
            return
        if request.id in self._canceled:
            raise UserError(f"request: id {shown(request.id)} is that of a request in progress; give another")
        self._canceled[request.id] = threading.Event()
        self._workers[isinstance(request, LONG)].post(self._answer, request, message.arrays)

    def _answer(self, request: requests.AnyRequest, arrays: dict[str, Any]) -> None:
        canceled = self._canceled[request.id]
        answer: dict[str, Any]
        try:
            try:
                with unrecorded():  # a host writes its files again and again
                    if canceled.is_set():
                        raise Canceled
                    answer, made = self._do(request, arrays, canceled)
                answer = {"kind": "result", **answer}
            except Canceled:
                answer, made = {"kind": "canceled"}, {}
                if isinstance(request, requests.Simulate):
                    answer["left"] = shots.left_steps(request.folder, request.cache)
            del self._canceled[request.id]
            self._write({"id": request.id, **answer}, made)
        except Exception as error:
            self._canceled.pop(request.id, None)
            self._fail(request.id, error)

    def _fail(self, number: Any, error: Exception) -> None:
        """Answers that a message could not be taken, or a request not be answered."""
        is_id = isinstance(number, int) and not isinstance(number, bool)
        message = str(error) if isinstance(error, BrokenMessage) else failure("a request could not be answered", error)
        self._write({"id": number if is_id else None, "kind": "error", "message": message})

    def _do(self, request: requests.AnyRequest, arrays: dict[str, Any], canceled: threading.Event) -> Answer:
        def progress(stage: str, done: int, total: int) -> None:
            if canceled.is_set():
                raise Canceled
            self._write({"id": request.id, "kind": "progress", "stage": stage, "done": done, "total": total})

        def warn(sentence: str) -> None:
            self._write({"id": request.id, "kind": "warning", "message": one_line(sentence)})

        match request:
            case requests.Hello():
                return {"version": version("ringlet"), "protocol": PROTOCOL, "looks": texts.looks()}, {}
            case requests.Look():
                return {"text": texts.look(request.name)}, {}
            case requests.WriteMeshes():
                return scene_files.write_meshes(request, arrays), {}
            case requests.WriteCurves():
                return scene_files.write_curves(request, arrays), {}
            case requests.Edit():
                document = texts.apply(request.kind, request.text, request.folder)
                return {"text": document.text, "settings": texts.settings(document.model)}, {}
            case requests.Groom():
                return self._groomer.make(request, progress)
            case requests.WriteGroom():
                return grooms.write(request, progress), {}
            case requests.Simulate():
                return shots.simulate(request, progress, warn), {}
            case requests.Hairs():
                return shots.write_hairs(request, progress), {}
            case requests.Cancel():
                raise AssertionError("is answered when it is read")

    def _write(self, header: dict[str, Any], arrays: dict[str, Any] | None = None) -> None:
        try:
            with self._writing:
                write_message(self._answers, header, arrays)
        except BrokenPipeError:  # the host has ended
            os._exit(1)

    def stop(self, patience: float) -> None:
        """Waits for the requests in progress, for each thread up to ``patience`` [s]."""
        for worker in self._workers:
            worker.stop(patience)


def serve(source: BinaryIO, answers: BinaryIO, *, patience: float = 5.0) -> None:
    """Answers the requests of another program until ``source`` ends; docs/host.md has the messages.

    patience: how long to wait then for the frame in progress [s]
    """
    server = Server(source, answers)
    server.run()
    server.stop(patience)
