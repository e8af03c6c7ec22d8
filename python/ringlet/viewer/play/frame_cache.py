"""Frames for playback. They are stored in files and read one at a time."""

from __future__ import annotations

import errno
import os
import tempfile
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError
from ringlet.viewer.files.watcher import stamp_of
from ringlet.viewer.show.scene import FrameState


class FrameSource(Protocol):
    """Frames in the order of their numbers."""

    @property
    def frames(self) -> NDArray[np.float64]:
        """Frame numbers, shape (k,)."""
        ...

    def message(self, frame: float) -> bytes:
        """Message of a frame; raises UserError when it cannot be read."""
        ...


class ReplacedError(UserError):
    """The file of the frames was replaced."""


class WatchedFile:
    """A file that may be replaced while it is read.

    USD shares the layers of a file between all stages that have it open. Opening a replaced file therefore changes the
    data under other readers. Reads take turns, and a result is valid only if the file is unchanged.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._opened_stamp = stamp_of(path)

    def unchanged(self) -> bool:
        """Whether the file was not replaced. A deleted file stays readable while it is open."""
        return stamp_of(self.path) in (self._opened_stamp, None)


class FileFrames:
    """Frames of a file, read one at a time.

    file: the file
    read: reads the contents of a frame
    pack: packs a frame number and its contents into a message
    lock: held while the file is read or reopened
    """

    def __init__(
        self,
        file: WatchedFile,
        frames: NDArray[np.float64],
        read: Callable[[float], FrameState],
        pack: Callable[[float, FrameState], bytes],
        lock: threading.Lock,
    ) -> None:
        self.frames = frames
        self._file, self._read, self._pack, self._lock = file, read, pack, lock

    def message(self, frame: float) -> bytes:
        """Message of a frame; raises ReplacedError when the file was replaced."""
        with self._lock:
            try:
                state = self._read(frame)
            except UserError:
                self._check()  # an error is meaningless when the file was replaced during the read
                raise
            self._check()
        return self._pack(frame, state)

    def _check(self) -> None:
        if not self._file.unchanged():
            raise ReplacedError(f"{self._file.path.name}: was replaced; its frames are void")


class FrameCache:
    """Frames of a run, stored in an anonymous temporary file."""

    def __init__(self) -> None:
        self._file = tempfile.TemporaryFile(prefix="ringlet-", buffering=0)  # noqa: SIM115
        self._places: dict[float, tuple[int, int]] = {}
        self._end = 0
        self._lock = threading.Lock()

    def add(self, frame: float, message: bytes) -> None:
        """Appends a frame; raises UserError when the disk is full."""
        with self._lock:
            try:
                self._file.seek(self._end)
                if self._file.write(message) < len(message):
                    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            except OSError as error:
                raise UserError(
                    f"{tempfile.gettempdir()}: frame {frame:g} cannot be kept there ({error.strerror}); make room, or "
                    "name another folder by the variable TMPDIR"
                ) from error
            self._places[frame] = self._end, len(message)
            self._end += len(message)

    def message(self, frame: float) -> bytes:
        """Message of a frame that was added."""
        with self._lock:
            start, size = self._places[frame]
            self._file.seek(start)
            return self._file.read(size)
