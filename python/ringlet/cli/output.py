"""Output of a finished command: a few lines for people, or one JSON value for machines."""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

PLAIN_WIDTH = 160  # of a table that goes to a file or to another program


def print_json(value: Any) -> None:
    """One JSON value on the standard output, and nothing else."""
    has_all = (sys.stdout.encoding or "").lower() == "utf-8"
    print(json.dumps(finite(value), indent=2, ensure_ascii=not has_all, allow_nan=False))


def finite(value: Any) -> Any:
    """The same value with null in place of numbers that JSON cannot hold."""
    if isinstance(value, dict):
        return {key: finite(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [finite(entry) for entry in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def wrote(path: Path, counts: dict[str, int], as_json: bool, **more: Any) -> None:
    """Reports a written file with counts of its contents; JSON output has the entries of ``more`` too."""
    if as_json:
        print_json({"path": str(path), "bytes": path.stat().st_size, **counts, **more})
    else:
        parts = [f"{value:,} {name}" for name, value in counts.items() if value]
        print(f"{path}: {', '.join([*parts, size(path.stat().st_size)])}")


def density(measured: dict[str, Any]) -> str:
    """The result of ``ringlet.measure_hairs`` in a line, or in one for each of several grooms."""
    if "grooms" in measured:
        return "\n".join(f"{name}: {of['hairs']:,} hairs, {density(of)}" for name, of in measured["grooms"].items())
    if "hairs_per_cm" in measured:
        return f"{measured['hairs_per_cm']:.0f} hairs/cm of its edge"
    return f"{measured['hairs_per_cm2']:.0f} hairs/cm²; {100 * measured['scalp_seen']:.1f} % of the scalp are seen"


def size(count: int) -> str:
    """A number of bytes in a readable unit: ``3.2 MB``."""
    for unit, step in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if count >= step:
            return f"{count / step:.1f} {unit}"
    return f"{count} bytes"


def print_table(columns: list[str], rows: list[list[str]], right: tuple[int, ...] = ()) -> None:
    """A plain table on the standard output; ``right`` are the columns that hold numbers."""
    table = Table(box=None, pad_edge=False, header_style="bold")
    for index, column in enumerate(columns):
        table.add_column(column, justify="right" if index in right else "left", overflow="fold")
    for row in rows:
        table.add_row(*row)
    Console(width=None if sys.stdout.isatty() else PLAIN_WIDTH, markup=False).print(table)
