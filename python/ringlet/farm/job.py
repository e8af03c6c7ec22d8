"""A job for a render farm: steps one after the other, each with a single task, or with a task for each frame.

Words of a step's command name its files and values in braces, such as ``{Cache}``, and ``{Frame}``. Each format of a
farm puts its own text in their place.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

FRAME = "Frame"  # what words name the frame of a task by
HOUR = 3600  # [s]


@dataclass(frozen=True)
class File:
    """A file, or a folder, that steps read or write."""

    path: Path
    about: str
    folder: bool = False


@dataclass(frozen=True)
class Step:
    """One command of a job.

    words:      of the command line, ``ringlet`` left out
    reads:      names of the files that it reads
    writes:     names of the files that it writes
    hours:      timeout of a task
    processors: that its machine must have at least
    by_frame:   whether it has a task for each frame
    """

    name: str
    words: list[str]
    reads: list[str]
    writes: list[str]
    hours: int
    processors: int = 1
    by_frame: bool = False

    def command(self, texts: Mapping[str, str]) -> list[str]:
        """The words with ``texts`` in place of the names in braces."""
        return [word.format_map(texts) for word in self.words]


@dataclass(frozen=True)
class Job:
    """Steps, in the order in which they run.

    files:  by the names that words have for them
    values: that a submitter may change, by name
    frames: first and last frame of the steps with a task for each
    """

    title: str
    files: dict[str, File]
    values: dict[str, str | int]
    frames: tuple[int, int]
    steps: list[Step]

    def is_made(self, name: str) -> bool:
        """Whether a step writes the file of a name."""
        return any(name in step.writes for step in self.steps)

    def texts(self, frame: str) -> dict[str, str]:
        """What stands for the names in words: paths, values, and a text for the frame."""
        paths = {name: str(file.path) for name, file in self.files.items()}
        return {**paths, **{name: str(value) for name, value in self.values.items()}, FRAME: frame}
