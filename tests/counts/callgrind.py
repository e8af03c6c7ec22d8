"""Counts instructions by callgrind: a shim that tells it when, and a reader of what it writes."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

SHIM = """
#include <valgrind/callgrind.h>
void begin(void) { CALLGRIND_START_INSTRUMENTATION; CALLGRIND_ZERO_STATS; }
void end(const char *name) { CALLGRIND_DUMP_STATS_AT(name); CALLGRIND_STOP_INSTRUMENTATION; }
"""

LONGEST = 120  # name of a function; those with the same beginning are counted as one

# One thread and one instruction set everywhere.
SURROUNDINGS = {
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "PYTHONHASHSEED": "0",
    "RINGLET_SIMD": "baseline",
}


def counted(script: Path, folder: Path) -> dict[str, dict[str, int]]:
    """Instructions by function of the core, for each workload that the script runs between the requests of the shim.

    folder: for what callgrind writes
    """
    source, shim = folder / "shim.c", folder / "shim.so"
    source.write_text(SHIM)
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", str(source), "-o", str(shim)], check=True)

    options = ["--tool=callgrind", "--instr-atstart=no", f"--callgrind-out-file={folder / 'out'}", "-q"]
    workloads = [sys.executable, str(script), str(shim)]
    subprocess.run(["valgrind", *options, *workloads], env=os.environ | SURROUNDINGS, check=True)
    counts = {}
    for dump in folder.glob("out*.*"):
        text = dump.read_text()
        if name := re.search(r"^desc: Trigger: Client Request: (\w+)", text, re.MULTILINE):
            counts[name[1]] = by_function(text)
    return counts


def by_function(dump: str, library: str = "ringlet/_core") -> dict[str, int]:
    """Instructions in each function of a library, without those of what it calls (Callgrind Format Specification)."""
    names: dict[tuple[str, str], str] = {}  # of compressed names, by their kind and number
    costs: dict[str, int] = defaultdict(int)
    here = {"ob": "", "fn": ""}
    inclusive = False
    for line in dump.splitlines():
        if named := re.match(r"(c?)(ob|fn|fl|fi|fe|file)=\((\d+)\)(?: (.*))?", line):
            called, kind, number, name = named.groups()
            if name is not None:
                names[kind, number] = name
            if not called and kind in here:
                here[kind] = names[kind, number]
        elif line.startswith("calls="):
            inclusive = True  # the next line has what the call costs
        elif cost := re.match(r"[-+*\d]\S* (\d+)$", line):
            if not inclusive and library in here["ob"]:
                costs[short(here["fn"])] += int(cost[1])
            inclusive = False
    return dict(costs)


def short(function: str) -> str:
    """A function's name without the arguments of templates that are long, and with ``Pack`` for its lanes."""
    return re.sub(r"double __vector\(\d+\)", "Pack", function)[:LONGEST]
