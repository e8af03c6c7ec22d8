"""The model of a report, stored as ``report.json``; a change of a field increments ``FORMAT``."""

from __future__ import annotations

import platform
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

FORMAT = 1


def plain(value: Any) -> Any:
    """Converts numpy numbers and arrays, also within dicts and lists, to plain Python values."""
    if isinstance(value, dict):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [plain(entry) for entry in value]
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist()
    return value


Plain = BeforeValidator(plain)


class Machine(BaseModel):
    """The machine of a run. ``simd`` is the instruction set of the core, e.g. ``avx2``."""

    threads: int | None = None
    simd: str | None = None
    python: str = Field(default_factory=platform.python_version)
    system: str = Field(default_factory=lambda: f"{platform.system()} {platform.machine()}")


class Stage(BaseModel):
    """Times of one stage [ms]; processor time is the sum over all threads."""

    name: str
    wall_ms: float
    cpu_ms: float | None = None


class MadeFile(BaseModel):
    """An output file, its contents in words, and its size [bytes]."""

    path: str
    what: str = ""
    bytes: int

    @classmethod
    def of(cls, path: Path | str, what: str = "") -> MadeFile:
        """Describes an existing file."""
        return cls(path=str(path), what=what, bytes=Path(path).stat().st_size)


class Picture(BaseModel):
    """A picture to show: its file, and a caption that also serves as alternative text."""

    path: str
    caption: str


class Table(BaseModel):
    """A table with a title."""

    title: str
    columns: list[str]
    rows: list[list[str]]


class RunReport(BaseModel):
    """Report of one run.

    name:       name of the run, e.g. ``demo``
    version:    version of Ringlet
    command:    command line
    counts:     numbers of created items, e.g. ``{"locks": 1200, "hairs": 15000}``
    settings:   settings of the simulation
    stages:     times of the stages, in the order of execution
    statistics: one dict per simulated frame, as in ``Cache.statistics``; a chart without entries is omitted
    fps:        frames per second of the clip
    pictures:   pictures, in the order of display
    tables:     tables of a particular kind of run, e.g. of a loft
    warnings:   warnings for the reader
    limits:     limitations of this version
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
