"""Splits a TOML text into blocks of lines: one table with the comment above it."""

from __future__ import annotations

import re
from dataclasses import dataclass

HEADER = re.compile(r"^\s*(\[\[?)\s*([A-Za-z0-9_.\-]+)\s*\]\]?\s*(#.*)?$")


@dataclass
class Block:
    """A table of a TOML text.

    name:  name in the header; empty for the block before the first header
    many:  whether it belongs to an array of tables
    lines: its lines, with the comment above the header
    """

    name: str
    many: bool
    lines: list[str]

    @property
    def text(self) -> str:
        """The lines of the block, without blank lines around them."""
        return "\n".join(self.lines).strip("\n") + "\n"


def split(text: str) -> list[Block]:
    """Splits a text into blocks; the first has no name and holds the lines before any table."""
    blocks = [Block("", False, [])]
    depth = 0
    for line in text.splitlines():
        header = HEADER.match(line) if depth == 0 else None
        if header:
            above = _take_trailing_comment(blocks[-1].lines)
            blocks.append(Block(header[2], header[1] == "[[", [*above, line]))
        else:
            depth += _bracket_depth(line)
            blocks[-1].lines.append(line)
    return blocks


def join(blocks: list[Block]) -> str:
    """Joins blocks to a text, with a blank line between them."""
    return "\n".join(block.text for block in blocks if block.lines)


def place_of_new_array(blocks: list[Block]) -> int:
    """Index at which the first table of a new array is inserted: before the curl, or else at the end."""
    return next((k for k, block in enumerate(blocks) if block.name == "curl"), len(blocks))


def insert_line(block: Block, line: str) -> None:
    """Inserts a line after the last setting of a block, before its trailing comments and blank lines."""
    at = len(block.lines)
    while at > 0 and (not block.lines[at - 1].strip() or block.lines[at - 1].lstrip().startswith("#")):
        at -= 1
    block.lines.insert(at, line)


def _take_trailing_comment(lines: list[str]) -> list[str]:
    """Removes and returns the comment at the end of some lines: it belongs to the next table."""
    at = len(lines)
    while at > 0 and lines[at - 1].lstrip().startswith("#"):
        at -= 1
    if at == 0:  # keeps the comment at the start of the file
        return []
    above = lines[at:]
    del lines[at:]
    return above


def _bracket_depth(line: str) -> int:
    """Change of the bracket depth by a line, without strings and comments."""
    bare = re.sub(r'"(\\.|[^"\\])*"|\'[^\']*\'', "", line).split("#")[0]
    return sum(bare.count(c) for c in "[{") - sum(bare.count(c) for c in "]}")
