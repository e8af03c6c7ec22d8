"""The messages of refusals as the code has them: texts with ``{}`` for what is filled in."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import ringlet

SOURCE = Path(ringlet.__file__).parent
WORDS = 3  # of a text that is a message, and not another one with a place before it
ADVICE = re.compile(r"; |\bmust |: [a-z]+ |, change |\bneeds |\bgiven as |\S\{\}$")  # a last {} says what there is
RAISED = ("UserError", "BadParameter", "refuse")  # ``refuse`` makes that of a setting


@cache
def texts() -> dict[str, list[str]]:
    """The texts, and the places of each: ``io/hair.py:42``."""
    found: dict[str, list[str]] = {}
    for path in sorted(SOURCE.rglob("*.py")):
        for text, line in _texts(ast.parse(path.read_text())):
            if len(re.findall(r"[a-z]{2,}", text)) >= WORDS:
                found.setdefault(text, []).append(f"{path.relative_to(SOURCE)}:{line}")
    return found


def texts_with(part: str) -> list[str]:
    """The text that is the part, or those that have it."""
    return [part] if part in texts() else [text for text in texts() if part in text]


def pattern(part: str) -> str:
    """A regular expression for messages with a part of a text."""
    return ".*".join(re.escape(piece) for piece in part.split("{}"))


def _texts(tree: ast.AST) -> Iterator[tuple[str, int]]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and node.args and _name(node.func) in RAISED:
            yield _text(node.args[0]), node.lineno


def _name(function: ast.expr) -> str:
    return function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")


def _text(node: ast.expr) -> str:
    match node:
        case ast.Constant(value=str(text)):
            return text
        case ast.JoinedStr(values=parts):
            return "".join(map(_text, parts))
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return _text(left) + _text(right)
    return "{}"
