"""Records the files that are read: what a run depends on, and what its outputs must not replace.

Readers call ``record``. Every block of ``recorded`` around them keeps the files in their order.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

from ringlet.data.errors import UserError

Stamp = tuple[int, int, int, int]

_open: ContextVar[tuple[Reads, ...]] = ContextVar("open records of reads", default=())
_digests: dict[tuple[Path, Stamp], str] = {}  # of files that were hashed in this process


class Reads:
    """The files that a block read, in order, and those that it wrote itself."""

    def __init__(self) -> None:
        self._reads: list[list[Path]] = []
        self._written: set[Path] = set()

    def contents(self) -> list[tuple[str, str]]:
        """Name and digest of the contents of every file, read by read.

        Folders and times of files do not count, so that a project may be moved. Raises UserError for a file that
        cannot be read any more.
        """
        found: list[tuple[str, str]] = []
        for first, *others in self._reads:
            found += [_named(first), *sorted(map(_named, others))]
        return found

    def files(self) -> list[Path]:
        """The files that were read, in order, each once and without symbolic links."""
        return list(dict.fromkeys(file for files in self._reads for file in files if file not in self._written))

    def input_at(self, path: Path | str) -> Path | None:
        """The file that was read and is at a path, through links too; None for a file that the block wrote itself."""
        if not Path(path).exists():
            return None
        return next((file for file in self.files() if same_file(path, file)), None)


@contextmanager
def recorded() -> Iterator[Reads]:
    """Records the files that are read and written in the block, or in the function that it decorates."""
    reads = Reads()
    before = _open.set((*_open.get(), reads))
    try:
        yield reads
    finally:
        _open.reset(before)


@contextmanager
def unrecorded() -> Iterator[None]:
    """Files that are read in the block are no inputs: they are about to be replaced, or only their kind is needed."""
    before = _open.set(())
    try:
        yield
    finally:
        _open.reset(before)


def record(*files: Path | str) -> None:
    """Records a file that is read, and the further ones that it refers to."""
    real = list(dict.fromkeys(Path(file).resolve() for file in files))
    for reads in _open.get():
        reads._reads.append(real)


def record_written(file: Path) -> None:
    """Records a file that was written: it is no input, even if it is read later."""
    for reads in _open.get():
        reads._written.add(file.resolve())


def refuse_inputs(path: Path | str) -> None:
    """Raises UserError when writing to a path would replace a file that was read."""
    for reads in _open.get():
        if (file := reads.input_at(path)) is not None:
            source = "" if Path(path).absolute() == file else f" ({file})"
            raise UserError(f"{path}: is an input of this command{source}; choose another name")


def same_file(path: Path | str, other: Path | str) -> bool:
    """Whether two paths lead to one file that exists, through symbolic or hard links."""
    try:
        return Path(path).samefile(other)
    except OSError:
        return False


def _named(file: Path) -> tuple[str, str]:
    try:
        status = file.stat()
        key = file, (status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns)
        if key not in _digests:
            with file.open("rb") as content:
                _digests[key] = hashlib.file_digest(content, "sha256").hexdigest()
    except OSError as error:
        raise UserError(f"{file}: cannot be read ({error.strerror}); put it back") from None
    return file.name, _digests[key]
