"""What small workloads cost, in instructions of the core and in calls of Python, against the counts that are kept.

Clocks are noisy, counts are not: a workload that takes more than 3 % more of them has become slower. Who means that
writes the new counts with the reason in the same commit: ``python tests/counts/test_counts.py``.
"""

from __future__ import annotations

import cProfile
import json
import platform
import pstats
import re
import shutil
import sys
import tempfile
from pathlib import Path

import callgrind
import pytest
import workloads

import ringlet
from ringlet import _core

KEPT = Path(__file__).with_name("counts.json")
MORE = 1.03  # than the count that is kept fails
SHOWN = 5  # functions that grew most
FUNCTIONS = 40  # of a workload that are kept, those that take most


def compiler() -> str:
    """What compiled the core; other compilers make other instructions."""
    found = re.search(rb"GCC: \([^)]*\) [\d.]+|clang version [\d.]+", Path(_core.__file__).read_bytes())
    return found[0].decode() if found else "unknown"


def python() -> str:
    """The version of Python without its last part."""
    return "Python " + ".".join(platform.python_version_tuple()[:2])


def calls_of_python() -> dict[str, int]:
    """Calls that Ringlet's own functions make, and those that are made of them."""
    own, counts = str(Path(ringlet.__file__).parent), {}
    for workload in workloads.IN_PYTHON:
        for _ in workload():  # imports what is imported late
            pass
        running = workload()
        next(running)
        profile = cProfile.Profile()
        profile.enable()
        next(running, None)
        profile.disable()
        counts[workload.__name__] = sum(
            count
            for (file, _, _), (*_, callers) in pstats.Stats(profile).stats.items()
            for (caller, _, _), (count, *_) in callers.items()
            if file.startswith(own) or caller.startswith(own)
        )
    return counts


def growth(name: str, was: dict[str, int], now: dict[str, int]) -> str | None:
    """A message where a workload takes more instructions, with the functions that grew most.

    was: of all functions together, and of those that took most
    """
    before, after = was["all"], sum(now.values())
    if after <= MORE * before:
        return None
    grown = sorted(now, key=lambda function: was.get(function, 0) - now[function])[:SHOWN]
    lines = (f"  {was.get(function, 0):>12,} -> {now[function]:>12,}  {function[:90]}" for function in grown)
    return "\n".join([f"{name}: {before:,} -> {after:,} instructions, {after / before - 1:+.1%}; most grew", *lines])


def kept(part: str, made_with: str) -> dict:
    """The counts that are kept; skips where they are of another compiler or Python."""
    counts = json.loads(KEPT.read_text())[part]
    if counts["made_with"] != made_with:
        pytest.skip(f"the counts are of {counts['made_with']}, and this is {made_with}")
    return counts["workloads"]


NEEDED = ("valgrind", "cc")


@pytest.mark.skipif(not all(map(shutil.which, NEEDED)), reason="needs valgrind and a C compiler")
def test_no_workload_takes_more_instructions_of_the_core(tmp_path):
    was = kept("instructions", compiler())
    now = callgrind.counted(Path(workloads.__file__), tmp_path)
    assert now.keys() == was.keys()
    grown = [message for name in was if (message := growth(name, was[name], now[name]))]
    assert not grown, "\n".join(grown)


def test_no_workload_makes_more_calls_of_python():
    was, now = kept("calls", python()), calls_of_python()
    assert now.keys() == was.keys()
    grown = {name: (was[name], now[name]) for name in was if now[name] > MORE * was[name]}
    assert not grown, f"calls before and now: {grown}"


def test_functions_that_grow_are_named():
    message = growth("nod", {"all": 1000, "solve": 900, "limit": 100}, {"solve": 900, "limit": 150})
    assert message.splitlines()[0] == "nod: 1,000 -> 1,050 instructions, +5.0%; most grew"
    assert message.splitlines()[1].endswith("100 ->          150  limit")
    assert growth("nod", {"all": 1000, "solve": 1000}, {"solve": 1030}) is None


def test_costs_of_calls_are_those_of_the_caller_alone():
    dump = """events: Ir
ob=(1) /lib/ringlet/_core.so
fl=(1) a.cpp
fn=(1) step
10 5
cob=(2) /lib/libc.so
cfn=(2) memcpy
calls=2 0
11 700
+1 3
ob=(2)
fn=(2)
0 700
ob=(1)
fn=(3) solve
* 20
fn=(1)
12 2
"""
    assert callgrind.by_function(dump) == {"step": 10, "solve": 20}


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        instructions = callgrind.counted(Path(workloads.__file__), Path(folder))
    most = {
        name: {"all": sum(by.values())} | dict(sorted(by.items(), key=lambda item: -item[1])[:FUNCTIONS])
        for name, by in instructions.items()
    }
    written = {
        "instructions": {"made_with": compiler(), "workloads": dict(sorted(most.items()))},
        "calls": {"made_with": python(), "workloads": calls_of_python()},
    }
    KEPT.write_text(json.dumps(written, indent=1) + "\n")
    sys.stdout.write(f"{KEPT}\n")
