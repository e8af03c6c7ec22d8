"""Checks the length of paragraphs and sentences in the documents.

Usage: python tools/check_prose.py [--count] [PAGE ...]. Checks all pages if none is named. Prints one line per hit and
exits with 1 if there is one; --count prints for each page its words, longest paragraph, longest sentence and hits.

A paragraph is a block of lines of text or one list item. Code, tables, headings, directives, HTML, formulas between
dollar signs, images and the targets of links do not count; inline code counts as one word.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from check_words import LONGEST, WORD

PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "bench/README.md", "examples/README.md", "docs/**/*.md")
MOST = {"paragraph": 120, "sentence": LONGEST}  # words
SENTENCE_END = re.compile(r"[.!?][)\"'’”*_]*\s")

FENCE = re.compile(r"\s*(?P<fence>`{3,}|~{3,})")
NO_TEXT = re.compile(r"\s*(#|\||<|:::|\$\$|\[[^\]]+\]: |:[\w-]+:)|\s*([-*_] ?){3,}$")
ITEM = re.compile(r"\s*(?:[-*+]|\d+[.)]|:)\s+|\s*> ?")
INLINE = (
    (re.compile(r"(`+).+?\1", re.DOTALL), "code"),
    (re.compile(r"\$[^$\s][^$]*\$"), " "),
    (re.compile(r"!\[[^\]]*\]\([^)]*\)"), " "),
    (re.compile(r"\]\([^)]*\)"), "]"),
    (re.compile(r"<[^>\s][^>]*>"), " "),
)


class Paragraph(NamedTuple):
    """A paragraph and the line on which it begins."""

    line: int
    text: str


def text_lines(page: str) -> Iterator[tuple[int, str]]:
    """Number and text of each line; what is no text is an empty line."""
    fence = ""
    toctree = False
    for number, line in enumerate(page.splitlines(), 1):
        match = FENCE.match(line)
        if fence:
            is_end = match and match["fence"].startswith(fence) and not line.strip(" `~")
            fence = "" if is_end else fence
            yield number, ""
        elif toctree or line.startswith(":::{toctree}"):
            toctree = line.strip() != ":::"
            yield number, ""
        elif match:
            fence = match["fence"]
            yield number, ""
        else:
            yield number, "" if NO_TEXT.match(line) else line


def paragraphs(page: str) -> Iterator[Paragraph]:
    """The paragraphs of a page, without markup."""
    block = Paragraph(0, "")
    for number, line in [*text_lines(page), (0, "")]:
        begins = ITEM.match(line)
        if block.text and (begins or not line.strip()):
            yield block
            block = Paragraph(0, "")
        if line.strip():
            text = line[begins.end() :] if begins else line
            block = Paragraph(block.line or number, f"{block.text}\n{text}" if block.text else text)


def plain(text: str) -> str:
    """The text with as many lines, inline code as one word, and without formulas, images and targets of links."""
    for found, instead in INLINE:
        text = found.sub(lambda match, instead=instead: instead + "\n" * match[0].count("\n"), text)
    return text


def lengths(page: str) -> Iterator[tuple[int, str, int]]:
    """Line, "paragraph" or "sentence", and number of words of each of both."""
    for line, text in paragraphs(page):
        words = plain(text)
        yield line, "paragraph", len(WORD.findall(words))
        begin = 0
        for end in [*(match.end() for match in SENTENCE_END.finditer(words)), len(words)]:
            yield line + words.count("\n", 0, begin), "sentence", len(WORD.findall(words, begin, end))
            begin = end


def hits(page: str) -> Iterator[tuple[int, str]]:
    """Line and complaint of each paragraph and each sentence that is too long."""
    for line, unit, count in lengths(page):
        if count > MOST[unit]:
            yield line, f"{unit} of {count} words → at most {MOST[unit]}"


def summary(page: str) -> str:
    """Words, longest paragraph, longest sentence and number of hits of a page."""
    counts: dict[str, list[int]] = {"paragraph": [0], "sentence": [0]}
    for _, unit, count in lengths(page):
        counts[unit].append(count)
    longest = ", ".join(f"longest {unit} {max(of)}" for unit, of in counts.items())
    return f"{sum(counts['paragraph'])} words, {longest}, {sum(1 for _ in hits(page))} hits"


def pages(root: Path) -> list[str]:
    """All pages of the tree, relative to it, without those that are generated."""
    found = {page.relative_to(root).as_posix() for pattern in PAGES for page in root.glob(pattern)}
    return sorted(page for page in found if not page.startswith(("docs/_build/", "docs/_generated/")))


def main() -> int:
    """Prints the hits of this tree."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pages", nargs="*", metavar="PAGE")
    parser.add_argument("--count", action="store_true")
    options = parser.parse_args()
    root = Path(__file__).parents[1]
    chosen = options.pages or pages(root)
    texts = {page: (root / page).read_text() for page in chosen}
    found = [(page, *hit) for page, text in texts.items() for hit in hits(text)]
    lines = [f"{page}:{line}: {complaint}\n" for page, line, complaint in found]
    if options.count:
        lines = [f"{page}: {summary(text)}\n" for page, text in texts.items()]
    print("".join(lines), end="")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
