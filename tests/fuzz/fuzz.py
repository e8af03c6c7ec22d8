"""Looks for files that a reader cannot bear, guided by coverage: python tests/fuzz/fuzz.py TARGET SECONDS [FOLDER].

Needs atheris. What is found is written to the current folder as crash-…, timeout-… or oom-…; put it into
tests/fuzz/corpus/TARGET and mend the reader: the tests run all that is there. FOLDER keeps what was
learnt.
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
    """All functions of ours and of the TOML parser. Their import is not instrumented: an editable install has a loader
    of its own, which atheris does not know."""
    for name, module in list(sys.modules.items()):
        if name.partition(".")[0] not in ("ringlet", tomllib.__name__):
            continue
        for thing in [*vars(module).values()]:
            if getattr(thing, "__module__", None) != name:
                continue
            members = vars(thing).values() if isinstance(thing, type) else (thing,)
            yield from (member for member in members if isinstance(member, types.FunctionType))


def words() -> Iterator[str]:
    """All names of settings, for the fuzzer to put together."""
    tables = list(ringlet.schema().values())
    while tables:
        table = tables.pop()
        yield from table.get("properties", {})
        tables += table.get("$defs", {}).values()


def main() -> None:
    """Fuzzes one target for a time, from the inputs that are kept for it."""
    name, seconds, *more = sys.argv[1:]
    target = TARGETS[name]
    seeds = Path(__file__).parent / "corpus" / name
    with tempfile.TemporaryDirectory() as folder:
        dictionary = Path(folder) / "words.txt"
        dictionary.write_text("".join(f'"{word}"\n' for word in sorted(set(words()))))
        place = Path(folder) / "files"
        place.mkdir()
        learnt = Path(*more) if more else Path(folder) / "learnt"
        learnt.mkdir(exist_ok=True)
        options = [f"-max_total_time={seconds}", f"-dict={dictionary}", *LIMITS, str(learnt), str(seeds)]
        for function in functions():
            atheris.instrument_func(function)
        atheris.Setup([sys.argv[0], *options], lambda data: try_out(target, data, place))
        atheris.Fuzz()


if __name__ == "__main__":
    main()
