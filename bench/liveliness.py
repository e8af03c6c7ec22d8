"""How much hair moves relative to its head, by how hard contacts push: the demo's locks on the nodding head."""

from __future__ import annotations

import itertools
import statistics
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet import Clock, build_groom, loft, read_recipe, read_shot, simulate, write_loft

EXAMPLE = Path(__file__).parents[1] / "examples" / "child"


def run(
    locks: int = 1050, frames: int = 14, newton: int = 3, stiffness: str = "1,0.1", rest: str = "none"
) -> dict[str, Any]:
    """Plays the beginning of the example's nod without contact, and with contacts of each stiffness.

    locks:     groom guides of 96 points
    frames:    of the clip, after 12 for the hair to hang
    newton:    iterations of every step
    stiffness: ``contact.stiffness``, several by commas
    rest:      ``rest.mode``
    """
    clock = Clock()
    recipe = read_recipe(EXAMPLE / "curls.recipe.toml")
    groom = build_groom(recipe.model_copy(update={"locks": recipe.locks.model_copy(update={"count": locks})}))
    shot = read_shot(EXAMPLE / "nod.shot.toml")
    contact = shot.contact
    assert contact is not None  # the example's has it
    off = {}
    with tempfile.TemporaryDirectory() as folder:
        remembered = Path(folder) / "nod.rest.usdc"
        shot = shot.model_copy(
            update={
                "frames": (1, frames),
                "solver": shot.solver.model_copy(update={"newton": newton}),
                "rest": shot.rest.model_copy(update={"mode": rest, "file": remembered}),
            }
        )
        if rest != "none":
            with clock("rest shapes"):
                write_loft(loft(shot, groom), shot, remembered)
        for name in ("without", *str(stiffness).split(",")):
            changes = {"on": False} if name == "without" else {"stiffness": float(name)}
            touching = contact.model_copy(update=changes)
            with clock(f"stiffness {name}"):
                cache = simulate(shot.model_copy(update={"contact": touching}), groom, allow_stale=True)
            off[name] = {
                "moves_mm": moves(cache.points.astype(np.float64), groom.locks.offsets),
                "cpu_ms": statistics.median(frame["cpu_ms"] for frame in cache.statistics),
                "max_stretch": max(frame["max_stretch"] for frame in cache.statistics),
            }
    return clock.result(
        "liveliness",
        {"locks": locks, "frames": frames, "newton": newton, "stiffness": stiffness, "rest": rest},
        per="stiffness without",
        warm_up=0,
        off=off,
    )


def moves(points: NDArray[np.float64], offsets: NDArray[np.integer]) -> float:
    """How far the vertex of a lock that moves most goes in a frame beside all roots, which move as one [mm].

    points:  shape (frames, n, 3) [m]
    offsets: shape (locks + 1,)
    The median over locks, of that the mean over frames.
    """
    roots = offsets[:-1]
    medians = []
    for before, after in itertools.pairwise(points):
        a, b = before[roots].mean(axis=0), after[roots].mean(axis=0)
        u, _, v = np.linalg.svd((before[roots] - a).T @ (after[roots] - b))
        turn = u @ np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ v))]) @ v
        away = np.linalg.norm((before - a) @ turn + b - after, axis=1)
        medians.append(np.median(np.maximum.reduceat(away, roots)))
    return 1e3 * float(np.mean(medians))
