"""Checkpoints: what a run has done so far, in a folder, so that a run that was killed goes on where it was.

Every frame is kept as soon as it is there, and every few frames all that the next one depends on. A file is written
aside and renamed, and begins with a digest of the rest: half a file is never read, and one that was damaged is noticed.
A folder is of one program at a time; who writes files beside it that go with the run holds it before the first.
"""

from __future__ import annotations

import fcntl
import hashlib
import io
import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError
from ringlet.data.files import replacing

VERSION = b"ringlet checkpoint 2\n"
EVERY = 10  # frames from one memory to the next, at most
VERTICES = 1_000_000  # between memories: a frame of that many may take minutes
HELD = "held"  # the file that a program holds while it runs
KEPT = 2  # memories: where the last is damaged, the one before is used

Arrays = Mapping[str, NDArray[Any]]

_held_here: dict[Path, BinaryIO] = {}  # by folder, what ``holding`` holds in this program


class DamagedError(ValueError):
    """A file is not what was written."""


@dataclass
class Checkpoints:
    """The folder of a run.

    folder: where everything is kept
    made_from: a digest of all that the run is made from; what another run left behind is not gone on with
    every:  frames from one memory to the next
    """

    folder: Path
    made_from: str
    every: int = EVERY
    _held: BinaryIO | None = field(default=None, repr=False)

    def begin(self, resume: bool) -> tuple[int, dict[str, NDArray[Any]]] | None:
        """Where to go on: the steps that are done, and the memory after them; None where it is to begin anew.

        Without ``resume`` what is there is thrown away. Raises UserError where it is of another run.
        """
        self._hold()
        if not resume:
            for path in self.folder.iterdir():
                if path.name != HELD:
                    path.unlink()
        key = self.folder / "made_from"
        if key.exists() and key.read_text() != self.made_from:
            raise UserError(
                f"{self.folder}: was left by a run with other settings, another groom, first frame or Ringlet; "
                "run without --resume to start over"
            )
        with replacing(key) as aside:
            aside.write_text(self.made_from)
        for path in sorted(self.folder.glob("memory.*"), reverse=True):
            try:
                memory = read(path)
            except DamagedError:
                path.unlink()
                continue
            done = int(path.suffix[1:])
            if all(self._has(step) for step in range(done)):
                return done, memory
        return None

    def _hold(self) -> None:
        """Keeps other programs out of the folder as long as this one runs."""
        self._held = _held_here.get(self.folder.resolve()) or _held(self.folder)

    def keep(self, step: int, arrays: Arrays, statistics: dict[str, Any]) -> None:
        """Keeps what a step gave."""
        write(self._frame(step), {**arrays, "statistics": np.array(json.dumps(statistics))})

    def remember(self, done: int, memory: Arrays) -> None:
        """Keeps a memory after so many steps, and drops those that are too old to be wanted."""
        write(self.folder / f"memory.{done:06d}", memory)
        for path in sorted(self.folder.glob("memory.*"))[:-KEPT]:
            path.unlink()

    def kept(self, done: int) -> Iterator[tuple[dict[str, NDArray[Any]], dict[str, Any]]]:
        """What the first steps gave: their arrays and statistics."""
        for step in range(done):
            arrays = read(self._frame(step))
            yield arrays, json.loads(str(arrays.pop("statistics")))

    def _frame(self, step: int) -> Path:
        return self.folder / f"step.{step:06d}"

    def _has(self, step: int) -> bool:
        try:
            read(self._frame(step))
        except (DamagedError, OSError):
            return False
        return True


@contextmanager
def holding(folder: Path) -> Iterator[int]:
    """Keeps other programs out of a folder of checkpoints while the block runs; see ``ringlet.hold_checkpoints``."""
    at = folder.resolve()
    if at in _held_here:
        raise _goes_on(folder)
    # To close a file gives up the locks of its whole program, so checkpoints in this folder use this one.
    _held_here[at] = _held(folder)
    try:
        yield max((int(path.suffix[1:]) for path in at.glob("memory.*")), default=0)
    finally:
        if [path.name for path in at.glob("*")] == [HELD]:
            (at / HELD).unlink()
        _held_here.pop(at).close()
        with suppress(OSError):  # what has been kept stays
            at.rmdir()


def _held(folder: Path) -> BinaryIO:
    """The file that holds a folder for as long as it is open."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file = (folder / HELD).open("ab")
    except OSError as error:
        raise UserError(f"{folder}: cannot be written ({error.strerror}); choose another place") from error
    try:
        fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (BlockingIOError, PermissionError):
        file.close()
        raise _goes_on(folder) from None
    except OSError:  # the disk knows no locks
        pass
    return file


def _goes_on(folder: Path) -> UserError:
    return UserError(f"{folder}: is of a run that goes on; let it end, or choose another place")


def frames_between(vertices: int) -> int:
    """How many frames go by from one memory to the next where strands have so many vertices: more take longer."""
    return max(1, min(EVERY, VERTICES // max(vertices, 1)))


def digest(*parts: Any) -> str:
    """A digest of arrays and of plain values."""
    found = hashlib.sha256(VERSION)
    for part in parts:
        array = isinstance(part, np.ndarray)
        found.update(np.ascontiguousarray(part).tobytes() if array else json.dumps(part, sort_keys=True).encode())
    return found.hexdigest()


def write(path: Path, arrays: Arrays) -> None:
    """Writes arrays by name, all or nothing."""
    content = io.BytesIO()
    np.savez(content, allow_pickle=False, **arrays)
    with replacing(path) as aside:
        aside.write_bytes(VERSION + hashlib.sha256(content.getvalue()).digest() + content.getvalue())


def read(path: Path) -> dict[str, NDArray[Any]]:
    """Reads what ``write`` wrote; raises DamagedError where it is not that."""
    content = path.read_bytes()
    begin = len(VERSION) + hashlib.sha256().digest_size
    if content[: len(VERSION)] != VERSION or hashlib.sha256(content[begin:]).digest() != content[len(VERSION) : begin]:
        raise DamagedError(f"{path}: is damaged")
    with np.load(io.BytesIO(content[begin:]), allow_pickle=False) as arrays:
        return dict(arrays)
