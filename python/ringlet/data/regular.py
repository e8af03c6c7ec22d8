"""Opens files to read: regular files of a bounded size only.

A pipe makes a reader wait for ever, and an endless device fills its memory.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from ringlet.data.errors import UserError

MOST = 4_000_000_000  # bytes of a file that is read as a whole
MOST_TEXT = 256_000_000  # bytes of a recipe, a shot or a file of edits


def check_regular(path: Path | str, remedy: str = "give a regular file") -> None:
    """Raises UserError for a pipe, a socket or a device, links followed; also what a library opens passes here.

    A missing file passes: its reader reports it.
    """
    try:
        status = Path(path).stat()
    except OSError:
        return
    if not stat.S_ISDIR(status.st_mode):
        _check(Path(path), status, None, remedy)


@contextmanager
def open_regular(path: Path | str, remedy: str = "check the name", most: int | None = MOST) -> Iterator[BinaryIO]:
    """Opens a regular file to read; the check and the reads see the same file, whatever happens to its name.

    most:   largest size [bytes]; None: any, for a reader that takes only a part of it
    remedy: end of the message

    Raises UserError for a file that cannot be read, is too large or is not regular.
    """
    path = Path(path)
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK)  # of a pipe, this does not wait for its writer
    except (OSError, ValueError) as error:
        raise UserError(f"{path}: cannot be read ({getattr(error, 'strerror', None) or error}); {remedy}") from None
    try:
        _check(path, os.fstat(descriptor), most, remedy)
    except UserError:
        os.close(descriptor)
        raise
    with os.fdopen(descriptor, "rb") as file:
        try:
            yield file
        except OSError as error:
            raise UserError(f"{path}: cannot be read ({error.strerror or error}); {remedy}") from None


def read_bytes(path: Path | str, remedy: str = "check the name", most: int = MOST) -> bytes:
    """Contents of a regular file; raises UserError for one that cannot be read, is too large or is not regular."""
    with open_regular(path, remedy, most) as file:
        return file.read()


def read_text(path: Path | str, remedy: str = "check the name", most: int = MOST_TEXT) -> str:
    """Text of a regular file in UTF-8, without a byte-order mark, its line ends as ``\\n``.

    Raises UserError for one that cannot be read, is too large, not regular or not in UTF-8.
    """
    data = read_bytes(path, remedy, most)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        kind = "is UTF-16 text; save it as UTF-8" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else f"is no text; {remedy}"
        raise UserError(f"{path}: {kind}") from None
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _check(path: Path, status: os.stat_result, most: int | None, remedy: str) -> None:
    if stat.S_ISDIR(status.st_mode):
        raise UserError(f"{path}: is a folder; {remedy}")
    if not stat.S_ISREG(status.st_mode):
        raise UserError(
            f"{path}: is no regular file but a {_KINDS.get(stat.S_IFMT(status.st_mode), 'device')}; {remedy}"
        )
    if most is not None and status.st_size > most:
        raise UserError(f"{path}: has {status.st_size:,} bytes; must be at most {most:,}")


_KINDS = {stat.S_IFIFO: "pipe", stat.S_IFSOCK: "socket"}
