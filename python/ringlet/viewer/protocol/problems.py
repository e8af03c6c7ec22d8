"""Message of the server with the problems of the session and their remedies."""

from __future__ import annotations

from typing import Any, Literal

from ringlet.viewer.protocol.message import File, Message


class Fix(Message):
    """A remedy of a problem: a button, and the message of the page that it sends."""

    label: str
    message: dict[str, Any]


class Difference(Message):
    """A setting of a file whose value on disk (theirs) differs from that of the session (mine).

    base: value in their common ancestor
    both: whether both changed it
    """

    name: str
    base: str
    mine: str
    theirs: str
    both: bool


class Problem(Message):
    """What stands in the way, until it is gone.

    subject:     ``groom`` for a groom that cannot be made; the page then marks the look that it shows
    file:        file of ``setting``, or of the conflict
    setting:     name of the setting that is wrong; empty for none
    differences: of a conflict with the version on disk
    """

    subject: str
    message: str
    file: File
    setting: str
    fixes: list[Fix]
    differences: list[Difference]


class Problems(Message):
    """All problems of the session."""

    kind: Literal["problems"] = "problems"
    problems: list[Problem]
