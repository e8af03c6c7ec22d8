"""Runs a benchmark and keeps what it says in bench/results, from which the page of benchmarks is made.

.venv/bin/python bench/record.py twirl --strands 256 --threads 1
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from datetime import date
from pathlib import Path

RESULTS = Path(__file__).with_name("results")


def record(arguments: list[str]) -> Path:
    """Runs ``ringlet bench`` with these arguments; returns the file that tells what came out, where and when."""
    ringlet = Path(sys.executable).with_name("ringlet")
    command = [str(ringlet if ringlet.exists() else shutil.which("ringlet")), "bench", *arguments, "--json"]
    load = os.getloadavg()[0]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    path = RESULTS / ("_".join(argument.removeprefix("--") for argument in arguments) + ".json")
    RESULTS.mkdir(exist_ok=True)
    told = {
        "command": " ".join(["ringlet", "bench", *arguments]),
        "date": date.today().isoformat(),
        "processor": processor(),
        "load": round(load, 1),
        "result": json.loads(done.stdout),
    }
    path.write_text(json.dumps(told, indent=1) + "\n")
    return path


def processor() -> str:
    """What the processor is called, and how many of its cores there are."""
    info = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else ""
    names = [line.split(":", 1)[1].strip() for line in info.splitlines() if line.startswith("model name")]
    return f"{names[0] if names else 'unknown'}, {os.cpu_count()} cores"


if __name__ == "__main__":
    print(record(sys.argv[1:]))
