"""Coverage-guided fuzzing of a reader: python tests/fuzz/fuzz.py TARGET SECONDS [FOLDER].

Needs atheris. Findings are written to the current folder as crash-…, timeout-… or oom-…. Add them to
tests/fuzz/corpus/TARGET, which the tests run, and repair the reader. FOLDER keeps the inputs that extended coverage.
"""

from __future__ import annotations

import sys
import tempfile
import tomllib
import types
from collections.abc import Iterator
from pathlib import Path

import atheris
from targets import TARGETS, try_out

import ringlet

LIMITS = ("-rss_limit_mb=3000", "-timeout=20", "-max_len=4096")


def functions() -> Iterator[types.FunctionType]:
    """Functions of Ringlet and of the TOML parser, to be instrumented.

    Atheris cannot instrument their import, since an editable install uses its own loader.
    """
    for name, module in list(sys.modules.items()):
        if name.partition(".")[0] not in ("ringlet", tomllib.__name__):
            continue
        for thing in [*vars(module).values()]:
            if getattr(thing, "__module__", None) != name:
                continue
            members = vars(thing).values() if isinstance(thing, type) else (thing,)
            yield from (member for member in members if isinstance(member, types.FunctionType))


def words() -> Iterator[str]:
    """Names of all settings, for the dictionary of the fuzzer."""
    tables = list(ringlet.schema().values())
    while tables:
        table = tables.pop()
        yield from table.get("properties", {})
        tables += table.get("$defs", {}).values()


def main() -> None:
    """Fuzzes one target for a time, starting from its corpus."""
    name, seconds, *more = sys.argv[1:]
    target = TARGETS[name]
    seeds = Path(__file__).parent / "corpus" / name
    with tempfile.TemporaryDirectory() as folder:
        dictionary = Path(folder) / "words.txt"
        dictionary.write_text("".join(f'"{word}"\n' for word in sorted(set(words()))))
        files = Path(folder) / "files"
        files.mkdir()
        found = Path(*more) if more else Path(folder) / "found"
        found.mkdir(exist_ok=True)
        options = [f"-max_total_time={seconds}", f"-dict={dictionary}", *LIMITS, str(found), str(seeds)]
        for function in functions():
            atheris.instrument_func(function)
        atheris.Setup([sys.argv[0], *options], lambda data: try_out(target, data, files))
        atheris.Fuzz()


if __name__ == "__main__":
    main()
