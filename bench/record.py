"""Runs benchmarks and stores their results in bench/results, the source of all figures of the documents.

    .venv/bin/python bench/record.py twirl --strands 256 --threads 1
    .venv/bin/python bench/record.py tools/proof/braids.py 48

A name is that of a benchmark, or of a program that prints its result as JSON; programs are not measured by turns.
Without arguments it measures all that are kept and whose sources have changed since. ``--from COMMIT`` before a name
measures by turns with that commit, instead of the one measured last.
"""

from __future__ import annotations

import json
import os
import shlex
import shutil
import subprocess
import sys
from datetime import date
from pathlib import Path
from typing import Any

from compare import git, run

RESULTS = Path(__file__).with_name("results")
ROOT = RESULTS.parents[1]
CORE = ("src",)
GROOM = (*CORE, *(f"python/ringlet/{name}" for name in ("data", "deform", "groom", "io")))
SIM = (*GROOM, "python/ringlet/sim")
REST = (*SIM, "python/ringlet/rest")
LIVE = (*REST, "python/ringlet/live")
UNTIMED = {"iterations", "live", "liveliness", "nest", "noise", "serial", "tips", "warp"}  # not by turns: no times
MEASURED = {  # folders, where not the core alone
    "groom": GROOM,
    "slider": GROOM,
    "warp": SIM,
    "collide": GROOM,
    "hairs": GROOM,
    "noise": ("python/ringlet/picture", "python/ringlet/deform"),
    "rest": REST,
    "live": LIVE,
    "looks": LIVE,
    "adopt": (*GROOM, "python/ringlet/adoption"),
    "braids": SIM,
    "hair_intersections": SIM,
    "rest_shapes": REST,
}


def record(arguments: list[str], reference: str | None = None) -> Path:
    """Runs a benchmark or a program; returns the file with the result, the commit, the machine and the date.

    reference: commit that it is measured by turns with; by default that of the result that is kept
    """
    first, *rest = arguments
    name, program = Path(first).stem, first.endswith(".py")
    words = (word.removeprefix("--").replace(" ", "-").replace("/", "_") for word in rest)
    path = RESULTS / ("_".join([name, *words]) + ".json")
    kept = json.loads(path.read_text()) if path.exists() else {}
    commit, sources = version(name)
    ringlet = Path(sys.executable).with_name("ringlet")
    bench = [str(ringlet if ringlet.exists() else shutil.which("ringlet")), "bench", *arguments, "--json"]
    command = [sys.executable, *arguments] if program else bench
    load = os.getloadavg()[0]
    process = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    RESULTS.mkdir(exist_ok=True)
    entry: dict[str, Any] = {
        "command": shlex.join([*(["python"] if program else ["ringlet", "bench"]), *arguments]),
        "commit": commit,
        "sources": sources,
        "date": date.today().isoformat(),
        "processor": processor(),
        "load": round(load, 1),
        "result": json.loads(process.stdout),
    }
    if reference := reference or (None if program or name in UNTIMED else kept.get("commit")):
        turns = run((reference, " ".join(arguments)))[" ".join(arguments)]
        entry["reference"] = {"commit": reference, **{name: turns[name] for name in ("ratio", "least", "most")}}
    path.write_text(json.dumps(entry, indent=1) + "\n")
    return path


def version(name: str) -> tuple[str, dict[str, str]]:
    """The commit, and what git calls the folders that a benchmark measures; ends where these are changed.

    So a page knows whether a figure is of the sources of today.
    """
    folders = MEASURED.get(name, CORE)
    if changed := git("status", "--porcelain", "--", *folders, cwd=ROOT).stdout:
        sys.exit(f"record: sources are not committed, so no commit says what is measured; commit them:\n{changed}")
    return git("rev-parse", "--short", "HEAD", cwd=ROOT).stdout.strip(), {folder: tree(folder) for folder in folders}


def tree(folder: str) -> str:
    """What git calls the content of a folder."""
    return git("rev-parse", f"HEAD:{folder}", cwd=ROOT).stdout.strip()


def stale() -> list[list[str]]:
    """The arguments of all results that are kept and not of the sources of today."""
    runs = [json.loads(path.read_text()) for path in sorted(RESULTS.glob("*.json"))]
    return [
        shlex.split(run["command"].removeprefix("ringlet bench ").removeprefix("python "))
        for run in runs
        if any(run.get("sources", {}).get(folder) != tree(folder) for folder in run.get("sources", CORE))
    ]


def processor() -> str:
    """Name of the processor and number of its cores."""
    info = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else ""
    names = [line.split(":", 1)[1].strip() for line in info.splitlines() if line.startswith("model name")]
    return f"{names[0] if names else 'unknown'}, {os.cpu_count()} cores"


if __name__ == "__main__":
    words = sys.argv[1:]
    reference = words[1] if words[:1] == ["--from"] else None
    words = words[2:] if reference else words
    for arguments in [words] if words else stale():
        print(record(arguments, reference), flush=True)
