"""Checks the words of identifiers, comments and docstrings: the retired ones are those of docs/glossary.md.

Usage: python tools/check_words.py [--count] [FOLDER ...]. Checks every folder of code if none is named. Prints one line
per hit and exits with 1 if there is one; --count prints the hits of each folder.
"""

from __future__ import annotations

import argparse
import ast
import io
import re
import sys
import tokenize
from collections import Counter
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

FOLDERS = ("src", "bindings", "python", "tests", "bench", "examples", "tools", "web/src")
# Retired words that stay for the callers of a public function, by file.
PUBLIC = {"python/ringlet/viewer/run.py": {"told"}, "tests/browser/zygote.py": {"told"}}
LONGEST = 35  # words of a sentence
SUFFIXES = {".h", ".cpp", ".py", ".ts"}

ROW = re.compile(r"^\| *(?P<words>[^|]+?) *\| *(?P<say>[^|]+?) *\| *(?P<folders>[^|]*?) *\|$", re.MULTILINE)
CAMEL = re.compile(r"(?<=[a-z])(?=[A-Z])")
WORD = re.compile(r"(?:[^\W\d_]{2,}|\b[aAI]\b)(?:['’-][^\W\d_]+)*")  # not the single letters of formulas
# Blank lines, list items, and indented lines, which are formulas, end a sentence as well.
SENTENCE_END = re.compile(r"[.!?][)\"'’”]*\s|\n\s*\n|\n(?=(?:[-*|] |\w+: |``| {2,}\S))|^ {2,}.*\n", re.MULTILINE)
C_LIKE = re.compile(
    r"(?P<comment>//[^\n]*|/\*.*?\*/)|R\"\(.*?\)\"|\"(?:\\.|[^\"\\\n])*\"|(?<!\w)'(?:\\.|[^'\\\n])*'|`(?:\\.|[^`\\])*`"
    r"|(?P<name>[^\W\d]\w*)",
    re.DOTALL,
)


class Retired(NamedTuple):
    """A retired word or phrase. One in backticks is refused in identifiers alone, one with folders in these alone."""

    words: str
    say: str
    folders: tuple[str, ...]
    only_names: bool


class Piece(NamedTuple):
    """A comment, a docstring, or an identifier, where it begins."""

    line: int
    column: int
    text: str
    kind: str = "prose"  # "name" for an identifier, "line" for a comment that has its lines to itself


def retired_words(glossary: str) -> list[Retired]:
    """Entries of the table below the heading "Retired words": words | say instead | folders."""
    rows = list(ROW.finditer(glossary.split("## Retired words", 1)[1]))[2:]  # without the head and its rule
    return [
        Retired(word.strip("` "), row["say"], tuple(row["folders"].replace("`", "").split()), "`" in word)
        for row in rows
        for word in row["words"].split(",")
    ]


def c_like_pieces(source: str) -> Iterator[Piece]:
    """Identifiers and comment lines of C++ or TypeScript."""
    for match in C_LIKE.finditer(source):
        if text := match["name"] or match["comment"]:
            begin = source.rfind("\n", 0, match.start()) + 1
            kind = "name" if match["name"] else "prose" if source[begin : match.start()].strip() else "line"
            yield Piece(source.count("\n", 0, match.start()) + 1, match.start() - begin, text, kind)


def python_pieces(source: str) -> Iterator[Piece]:
    """Identifiers, comment lines and docstrings of Python."""
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type in (tokenize.NAME, tokenize.COMMENT):
            behind = "prose" if token.line[: token.start[1]].strip() else "line"
            yield Piece(*token.start, token.string, "name" if token.type == tokenize.NAME else behind)
    for node in ast.walk(ast.parse(source)):
        has_docstring = isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef)
        if has_docstring and (text := ast.get_docstring(node)):
            yield Piece(node.body[0].lineno, 0, text)


def joined(pieces: Iterator[Piece]) -> Iterator[Piece]:
    """The pieces, where a comment and the comment lines below it, in the same column, are one text."""
    block = Piece(0, 0, "")
    for piece in pieces:
        if piece.kind == "name":
            yield piece
            continue
        text = re.sub(r"(?m)^\s*(?:/{2,}|/\*+|\*+/?|#+!?) ?|\*/$", "", piece.text)
        if piece.kind == "line" and piece[:2] == (block.line + block.text.count("\n") + 1, block.column):
            block = block._replace(text=f"{block.text}\n{text}")
        else:
            yield block
            block = piece._replace(text=text)
    yield block


def pattern(retired: tuple[Retired, ...], separator: str) -> re.Pattern[str]:
    """Finds retired words, whole ones in any case; the group of a match is named after the place in the list."""
    found = "|".join(f"(?P<w{i}>{r.words.replace(' ', separator)})" for i, r in enumerate(retired))
    return re.compile(rf"(?<![^\W\d_])(?:{found or '(?!)'})(?![^\W\d_])", re.IGNORECASE)


@cache
def complaints_of(words: tuple[Retired, ...]) -> Callable[[str, bool], list[tuple[int, str]]]:
    """Finds lines and complaints in a text, by whether it is an identifier. Each text is searched once."""
    in_prose = tuple(word for word in words if not word.only_names)
    searches = {True: (words, pattern(words, "_")), False: (in_prose, pattern(in_prose, r"[\s_-]+"))}

    @cache
    def complaints(text: str, is_name: bool) -> list[tuple[int, str]]:
        listed, search = searches[is_name]
        text, found = CAMEL.sub("_", text), []
        for match in search.finditer(text):
            word = listed[int((match.lastgroup or "w0")[1:])]
            found.append((text.count("\n", 0, match.start()), f"{word.words} → {word.say}"))
        begin = 0
        for end in [*(match.end() for match in SENTENCE_END.finditer(text)), len(text)]:
            if (count := len(WORD.findall(text, begin, end))) > LONGEST:
                found.append((text.count("\n", 0, begin), f"sentence of {count} words → at most {LONGEST}"))
            begin = end
        return found

    return complaints


def hits(root: Path, folders: tuple[str, ...], retired: list[Retired]) -> Iterator[tuple[Path, int, str]]:
    """File, line and complaint of every retired word and of every sentence that is too long."""
    for file in sorted(file for folder in folders for file in (root / folder).rglob("*") if file.suffix in SUFFIXES):
        where = file.relative_to(root)
        public = PUBLIC.get(where.as_posix(), set())
        complaints = complaints_of(
            tuple(
                word
                for word in retired
                if word.words not in public and (not word.folders or str(where).startswith(word.folders))
            )
        )
        pieces = python_pieces if file.suffix == ".py" else c_like_pieces
        for line, _, text, kind in sorted(set(joined(pieces(file.read_text())))):
            for below, complaint in complaints(text, kind == "name"):
                yield where, line + below, complaint


def main() -> int:
    """Prints the hits of this tree."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*")
    parser.add_argument("--count", action="store_true")
    options = parser.parse_args()
    root = Path(__file__).parents[1]
    folders = tuple(options.folders) or FOLDERS
    found = list(hits(root, folders, retired_words((root / "docs/glossary.md").read_text())))
    lines = [f"{where}:{line}: {complaint}\n" for where, line, complaint in found]
    if options.count:
        count = Counter((str(where.parent), complaint.startswith("sentence of")) for where, _, complaint in found)
        lines = [f"{f}: {count[f, False]} words, {count[f, True]} sentences\n" for f in sorted({f for f, _ in count})]
    print("".join(lines), end="")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
