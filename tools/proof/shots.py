"""Judges every move of the example's shots by ipctk and prints a table in Markdown.

python tools/proof/shots.py [nod scarf …] [--recipe R] [--frames 1000] [--locks 500] [--rows 5] [--judge 1]

The shots are those of examples/child, all by default. A shot with more frames than its clip starts the clip over.
"""

from __future__ import annotations

import argparse
import itertools
import json
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from judged_shots import SHOTS, Judged, judged, start


def logged(frames: Iterator[Judged], path: Path | None) -> Iterator[Judged]:
    """Passes frames on and appends a line of JSON for each to a file."""
    for frame in frames:
        if path is not None:
            with path.open("a") as file:
                print(json.dumps({"crossings": frame.crossings, **frame.statistics, **frame.edges}), file=file)
        yield frame


def row(name: str, frames: list[Judged]) -> str:
    """The row of the table for a range of frames."""
    of = [frame.statistics for frame in frames]
    contact = [statistics["contact"] for statistics in of]
    cpu = [statistics["cpu_ms"] for statistics in of]
    pairs, iterations = (np.median([c[key] for c in contact]) for key in ("candidates", "linear_iterations"))
    cells = (
        f"{sum(frame.crossings or 0 for frame in frames)}",
        f"{np.median(cpu):.0f}",
        f"{max(cpu):.0f}",
        f"{pairs:.0f}",
        f"{max(c['contacts'] for c in contact)}",
        f"{iterations:.0f}",
        f"{max(statistics['max_stretch'] for statistics in of):.3g}",
        f"{sum(c['violations'] for c in contact)}",
        f"{1e3 * min(c['closest'] or np.inf for c in contact):.2g}",
        f"{1e3 * max(c['lag'] for c in contact):.2g}",
    )
    return f"| {name} | {' | '.join(cells)} |"


def main():
    """Prints the rows of each shot."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("shots", nargs="*", default=SHOTS, help="shots of examples/child; all by default")
    parser.add_argument("--recipe", help="recipe in place of the shot's")
    parser.add_argument("--frames", type=int, help="number of frames in place of the shot's")
    parser.add_argument("--locks", type=int, help="number of locks in place of the recipe's")
    parser.add_argument("--rows", type=int, default=1, help="number of rows of the table for each shot")
    parser.add_argument("--log", type=Path, help="file for the statistics of every frame, a line of JSON each")
    parser.add_argument("--judge", type=int, default=1, help="judge the moves of every N-th frame")
    options = parser.parse_args()
    print(
        "| frames | crossings | CPU, median [ms] | most [ms] | pairs | contacts | iterations | strain | limited "
        "| closest [mm] | lag [mm] |"
    )
    print("|---|---|---|---|---|---|---|---|---|---|---|", flush=True)
    for shot in options.shots:
        motion, begun = start(shot, options.recipe, options.locks), time.process_time()
        count = options.frames or motion.shot.frames[1] - motion.shot.frames[0]
        frames = logged(judged(motion, count, options.judge), options.log)
        title = f"{shot}{f' of {options.recipe}' if options.recipe else ''}"
        for chunk in np.array_split(np.arange(count), options.rows):
            done = list(itertools.islice(frames, len(chunk)))
            print(row(f"{title} {chunk[0] + 1}–{chunk[-1] + 1}", done), flush=True)
        size = f"{len(motion.locks)} locks, {len(motion.locks.points)} vertices"
        print(f"<!-- {title}: {size}, {time.process_time() - begun:.0f} s of CPU, including ipctk -->", flush=True)


if __name__ == "__main__":
    main()
