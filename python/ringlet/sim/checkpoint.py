"""Checkpoints: a folder from which a run that was interrupted resumes, to the same bits.

Every frame is written as soon as it is done, and every few frames the state that the next one depends on. A file is
written aside, renamed, and begins with a digest of the rest: an incomplete or damaged one is never read. One program at
a time locks a folder; a program that writes other files of the run locks it before the first of them.
"""

from __future__ import annotations

import hashlib
import io
import json
import re
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.regular import check_regular, read_bytes, read_text
from ringlet.sim.run_inputs import Inputs, changed_input

if sys.platform == "win32":
    import msvcrt

    def _lock_file(file: BinaryIO) -> None:
        file.seek(0)
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)

else:
    import fcntl

    def _lock_file(file: BinaryIO) -> None:
        fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


VERSION = b"ringlet checkpoint 4\n"
EVERY = 10  # frames from one state to the next, at most
VERTICES = 1_000_000  # simulated between states: a frame of that many may take minutes
LOCK_FILE = "held"  # the file that a program locks while it runs
INPUTS = "made_from"  # the file of the inputs of the run
OWN_FILE = re.compile(rf"\.?({LOCK_FILE}|{INPUTS}|step|memory)(\.|$)")  # also one that is being written aside
STATES_KEPT = 2  # where the last is damaged, the one before is used

Arrays = Mapping[str, NDArray[Any]]

_locks: dict[Path, BinaryIO] = {}  # by folder, the files that ``locked_folder`` locks in this program


class DamagedError(ValueError):
    """A file does not match its digest."""


@dataclass
class Checkpoints:
    """The folder of a run.

    folder: folder of its files
    inputs: all that the run depends on; files of another run are refused
    every:  frames from one state to the next
    """

    folder: Path
    inputs: Inputs
    every: int = EVERY
    _lock_file: BinaryIO | None = field(default=None, repr=False)

    def begin(self, resume: bool) -> tuple[int, dict[str, NDArray[Any]]] | None:
        """The number of steps that are done and the state after them; None for a new run.

        Without ``resume``, and where nothing says what its files are of, the folder is emptied. Raises UserError where
        it is of another run.
        """
        self._lock()
        before = left_inputs(self.folder) if resume else None
        if before is None:
            discard(self.folder)
        elif change := changed_input(before, self.inputs):
            raise UserError(
                f"{self.folder}: was left by another run: {change}; put it back, or run without --resume to start over"
            )
        with replacing(self.folder / INPUTS) as aside:
            aside.write_text(json.dumps(self.inputs))
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

    def _lock(self) -> None:
        """Locks the folder for this program."""
        self._lock_file = _locks.get(self.folder.resolve()) or _open_lock(self.folder)

    def write_step(self, step: int, arrays: Arrays, statistics: dict[str, Any]) -> None:
        """Writes the results of a step."""
        write(self._frame(step), {**arrays, "statistics": np.array(json.dumps(statistics))})

    def write_state(self, done: int, memory: Arrays) -> None:
        """Writes the state after so many steps, and removes all but the last two."""
        write(self.folder / f"memory.{done:06d}", memory)
        for path in sorted(self.folder.glob("memory.*"))[:-STATES_KEPT]:
            path.unlink()

    def read_steps(self, done: int) -> Iterator[tuple[dict[str, NDArray[Any]], dict[str, Any]]]:
        """The results of the first steps: their arrays and statistics."""
        for step in range(done):
            arrays = read(self._frame(step))
            yield arrays, json.loads(str(arrays.pop("statistics")))

    def _frame(self, step: int) -> Path:
        return self.folder / f"step.{step:06d}"

    def _has(self, step: int) -> bool:
        try:
            return self._frame(step).exists() and bool(read(self._frame(step)))
        except DamagedError:
            return False


def discard(folder: Path) -> None:
    """Removes the checkpoints in a folder: the last first, and the inputs of their run at the end.

    So a run of the same inputs resumes from what a kill leaves, and no other does.
    """
    paths = [path for path in folder.iterdir() if path.name != LOCK_FILE]
    for path in sorted(paths, key=lambda path: (path.name != INPUTS, path.suffix), reverse=True):
        path.unlink(missing_ok=True)


def left_inputs(folder: Path) -> Inputs | None:
    """The inputs of the run that left its checkpoints in a folder; None where there are none.

    Those that cannot be read differ from any.
    """
    if not (folder / INPUTS).exists():
        return None
    try:
        return dict(json.loads(read_text(folder / INPUTS)))
    except (ValueError, TypeError):
        return {}


@contextmanager
def locked_folder(folder: Path) -> Iterator[int]:
    """Locks a folder of checkpoints while the block runs; see ``ringlet.hold_checkpoints``."""
    at = folder.resolve()
    if at in _locks:
        raise _in_use(folder)
    # Closing a file releases the locks of its whole program, so checkpoints in this folder use this one.
    _locks[at] = _open_lock(folder)
    try:
        yield max((int(path.suffix[1:]) for path in at.glob("memory.*")), default=0)
    finally:
        file = _locks.pop(at)
        if sys.platform == "win32":  # an open file stays, so also what another program locks
            file.close()
        if [path.name for path in at.glob("*")] == [LOCK_FILE]:
            with suppress(PermissionError):
                (at / LOCK_FILE).unlink()
        file.close()
        with suppress(OSError):  # a folder with checkpoints stays
            at.rmdir()


def _open_lock(folder: Path) -> BinaryIO:
    """The file that locks a folder as long as it is open; refuses a folder that holds other files, which would go."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if others := [path.name for path in folder.iterdir() if not OWN_FILE.match(path.name)]:
            raise UserError(f"{folder}: holds {min(others)}, which is no checkpoint; choose another place")
        check_regular(folder / LOCK_FILE)
        file = (folder / LOCK_FILE).open("ab")
    except OSError as error:
        raise UserError(f"{folder}: cannot be written ({error.strerror}); choose another place") from error
    try:
        _lock_file(file)
    except (BlockingIOError, PermissionError):
        file.close()
        raise _in_use(folder) from None
    except OSError:  # a file system without locks
        pass
    return file


def _in_use(folder: Path) -> UserError:
    return UserError(f"{folder}: belongs to a run in progress; let it end, or choose another place")


def frames_between(vertices: int) -> int:
    """Frames from one state to the next for strands of so many vertices, of which more take longer."""
    return max(1, min(EVERY, VERTICES // max(vertices, 1)))


def write(path: Path, arrays: Arrays) -> None:
    """Writes arrays by name, all or nothing."""
    content = io.BytesIO()
    np.savez(content, allow_pickle=False, **arrays)
    with replacing(path) as aside:
        aside.write_bytes(VERSION + hashlib.sha256(content.getvalue()).digest() + content.getvalue())


def read(path: Path) -> dict[str, NDArray[Any]]:
    """Reads what ``write`` wrote; raises DamagedError where it is not that."""
    content = read_bytes(path)
    begin = len(VERSION) + hashlib.sha256().digest_size
    if content[: len(VERSION)] != VERSION or hashlib.sha256(content[begin:]).digest() != content[len(VERSION) : begin]:
        raise DamagedError(f"{path}: is damaged")
    with np.load(io.BytesIO(content[begin:]), allow_pickle=False) as arrays:
        return dict(arrays)
