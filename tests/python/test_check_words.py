"""The script that checks words, which `tools/lint.sh` runs on the whole tree, sees retired words and long sentences."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
GLOSSARY = """
## Retired words

| retired | say | folders |
|---|---|---|
| hold back, held back | limit the motion | |
| `met` | impact | |
| fade | spread the correction | `src/ringlet/ccd` |
"""
LONG = "Each of the strands " + "of a groom with very many strands " * 5 + "moves"


@pytest.fixture(scope="module")
def words():
    spec = importlib.util.spec_from_file_location("check_words", ROOT / "tools/check_words.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    sys.modules["check_words"] = module
    spec.loader.exec_module(module)
    return module


def found_in(words, root, file, text, glossary=GLOSSARY):
    (root / file).parent.mkdir(parents=True, exist_ok=True)
    (root / file).write_text(text)
    return [(str(where), line, what) for where, line, what in words.hits(root, ("src",), words.retired_words(glossary))]


def test_every_retired_word_of_the_glossary_is_refused_in_an_identifier(words, tmp_path):
    glossary = (ROOT / "docs/glossary.md").read_text()
    for word in words.retired_words(glossary):
        file = f"{word.folders[0]}/x.h" if word.folders and word.folders[0].startswith("src/") else "src/ringlet/x.h"
        found = found_in(words, tmp_path, file, f"int the_{word.words.replace(' ', '_')};\n", glossary)
        assert any(what.endswith(word.say) for _, _, what in found), word
        (tmp_path / file).unlink()


@pytest.mark.parametrize(
    ("file", "text", "line"),
    [
        ("src/a.h", "void hold_back(int x);", 1),
        ("src/a.h", "\nclass HoldBackScene {};", 2),
        ("src/a.cpp", "int x; // a strand is held back", 1),
        ("src/a.cpp", "// Strands of a pair are held\n// back near it.", 1),
        ("src/a.cpp", "// A pair.\n\n/* Strands are\n   held back. */", 4),
        ("src/a.cpp", "std::vector<Met> pairs;", 1),
        ("src/ringlet/ccd/a.cpp", "fade(scene);", 1),
        ("src/a.py", "def f():\n    held_back = 1", 2),
        ("src/a.py", 'def f():\n    """One line.\n\n    Held back, or not.\n    """', 4),
        ("src/a.ts", "const name = `x`; // held back", 1),
        ("src/a.h", f"// Short.\n// {LONG}.", 2),
        ("src/a.py", f'"""{LONG}."""', 1),
    ],
)
def test_a_retired_word_and_a_long_sentence_are_found(words, tmp_path, file, text, line):
    assert [(where, at) for where, at, _ in found_in(words, tmp_path, file, text)] == [(file, line)]


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("src/a.h", "int threshold_backward; // to hold; back again"),
        ("src/a.cpp", "// Two curves that met once."),
        ("src/a.cpp", 'auto message = "held back"; // a message is not checked here'),
        ("src/ringlet/strand/a.cpp", "double fade;"),
        ("src/a.h", "int a; // of the strands of a groom with very many strands\n" * 6),
        ("src/a.h", f"// {LONG[:80]}.\n// {LONG[:80]}.\n//   a = b + c\n// {LONG[:80]}"),
        ("src/a.py", f"# {LONG[:80]}\n\n# {LONG[:80]}\n\n# {LONG[:80]}"),
    ],
)
def test_ordinary_english_is_not_reported(words, tmp_path, file, text):
    assert found_in(words, tmp_path, file, text) == []


def test_a_hit_says_what_to_say_instead(words, tmp_path):
    assert found_in(words, tmp_path, "src/a.h", "int held_back;")[0][2] == "held back → limit the motion"
