"""The page of benchmarks, from what is kept in bench/results: other programs' figures beside ours, and every run."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from measured import core_of, time
from ringlet.data.files import replacing

RESULTS = Path(__file__).parents[1] / "bench" / "results"


def write_benchmarks(path: Path) -> None:
    """Writes the page, only when it has changed."""
    runs = {file.stem: json.loads(file.read_text()) for file in sorted(RESULTS.glob("*.json"))}
    peers = tomllib.loads((RESULTS / "peers.toml").read_text())
    text = "\n".join([*comparisons(peers, runs), *published(peers), *all_runs(runs)]) + "\n"
    path.parent.mkdir(exist_ok=True)
    if not path.exists() or path.read_text() != text:
        with replacing(path) as aside:
            aside.write_text(text)


def comparisons(peers: dict[str, Any], runs: dict[str, Any]) -> Iterator[str]:
    """A table for every scene that another program was measured on."""
    for compare in peers["compare"]:
        yield f"## {compare['title']}\n\n{compare['how'].strip()}\n"
        yield f"| | {compare['peer']} | Ringlet | times as fast | command |\n|---|---|---|---|---|"
        for row in compare["row"]:
            if run := runs.get(row["result"]):
                ours = run["result"]["cpu_ms"]["median"]
                cells = f"{time(ours)} | {row['peer'] / ours:,.0f} | `{run['command']}`"
            else:
                cells = "not run | | "
            yield f"| {row['what']} | {time(row['peer'])} | {cells} |"
        yield ""


def published(peers: dict[str, Any]) -> Iterator[str]:
    """Published timings of other systems."""
    yield "## Published, on other hardware\n\nAs their authors say; not measured again, and of other scenes.\n"
    yield "| who | what |\n|---|---|"
    yield from (f"| {one['who']} | {one['what']} |" for one in peers["published"])
    yield ""


def all_runs(runs: dict[str, Any]) -> Iterator[str]:
    """A line for every run that is kept."""
    yield "## Every run\n\nCPU time: median, and from the least to the most of the evaluations after a warm-up.\n"
    yield "| command | CPU | from, to | threads | contacts | of | when | load | processor |\n" + "|---" * 9 + "|"
    for run in runs.values():
        result = run["result"]
        cpu = result.get("cpu_ms")  # not where a motion or a size is measured
        times = f"{time(cpu['median'])} | {time(cpu['min'])}, {time(cpu['max'])}" if cpu else " | "
        threads = f"{result['threads']}, {result['simd']}" if "threads" in result else ""
        contacts = f"{result['contacts']:,.0f}" if result.get("contacts") else ""
        load = "" if run["load"] is None else f"{run['load']:g}"  # not measured
        yield (
            f"| `{run['command']}` | {times} | {threads} | {contacts} | {core_of(run)} | {run['date']} | {load} | "
            f"{run['processor']} |"
        )
