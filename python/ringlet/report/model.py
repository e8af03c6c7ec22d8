"""What a report holds. ``report.json`` is this model as it stands; its ``format`` number grows when a field changes."""

from __future__ import annotations

import platform
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

FORMAT = 1


def plain(value: Any) -> Any:
    """Numpy numbers and arrays, also within dicts and lists, as plain Python values."""
    if isinstance(value, dict):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [plain(entry) for entry in value]
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist()
    return value


Plain = BeforeValidator(plain)


class Machine(BaseModel):
    """Where it ran. ``simd`` is the instruction set that the core chose, e.g. ``avx2``."""

    threads: int | None = None
    simd: str | None = None
    python: str = Field(default_factory=platform.python_version)
    system: str = Field(default_factory=lambda: f"{platform.system()} {platform.machine()}")


class Stage(BaseModel):
    """Time spent in one stage [ms]; the processor time is that of all threads together."""

    name: str
    wall_ms: float
    cpu_ms: float | None = None


class MadeFile(BaseModel):
    """A file that the run wrote, and its size."""

    path: str
    what: str = ""
    bytes: int

    @classmethod
    def of(cls, path: Path | str, what: str = "") -> MadeFile:
        """Describes a file that is there."""
        return cls(path=str(path), what=what, bytes=Path(path).stat().st_size)


class Picture(BaseModel):
    """A picture to show: where it lies, and what is to be seen, in words for those who cannot see it."""

    path: str
    caption: str


class Table(BaseModel):
    """Numbers to show as they are, under a title."""

    title: str
    columns: list[str]
    rows: list[list[str]]


class RunReport(BaseModel):
    """Everything about one run.

    name:       what was run, e.g. ``demo``
    version:    of Ringlet
    command:    the command line
    counts:     how many of what was made, e.g. ``{"locks": 1200, "hairs": 15000}``
    settings:   what the simulation was asked to do
    stages:     in the order they ran
    statistics: one dict per simulated frame, as in ``Cache.statistics``; missing entries leave a chart out
    fps:        frames per second of the clip
    pictures:   shown in this order
    tables:     numbers of one kind of run, e.g. of a loft
    warnings:   what happened that the reader should know
    limits:     what this version does not do
    """

    model_config = ConfigDict(ser_json_inf_nan="null")

    format: int = FORMAT
    name: str
    version: str
    command: str = ""
    date: datetime = Field(default_factory=lambda: datetime.now(UTC).replace(microsecond=0))
    machine: Machine = Field(default_factory=Machine)
    counts: Annotated[dict[str, int], Plain] = Field(default_factory=dict)
    settings: Annotated[dict[str, Any], Plain] = Field(default_factory=dict)
    stages: list[Stage] = Field(default_factory=list)
    statistics: Annotated[list[dict[str, Any]], Plain] = Field(default_factory=list)
    fps: float = 24.0
    files: list[MadeFile] = Field(default_factory=list)
    pictures: list[Picture] = Field(default_factory=list)
    tables: list[Table] = Field(default_factory=list)
    warnings: list[str] = Field(default_factory=list)
    limits: list[str] = Field(default_factory=list)
