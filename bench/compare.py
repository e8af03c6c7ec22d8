"""Runs benchmarks by turns: this Ringlet against a reference commit, built in a work tree of its own."""

from __future__ import annotations

import json
import os
import shlex
import statistics
import subprocess
import sys
import sysconfig
from pathlib import Path
from typing import Any

from ringlet import UserError

ROOT = Path(__file__).parents[1]
MAIN = "import sys; from ringlet.cli import main; sys.exit(main())"


def run(words: tuple[str, ...] = (), turns: int = 3) -> dict[str, Any]:
    """Compares processor times per evaluation: ``ringlet bench compare COMMIT NAME…``.

    words: a commit, and benchmarks with their parameters, such as "twirl --strands 256 --threads 1";
           "twirl --newton 5 against twirl" runs what stands before "against" at the commit, the rest here
    turns: runs of each of the two, one after the other
    """
    if len(words) < 2:
        raise UserError("bench compare: needs a commit and a benchmark: ringlet bench compare v0.1.0 strands")
    commit, names = words[0], words[1:]
    there = built(commit)
    times: dict[str, tuple[list[float], list[float]]] = {name: ([], []) for name in names}
    for _ in range(turns):
        for name in names:
            before, _, now = name.partition(" against ")
            for python, benchmark, taken in zip(
                (there, sys.executable), (before, now or before), times[name], strict=True
            ):
                taken.append(measured(str(python), benchmark))
    return {name: row(commit, *both) for name, both in times.items()}


def row(commit: str, there: list[float], here: list[float]) -> dict[str, Any]:
    """Medians [ms], their ratio, and the least and the largest ratio of a turn."""
    ratios = [b / a for a, b in zip(there, here, strict=True)]
    before, now = statistics.median(there), statistics.median(here)
    return {commit: before, "here": now, "ratio": now / before, "least": min(ratios), "most": max(ratios)}


def measured(python: str, name: str) -> float:
    """Processor time of an evaluation [ms], the median of one run of a benchmark."""
    words = shlex.split(name)
    done = subprocess.run([python, "-c", MAIN, "bench", *words, "--json"], stdout=subprocess.PIPE, text=True)
    if done.returncode:
        raise UserError(f"bench compare: {name}: ended with {done.returncode} under {python}; run it alone to see why")
    return float(json.loads(done.stdout)["cpu_ms"]["median"])


def built(commit: str) -> Path:
    """The Python of an environment with Ringlet at a commit, and otherwise with what this one has."""
    found = git("rev-parse", "--verify", "--quiet", f"{commit}^{{commit}}", cwd=ROOT).stdout.strip()
    if not found:
        raise UserError(f"bench compare: {commit}: is no commit of the clone at {ROOT}; see git log")
    place = ROOT / "build" / "compare" / found[:12]
    python = place / "venv" / "bin" / "python"
    if (place / "whole").exists():
        return python
    if not (place / "tree").exists():
        git("worktree", "add", "--detach", "--force", str(place / "tree"), found, cwd=ROOT)
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(place / "venv")], check=True)
    own = place / "venv" / Path(sysconfig.get_path("purelib")).relative_to(sys.prefix)
    (own / "packages.pth").write_text("".join(f"{path}\n" for path in sys.path if path.endswith("site-packages")))
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-build-isolation", "--no-deps", "--target", str(own)]
    subprocess.run([*pip, str(place / "tree")], check=True, env=os.environ | {"PIP_DISABLE_PIP_VERSION_CHECK": "1"})
    (place / "whole").touch()
    return python


def git(*words: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    """The output of a command of git, without an error where it fails."""
    return subprocess.run(["git", *words], cwd=cwd, stdout=subprocess.PIPE, text=True)
