"""Our docstrings name things as ``points: positions [m], shape (n, 3)``; Sphinx is given such runs as lists."""

from __future__ import annotations

import re
from typing import Any

ENTRY = re.compile(r"^(\w+(?:, \w+)*):\s+(\S.*)$")


def as_list(app: Any, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Turns runs of entries, each with its indented continuation, into bullets, in place."""
    result: list[str] = []
    listing = False
    for line in lines:
        if entry := ENTRY.match(line):
            if not listing:
                result.append("")
            result.append(f"- **{entry[1]}**: {entry[2]}")
            listing = True
        elif listing and line.startswith("  ") and line.strip():
            result.append("  " + line.strip())
        else:
            if listing and line.strip():
                result.append("")
            listing = False
            result.append(line)
    lines[:] = result
