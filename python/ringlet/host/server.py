"""Answers the requests of a host: grooms on one thread, shots on another, so that either may go on meanwhile."""

from __future__ import annotations

import os
import threading
from importlib.metadata import version
from typing import Any, BinaryIO

from ringlet.data.errors import UserError, one_line
from ringlet.data.reads import unrecorded
from ringlet.host import grooms, requests, scene_files, shots, texts
from ringlet.host.link import BrokenMessage, Message, read_message, write_message
from ringlet.viewer.worker import SerialWorker, report_mistake

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
        try:
            while (message := read_message(self._source)) is not None:
                self._take(message)
        except BrokenMessage as error:
            self._write({"id": None, "kind": "error", "message": str(error)})
        for canceled in list(self._canceled.values()):
            canceled.set()

    def _take(self, message: Message) -> None:
        number = message.header.get("id")
        try:
            request = requests.parse_request(message.header)
        except UserError as error:
            self._write({"id": number, "kind": "error", "message": str(error)})
            return
        if isinstance(request, requests.Cancel):
            if canceled := self._canceled.get(request.request):
                canceled.set()
            return
        self._canceled[request.id] = threading.Event()
        self._workers[isinstance(request, LONG)].post(self._answer, request, message.arrays)

    def _answer(self, request: requests.AnyRequest, arrays: dict[str, Any]) -> None:
        canceled = self._canceled[request.id]
        answer: dict[str, Any]
        made: dict[str, Any] = {}
        try:
            with unrecorded():  # a host writes its files again and again
                if canceled.is_set():
                    raise Canceled
                answer, made = self._do(request, arrays, canceled)
            answer = {"kind": "result", **answer}
        except Canceled:
            answer = {"kind": "canceled"}
            if isinstance(request, requests.Simulate):
                answer["left"] = shots.left_steps(request.folder, request.cache)
        except UserError as error:
            answer = {"kind": "error", "message": str(error)}
        except OSError as error:
            place = f"{error.filename}: " if error.filename else ""
            answer = {"kind": "error", "message": one_line(f"{place}{error.strerror or error}; check the place")}
        except MemoryError:
            answer = {"kind": "error", "message": "memory ran out; ask for fewer locks, hairs or frames"}
        except Exception as error:
            answer = {"kind": "error", "message": one_line(report_mistake("a request could not be answered", error))}
        del self._canceled[request.id]
        self._write({"id": request.id, **answer}, made)

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
        with self._writing:
            write_message(self._answers, header, arrays)

    def stop(self, patience: float) -> None:
        """Waits for the requests in progress, for each thread up to ``patience`` [s]."""
        for worker in self._workers:
            worker.stop(patience)


def serve(source: BinaryIO, answers: BinaryIO, *, patience: float = 5.0) -> None:
    """Answers the requests of another program until ``source`` ends; docs/host.md has the messages.

    patience: how long to wait then for the frame in progress [s]
    """
    server = Server(source, answers)
    try:
        server.run()
        server.stop(patience)
    except BrokenPipeError:  # the host has ended
        os._exit(1)
