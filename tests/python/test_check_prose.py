"""The script that checks the documents, which `tools/lint.sh` runs on them all, sees long paragraphs and sentences."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
WORDS_20 = " ".join(["locks"] * 20)
LONG_SENTENCE = f"{WORDS_20} {WORDS_20}."
LONG_PARAGRAPH = f"{WORDS_20}.\n" * 7


@pytest.fixture(scope="module")
def prose():
    sys.path.insert(0, str(ROOT / "tools"))
    spec = importlib.util.spec_from_file_location("check_prose", ROOT / "tools/check_prose.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    sys.modules["check_prose"] = module
    spec.loader.exec_module(module)
    sys.path.remove(str(ROOT / "tools"))
    return module


def test_pages_outside_the_documents_are_checked_too(prose):
    assert {"README.md", "CONTRIBUTING.md"} <= set(prose.pages(ROOT))


@pytest.mark.parametrize(
    ("page", "line", "unit"),
    [
        (f"# Title\n\n{LONG_SENTENCE}", 3, "sentence"),
        (f"Short.\n{LONG_SENTENCE}", 2, "sentence"),
        (f"- Short.\n- {LONG_SENTENCE}", 2, "sentence"),
        (f":::{{note}}\n{LONG_SENTENCE}\n:::", 2, "sentence"),
        (f"term\n: {LONG_SENTENCE}", 2, "sentence"),
        (f"[{WORDS_20}](page.md) {WORDS_20}.", 1, "sentence"),
        (f"```sh\ncode\n```\n{LONG_SENTENCE}", 4, "sentence"),
        (LONG_PARAGRAPH, 1, "paragraph"),
        (f"- Short.\n- {LONG_PARAGRAPH}", 2, "paragraph"),
    ],
)
def test_a_long_paragraph_and_a_long_sentence_are_found(prose, page, line, unit):
    assert [(at, what.split()[0]) for at, what in prose.hits(page)] == [(line, unit)]


@pytest.mark.parametrize(
    "page",
    [
        f"# {LONG_SENTENCE}",
        f"```\n{LONG_SENTENCE}\n```",
        f"~~~\n```\n{LONG_SENTENCE}\n~~~",
        f":::{{toctree}}\n{LONG_SENTENCE}\n:::",
        f"| {LONG_SENTENCE} |",
        f"<p>{LONG_SENTENCE}</p>",
        f"![{LONG_SENTENCE}](picture.jpg)",
        f"A command: `{LONG_SENTENCE}`",
        f"A formula: ${LONG_SENTENCE}$",
        f"[A link](https://example.org/{WORDS_20.replace(' ', '-')}-{WORDS_20.replace(' ', '-')})",
        f"{WORDS_20}\n\n{WORDS_20}",
        f"- {WORDS_20}\n- {WORDS_20}\n",
        f"{WORDS_20}.\n\n" * 7,
    ],
)
def test_code_tables_headings_and_short_text_are_not_reported(prose, page):
    assert list(prose.hits(page)) == []
