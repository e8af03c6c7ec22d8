"""The one exception for everything a user can cause."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

MOST = 1000  # characters of a message


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
        super().__init__(line if len(line) <= MOST else f"{line[:MOST]}…")


def one_line(message: str) -> str:
    """A message without line breaks and other characters that a terminal would obey instead of showing them."""
    return " ".join("".join(character if character.isprintable() else " " for character in message).split())
