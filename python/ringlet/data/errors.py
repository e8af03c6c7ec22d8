"""The one exception for everything a user can cause."""

from __future__ import annotations

import logging
import re
from collections.abc import Sequence
from typing import Any, NamedTuple

MOST = 1000  # characters of a message; its end is the remedy
SURROGATE = re.compile("[\ud800-\udfff]")  # half of a UTF-16 pair, or a byte of a name that is no text


class Fix(NamedTuple):
    """A value of a setting with which an error goes away. place: path of the setting in its file."""

    place: tuple[str | int, ...]
    value: Any

    @property
    def name(self) -> str:
        """Name of the setting within its table."""
        return str(self.place[-1])


class UserError(Exception):
    """A mistake in the input, in one line: what, where, which value, and what to do about it.

    The command line prints it and exits with 2; it never shows a traceback.
    Example: ``UserError("curls.recipe.toml: curl.width is -0.2 m; must be at least 0")``.

    fixes: values of settings that the message proposes; the review offers them as buttons
    """

    def __init__(self, message: str, fixes: Sequence[Fix] = ()) -> None:
        self.fixes = tuple(fixes)
        line = one_line(message)
        super().__init__(abbreviated(line))


def line_of(error: BaseException) -> str | None:
    """The line on an exception that the input, the place or the memory may cause; None for a mistake in Ringlet."""
    if isinstance(error, UserError):
        return str(error)
    if isinstance(error, OSError):
        place = f"{error.filename}: " if error.filename else ""
        return abbreviated(one_line(f"{place}{error.strerror or error}; check the place and its rights"))
    if isinstance(error, MemoryError):
        reason = one_line(str(error)) or "of this machine"
        return f"memory ran out ({reason}); ask for fewer locks, hairs, frames or pixels"
    if isinstance(error, RecursionError):
        return "lists or tables are in one another too deep; shorten them"
    if isinstance(error, UnicodeEncodeError) and SURROGATE.search(error.object):
        return one_line(f"{ascii(error.object[:200])[1:-1]}: has a name that is not in UTF-8; rename the file")
    if isinstance(error, RuntimeError) and str(error).startswith("Symlink loop"):  # of pathlib
        return abbreviated(one_line(f"{error}; check the place"))
    return None


def failure(what: str, error: Exception) -> str:
    """The message on a call that failed; a mistake in Ringlet is logged.

    what: what could not be done, for the log
    """
    if (line := line_of(error)) is not None:
        return line
    logging.getLogger("ringlet").error(what, exc_info=error)
    return one_line(f"this is a mistake in Ringlet ({type(error).__name__}: {error}); see the terminal")


def abbreviated(line: str) -> str:
    """A message with both its ends where it is too long."""
    return line if len(line) <= MOST else f"{line[: MOST // 2]}…{line[-MOST // 2 :]}"


def one_line(message: str) -> str:
    """A message without line breaks and other characters that a terminal would obey instead of showing them."""
    return " ".join("".join(character if character.isprintable() else " " for character in message).split())
