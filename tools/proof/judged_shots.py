"""The example's shots, each move of which ipctk judges; `shots.py` prints the table."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from crossings import Judge
from ringlet.api.grooms import build_groom, read_recipe
from ringlet.api.shots import loft, read_shot, start_motion, write_loft
from ringlet.viewer.show.display_groom import without_muted

EXAMPLE = Path(__file__).parents[2] / "examples/child"
SHOTS = sorted(file.name.removesuffix(".shot.toml") for file in EXAMPLE.glob("*.shot.toml"))


@dataclass
class Judged:
    """A frame: crossings counted by ipctk, None if the frame was not judged; statistics of the frame and its edges."""

    crossings: int | None
    statistics: dict
    edges: dict


def start(
    shot: str,
    recipe: str | None = None,
    locks: int | None = None,
    balanced: bool = False,
    collide: bool = True,
):
    """Starts a shot of the example by its name, optionally with another recipe or number of locks.

    balanced: with a rest shape in equilibrium, whatever the shot has
    collide: whether the groom keeps its locks out of skin and clothes
    """
    settings = read_shot(EXAMPLE / f"{shot}.shot.toml")
    made = read_recipe(EXAMPLE / f"{recipe}.recipe.toml" if recipe else settings.groom)
    count = made.locks.count if locks is None else locks
    made = made.model_copy(update={"locks": made.locks.model_copy(update={"count": count})})
    groom = build_groom(made if collide else without_muted(made, frozenset({"collide"})))
    mode = "equilibrium" if balanced else settings.rest.mode
    with tempfile.TemporaryDirectory() as aside:
        rest = settings.rest.model_copy(update={"mode": mode, "file": Path(aside) / "rest.usdc"})
        settings = settings.model_copy(update={"rest": rest})
        if mode != "none":
            write_loft(loft(settings, groom), settings, rest.file)
        return start_motion(settings, groom)


def judged(motion, frames: int | None = None, every: int = 1) -> Iterator[Judged]:
    """Simulates a shot, repeating its clip up to ``frames``, and judges the moves of every ``every``-th frame.

    A vertex that starts inside a body may leave through its surface; its tests against bodies begin one frame later.
    """
    judge, (first, last) = Judge(motion.scene), motion.shot.frames
    penetrating = motion.scene.memory["penetrating_vertices"]
    found, step = [], motion.scene.step

    def judged_step(*args, **settings):
        start = motion.scene.positions.copy()
        report = step(*args, **settings)
        if is_judged:
            found.append(judge.crossings_of_step(start, motion.scene.path))
        return report

    motion.scene.step = judged_step
    for k in range(last - first if frames is None else frames):
        motion.scene.record(is_judged := k % every == 0)
        begin = first + k % (last - first)
        before, penetrating = penetrating, motion.scene.memory["penetrating_vertices"]
        assert np.isin(penetrating, before).all(), f"frame {k}: a vertex entered a body"
        judge.exclude(penetrating)
        found.clear()
        statistics = motion.advance(begin, begin + 1)
        assert np.isfinite(motion.scene.positions).all(), f"frame {k}: a position is not finite"
        yield Judged(sum(found) if is_judged else None, statistics, strained(motion))


def strained(motion) -> dict:
    """Largest extension and compression of lock edges at the end of a frame, and the number extended by over 0.1."""
    within = np.setdiff1d(np.arange(len(motion.locks.points) - 1), motion.locks.offsets[1:-1] - 1)
    before, now = (
        np.linalg.norm(np.diff(points, axis=0)[within], axis=1)
        for points in (motion.locks.points, motion.strands.positions)
    )
    strain = now / before - 1
    return {"drawn_out": strain.max(), "pressed": -strain.min(), "drawn_out_by_a_tenth": int((strain > 0.1).sum())}
