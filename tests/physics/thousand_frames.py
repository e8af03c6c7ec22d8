"""The clip of the demo over and over: does anything ever pass through anything, and do frames get slower?

python tests/physics/thousand_frames.py [--frames 1000] [--locks 1050] [--judge 1]

Prints a table in Markdown, a row for every time that the clip has played.
"""

from __future__ import annotations

import argparse
import itertools
from pathlib import Path

import numpy as np
from crossings import Judge

from ringlet import api

EXAMPLE = Path(__file__).parents[2] / "examples/child"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=1000)
    parser.add_argument("--locks", type=int, default=1050, help="of the groom, evenly over the head")
    parser.add_argument("--judge", type=int, default=1, help="every which frame is judged by ipctk, all moves of it")
    options = parser.parse_args()

    recipe = api.read_recipe(EXAMPLE / "curls.recipe.toml")
    locks = recipe.locks.model_copy(update={"count": options.locks})
    groom = api.build_groom(recipe.model_copy(update={"locks": locks}))
    motion = api.start_motion(api.read_shot(EXAMPLE / "nod.shot.toml"), groom)
    clip = int(motion.clip.frames[-1] - motion.clip.frames[0])  # it ends where it begins
    judge = Judge(motion.scene)

    print(f"{len(groom.locks)} locks, {len(groom.locks.points)} vertices")
    print(
        "| frames | crossings | CPU, median [ms] | most [ms] | pairs | iterations | strain | held back | closest [mm] |"
    )
    print("|---|---|---|---|---|---|---|---|---|", flush=True)
    for first in range(0, options.frames, clip):
        crossings, frames = 0, []
        for k in range(first, min(first + clip, options.frames)):
            motion.scene.record(judged := k % options.judge == 0)
            begin = motion.clip.frames[0] + k % clip
            frames.append(motion.advance(begin, begin + 1))
            assert np.isfinite(motion.scene.positions).all(), f"frame {k}: not a number"
            if judged:
                crossings += sum(judge.crossings(*move) for move in itertools.pairwise(motion.scene.path))
        cpu = [frame["cpu_ms"] for frame in frames]
        stretch = max(frame["max_stretch"] for frame in frames)
        pairs, iterations = (
            np.median([f["contact"][name] for f in frames]) for name in ("candidates", "linear_iterations")
        )
        held_back = sum(frame["contact"]["violations"] for frame in frames)
        closest = min(frame["contact"]["closest"] or np.inf for frame in frames)
        print(
            f"| {first + 1}–{first + len(frames)} | {crossings} | {np.median(cpu):.0f} | {max(cpu):.0f} "
            f"| {pairs:.0f} | {iterations:.0f} | {stretch:.3g} | {held_back} | {1e3 * closest:.2g} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
