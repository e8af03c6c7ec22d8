"""The tables of a TOML text as blocks of lines: a table with the comment above it moves and goes as one."""

from __future__ import annotations

import re
from dataclasses import dataclass

HEADER = re.compile(r"^\s*(\[\[?)\s*([A-Za-z0-9_.\-]+)\s*\]\]?\s*(#.*)?$")


@dataclass
class Block:
    """A table: its name, whether it is one of an array of tables, and its lines, the comment above it included."""

    name: str
    many: bool
    lines: list[str]

    @property
    def text(self) -> str:
        """Its lines, one blank line after them."""
        return "\n".join(self.lines).strip("\n") + "\n"


def split(text: str) -> list[Block]:
    """The blocks of a text; the first has no name and holds what comes before any table."""
    blocks = [Block("", False, [])]
    depth = 0
    for line in text.splitlines():
        header = HEADER.match(line) if depth == 0 else None
        if header:
            above = _comment_above(blocks[-1].lines)
            blocks.append(Block(header[2], header[1] == "[[", [*above, line]))
        else:
            depth += _opened(line)
            blocks[-1].lines.append(line)
    return blocks


def join(blocks: list[Block]) -> str:
    """The text of blocks, with a blank line between them."""
    return "\n".join(block.text for block in blocks if block.lines)


def insert_line(block: Block, line: str) -> None:
    """Adds a line after the last setting of a block, before comments and blank lines that end it."""
    at = len(block.lines)
    while at > 0 and (not block.lines[at - 1].strip() or block.lines[at - 1].lstrip().startswith("#")):
        at -= 1
    block.lines.insert(at, line)


def _comment_above(lines: list[str]) -> list[str]:
    """Takes the comment that ends some lines away from them: it belongs to what comes next."""
    at = len(lines)
    while at > 0 and lines[at - 1].lstrip().startswith("#"):
        at -= 1
    if at == 0:  # the comment that opens the file stays
        return []
    above = lines[at:]
    del lines[at:]
    return above


def _opened(line: str) -> int:
    """By how much brackets are deeper after a line; strings and comments do not count."""
    bare = re.sub(r'"(\\.|[^"\\])*"|\'[^\']*\'', "", line).split("#")[0]
    return sum(bare.count(c) for c in "[{") - sum(bare.count(c) for c in "]}")
