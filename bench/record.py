"""Runs a benchmark and stores its result in bench/results, the source of the page of benchmarks.

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
    """Runs ``ringlet bench`` with arguments; returns the file with the result, the machine and the date."""
    ringlet = Path(sys.executable).with_name("ringlet")
    command = [str(ringlet if ringlet.exists() else shutil.which("ringlet")), "bench", *arguments, "--json"]
    load = os.getloadavg()[0]
    process = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    path = RESULTS / ("_".join(argument.removeprefix("--") for argument in arguments) + ".json")
    RESULTS.mkdir(exist_ok=True)
    entry = {
        "command": " ".join(["ringlet", "bench", *arguments]),
        "date": date.today().isoformat(),
        "processor": processor(),
        "load": round(load, 1),
        "result": json.loads(process.stdout),
    }
    path.write_text(json.dumps(entry, indent=1) + "\n")
    return path


def processor() -> str:
    """Name of the processor and number of its cores."""
    info = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else ""
    names = [line.split(":", 1)[1].strip() for line in info.splitlines() if line.startswith("model name")]
    return f"{names[0] if names else 'unknown'}, {os.cpu_count()} cores"


if __name__ == "__main__":
    print(record(sys.argv[1:]))
