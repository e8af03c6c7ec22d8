"""The link between a host, such as Blender, and a Ringlet process: the format of messages, and the process.

Needs the standard library and numpy alone, and nothing else of Ringlet: the Python of a host cannot load Ringlet, so
extensions for hosts contain a copy of this file.

A message is a line of JSON, an object, and then the bytes of its arrays: ``arrays`` lists their name, type and shape in
the order in which they follow, little-endian and without gaps.
"""

from __future__ import annotations

import json
import math
import os
import queue
import subprocess
import tempfile
import threading
from collections.abc import Mapping, Sequence
from typing import IO, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

TYPES = ("<f4", "<f8", "<i4", "<i8")
MOST_HEADER = 64_000_000  # bytes of the line of a message
MOST_VALUES = 2**31  # of an array
MOST_AXES = 8


class Message(NamedTuple):
    """A request or an answer: its JSON object without ``arrays``, and its arrays by name."""

    header: dict[str, Any]
    arrays: dict[str, NDArray[Any]]


class BrokenMessage(Exception):
    """Bytes that are no message, up to the end of a line. id: that of the message, where it has one"""

    def __init__(self, reason: str, id: Any = None) -> None:
        super().__init__(reason)
        self.id = id


def write_message(
    stream: IO[bytes], header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]] | None = None
) -> None:
    """Writes a message. Arrays of other types than ``TYPES`` raise ValueError."""
    entries: list[tuple[str, str, list[int]]] = []
    blocks: list[NDArray[Any]] = []
    for name, values in (arrays or {}).items():
        block = np.ascontiguousarray(values)
        block = block.astype(block.dtype.newbyteorder("<"), copy=False)
        if block.dtype.str not in TYPES:
            raise ValueError(f"{name}: has the type {block.dtype.str}; must be one of {', '.join(TYPES)}")
        entries.append((name, block.dtype.str, list(block.shape)))
        blocks.append(block)
    line = json.dumps({**header, "arrays": entries}, separators=(",", ":"), allow_nan=False)
    stream.write(line.encode() + b"\n")
    for block in blocks:
        stream.write(block.tobytes())
    stream.flush()


def read_message(stream: IO[bytes]) -> Message | None:
    """Reads a message; None at the end of the stream. Raises BrokenMessage for anything else; the next line may be one.

    Raises MemoryError for arrays that do not fit into it.
    """
    line = stream.readline(MOST_HEADER)
    if not line:
        return None
    begin = repr(line[:60])
    if len(line) == MOST_HEADER and not line.endswith(b"\n"):
        while (line := stream.readline(MOST_HEADER)) and not line.endswith(b"\n"):
            pass
        raise BrokenMessage(f"a message begins with {begin}; must be a line of at most {MOST_HEADER:,} bytes")
    header: Any = None
    try:
        header = json.loads(line)
        entries = [_entry(*entry) for entry in header.pop("arrays", [])]
    except (ValueError, AttributeError, TypeError, OverflowError, RecursionError):
        id = header.get("id") if isinstance(header, dict) else None
        raise BrokenMessage(f"a message begins with {begin}; must be a line of JSON, an object", id) from None
    for name, kind, shape in entries:
        if kind not in TYPES or min(shape, default=0) < 0 or len(shape) > MOST_AXES or math.prod(shape) > MOST_VALUES:
            given = f"the type {kind[:20]} and the shape {str(shape[:MOST_AXES])[:100]}"
            raise BrokenMessage(f"array {name[:60]} has {given}; cannot be read", header.get("id"))
    arrays: dict[str, NDArray[Any]] = {}
    for name, kind, shape in entries:
        values = np.empty(shape, kind)
        if values.size and _read_into(stream, values.data.cast("B")) < values.nbytes:
            raise BrokenMessage(f"array {name[:60]} ends too early", header.get("id"))
        arrays[name] = values
    return Message(header, arrays)


def _entry(name: str, kind: str, shape: Sequence[int]) -> tuple[str, str, list[int]]:
    return str(name), str(kind), [int(length) for length in shape]


def _read_into(stream: IO[bytes], place: memoryview) -> int:
    """Fills the place from the stream; returns the number of bytes that were there."""
    done = 0
    while done < len(place):
        part = stream.read(min(len(place) - done, 1 << 20))
        if not part:
            break
        place[done : done + len(part)] = part
        done += len(part)
    return done


class RingletProcess:
    """A Ringlet process. No method waits for it, so that the host never blocks.

    Answers arrive by ``poll``. A process that ended, or was killed, has ``alive`` false and its last words in
    ``last_words``; start another, and send again what it had not answered.
    """

    def __init__(self, command: Sequence[str], environment: Mapping[str, str] | None = None) -> None:
        """Starts it. Raises OSError where the command cannot be started."""
        self._said = tempfile.TemporaryFile()  # noqa: SIM115  closed with the process
        self._process = subprocess.Popen(
            list(command),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._said,
            env=None if environment is None else dict(environment),
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )
        self._answers: queue.SimpleQueue[Message] = queue.SimpleQueue()
        self._requests: queue.SimpleQueue[tuple[dict[str, Any], Mapping[str, NDArray[Any]]] | None] = (
            queue.SimpleQueue()
        )
        self._next = 0
        self._ended = False
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        threading.Thread(target=self._write, daemon=True).start()

    @property
    def pid(self) -> int:
        """Id of the process."""
        return self._process.pid

    @property
    def alive(self) -> bool:
        """Whether it runs, or has answers that were not polled."""
        return not self._ended or not self._answers.empty()

    @property
    def last_words(self) -> str:
        """The last line that it wrote on its error stream; empty when it wrote none."""
        self._said.seek(max(os.fstat(self._said.fileno()).st_size - 4000, 0))
        lines = self._said.read().decode(errors="replace").strip().splitlines()
        return lines[-1] if lines else ""

    def send(self, do: str, arrays: Mapping[str, NDArray[Any]] | None = None, **fields: Any) -> int:
        """Queues a request and returns its id, which its answers have."""
        self._next += 1
        self._requests.put(({"id": self._next, "do": do, **fields}, arrays or {}))
        return self._next

    def poll(self) -> list[Message]:
        """Answers that arrived since the last call."""
        found: list[Message] = []
        while not self._answers.empty():
            found.append(self._answers.get())
        return found

    def stop(self) -> None:
        """Ends the process: it stops what it does and exits."""
        self._requests.put(None)
        threading.Timer(2.0, self._kill).start()

    def _kill(self) -> None:
        if self._process.poll() is None:
            self._process.kill()

    def _read(self) -> None:
        assert self._process.stdout is not None
        try:
            while (message := read_message(self._process.stdout)) is not None:
                self._answers.put(message)
        except (BrokenMessage, OSError, ValueError):
            self._kill()
        self._process.wait()
        self._requests.put(None)
        self._ended = True

    def _write(self) -> None:
        assert self._process.stdin is not None
        try:
            while (request := self._requests.get()) is not None:
                write_message(self._process.stdin, *request)
            self._process.stdin.close()
        except (OSError, ValueError):  # it has ended
            pass
