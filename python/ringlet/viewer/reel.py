"""Frames that can be seen. They are in files, and in memory only while somebody is shown one."""

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
from ringlet.viewer.scene import Moved


class Reel(Protocol):
    """Frames in the order of their numbers."""

    @property
    def frames(self) -> NDArray[np.float64]:
        """Their numbers, shape (k,)."""
        ...

    def message(self, frame: float) -> bytes:
        """What a page is sent of a frame. Raises UserError where it cannot be read."""
        ...


class ReplacedError(UserError):
    """The file that frames were read from is another one now."""


class Watched:
    """A file that may be replaced while it is read.

    What USD holds of a file is held together by all who have it open: who opens the new one changes what others read,
    in the midst of it. So one reads at a time, and what was read counts only if the file is still the same.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._known = self._now()

    def same(self) -> bool:
        """Whether it is the file that it was. One that is gone can be read on, since it is held open."""
        return self._now() in (self._known, None)

    def _now(self) -> tuple[int, int, int] | None:
        try:
            found = self.path.stat()
        except OSError:
            return None
        return found.st_ino, found.st_size, found.st_mtime_ns


class Read:
    """Frames that a file holds. One is read at a time, whoever asks.

    file: where they are
    read: gives what a frame holds
    pack: makes the message of a frame of that
    one:  held while the file is read, and by who opens another in its place
    """

    def __init__(
        self,
        file: Watched,
        frames: NDArray[np.float64],
        read: Callable[[float], Moved],
        pack: Callable[[float, Moved], bytes],
        one: threading.Lock,
    ) -> None:
        self.frames = frames
        self._file, self._read, self._pack, self._one = file, read, pack, one

    def message(self, frame: float) -> bytes:
        """Reads a frame. Raises ReplacedError where the file is another one by now."""
        with self._one:
            try:
                moved = self._read(frame)
            except UserError:
                self._check()  # of half of the one and half of the other nothing can be said
                raise
            self._check()
        return self._pack(frame, moved)

    def _check(self) -> None:
        if not self._file.same():
            raise ReplacedError(f"{self._file.path.name}: was replaced; its frames are void")


class Run:
    """Frames that are simulated here, kept in a file without a name that ends with the program."""

    def __init__(self) -> None:
        self._file = tempfile.TemporaryFile(prefix="ringlet-", buffering=0)  # noqa: SIM115
        self._places: dict[float, tuple[int, int]] = {}
        self._end = 0
        self._one = threading.Lock()

    @property
    def frames(self) -> NDArray[np.float64]:
        """Their numbers, shape (k,)."""
        return np.array(sorted(self._places), np.float64)

    def add(self, frame: float, message: bytes) -> None:
        """Adds the next frame."""
        with self._one:
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

    def cut(self, after: float | None = None) -> None:
        """Forgets all frames, or those after one."""
        with self._one:
            self._places = {frame: at for frame, at in self._places.items() if after is not None and frame <= after}
            self._end = max((start + size for start, size in self._places.values()), default=0)
            self._file.truncate(self._end)

    def message(self, frame: float) -> bytes:
        """Reads a frame."""
        with self._one:
            if frame not in self._places:
                raise UserError(f"frame {frame:g} is there no more; run the shot again")
            start, size = self._places[frame]
            self._file.seek(start)
            return self._file.read(size)
