"""Shots whose every move is judged: does anything ever pass through anything, and do frames get slower?

python tests/physics/judged_shots.py [nod scarf …] [--recipe R] [--frames 1000] [--locks 500] [--rows 5] [--judge 1]

Prints a table in Markdown. Shots are those of examples/child, all by default; one that is given more frames than it has
starts its clip over and over.
"""

from __future__ import annotations

import argparse
import itertools
import json
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from crossings import Judge

from ringlet import api

EXAMPLE = Path(__file__).parents[2] / "examples/child"
SHOTS = sorted(file.name.removesuffix(".shot.toml") for file in EXAMPLE.glob("*.shot.toml"))


@dataclass
class Judged:
    """A frame: how many crossings another library sees on its way, None: it was not asked; its statistics and edges."""

    crossings: int | None
    statistics: dict
    edges: dict


def start(shot: str, recipe: str | None = None, locks: int | None = None, balanced: Path | None = None):
    """A shot of the example in motion, by its name, with another recipe or as many locks, evenly over the head.

    balanced: where to keep rest shapes in equilibrium, if it is to have them
    """
    settings = api.read_shot(EXAMPLE / f"{shot}.shot.toml")
    made = api.read_recipe(EXAMPLE / f"{recipe}.recipe.toml" if recipe else settings.groom)
    count = made.locks.count if locks is None else locks
    groom = api.build_groom(made.model_copy(update={"locks": made.locks.model_copy(update={"count": count})}))
    if balanced is not None:
        rest = settings.rest.model_copy(update={"mode": "equilibrium", "file": balanced})
        settings = settings.model_copy(update={"rest": rest})
        api.write_loft(api.loft(settings, groom), settings, balanced)
    return api.start_motion(settings, groom)


def judged(motion, frames: int | None = None, every: int = 1) -> Iterator[Judged]:
    """Plays the frames of a shot, or so many, and judges every which of them, all moves of it.

    What begins inside a body may come out through its surface: it is judged there from the frame on after it is out.
    """
    judge, (first, last) = Judge(motion.scene), motion.shot.frames
    excused = motion.scene.memory["embedded_vertices"]
    for k in range(last - first if frames is None else frames):
        motion.scene.record(asked := k % every == 0)
        begin = first + k % (last - first)
        before, excused = excused, motion.scene.memory["embedded_vertices"]
        assert np.isin(excused, before).all(), f"frame {k}: what was not inside a body is excused from it"
        judge.excuse(excused)
        statistics = motion.advance(begin, begin + 1)
        assert np.isfinite(motion.scene.positions).all(), f"frame {k}: not a number"
        moves = itertools.pairwise(motion.scene.path) if asked else ()
        crossings = sum(judge.crossings(*move) for move in moves) if asked else None
        yield Judged(crossings, statistics, strained(motion))


def strained(motion) -> dict:
    """How far edges of locks are drawn out and pressed together at the end of a frame, and how many by over a tenth."""
    within = np.setdiff1d(np.arange(len(motion.locks.points) - 1), motion.locks.offsets[1:-1] - 1)
    before, now = (
        np.linalg.norm(np.diff(points, axis=0)[within], axis=1)
        for points in (motion.locks.points, motion.strands.positions)
    )
    strain = now / before - 1
    return {"drawn_out": strain.max(), "pressed": -strain.min(), "drawn_out_by_a_tenth": int((strain > 0.1).sum())}


def logged(frames: Iterator[Judged], path: Path | None) -> Iterator[Judged]:
    """The same, and a line of JSON for each."""
    for frame in frames:
        if path is not None:
            with path.open("a") as file:
                print(json.dumps({"crossings": frame.crossings, **frame.statistics, **frame.edges}), file=file)
        yield frame


def row(name: str, frames: list[Judged]) -> str:
    """What there is to tell of some frames."""
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
        f"{min(c['fraction'] for c in contact):.2g}",
    )
    return f"| {name} | {' | '.join(cells)} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("shots", nargs="*", default=SHOTS, help="of examples/child")
    parser.add_argument("--recipe", help="in place of the shot's")
    parser.add_argument("--frames", type=int, help="in place of the shot's")
    parser.add_argument("--locks", type=int, help="of the groom, evenly over the head, in place of the recipe's")
    parser.add_argument("--rows", type=int, default=1, help="in how many parts the table tells of a shot")
    parser.add_argument("--log", type=Path, help="a file for the statistics of every frame, a line of JSON each")
    parser.add_argument("--judge", type=int, default=1, help="every which frame is judged by ipctk, all moves of it")
    options = parser.parse_args()
    print(
        "| frames | crossings | CPU, median [ms] | most [ms] | pairs | contacts | iterations | strain | held back "
        "| closest [mm] | fraction |"
    )
    print("|---|---|---|---|---|---|---|---|---|---|---|", flush=True)
    for shot in options.shots:
        motion, begun = start(shot, options.recipe, options.locks), time.process_time()
        count = options.frames or motion.shot.frames[1] - motion.shot.frames[0]
        frames = logged(judged(motion, count, options.judge), options.log)
        title = f"{shot}{f' of {options.recipe}' if options.recipe else ''}"
        for part in np.array_split(np.arange(count), options.rows):
            done = list(itertools.islice(frames, len(part)))
            print(row(f"{title} {part[0] + 1}–{part[-1] + 1}", done), flush=True)
        size = f"{len(motion.locks)} locks, {len(motion.locks.points)} vertices"
        print(f"<!-- {title}: {size}, {time.process_time() - begun:.0f} s of CPU, judging included -->", flush=True)


if __name__ == "__main__":
    main()
