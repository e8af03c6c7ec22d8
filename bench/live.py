"""Benchmark of live hair: time of a step, and its motion against a converged shot in contact, also calibrated."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, KDTree

from ringlet import (
    Clock,
    Groom,
    Live,
    build_groom,
    calibrate,
    head_motion,
    live_shot,
    read_recipe,
    read_shot,
    simulate,
    trunk_motion,
)

EXAMPLES = Path(__file__).parents[1] / "examples"
DEGREE = 5  # of the centre line that radii of coils are measured from
EVERY = 4  # frames of which one volume is measured
NEIGHBOURS = 6
CELL = 0.003  # of the picture that hair covers [m]
STILL = 2e-4  # motion in a frame below which a tip stands still [m]

Array = NDArray[np.float64]


def run(
    recipe: str = "child/curls", locks: int = 0, frames: int = 48, newton: int = 12, seconds: float = 10.0
) -> dict[str, Any]:
    """Moves the locks of an example through the nod, live and in a shot with contact, from the same first frame.

    recipe:  of ``examples``, its path without ``.recipe.toml``
    locks:   their number; 0 for that of the recipe
    frames:  of the clip
    newton:  iterations of the shot; 0 for no shot, to time the steps alone
    seconds: of live hair on a still head
    """
    clock = Clock()
    made = read_recipe(EXAMPLES / f"{recipe}.recipe.toml")
    if locks:
        made = made.model_copy(update={"locks": made.locks.model_copy(update={"count": locks})})
    groom, shot = build_groom(made), read_shot(EXAMPLES / "child" / "nod.shot.toml")
    heads, trunks = (motion(groom, (1, frames)) for motion in (head_motion, trunk_motion))
    measured: dict[str, Any] = {}
    if newton:
        solver = shot.solver.model_copy(update={"newton": newton})
        with clock("shot"):
            cache = simulate(shot.model_copy(update={"frames": (1, frames), "solver": solver}), groom)
        with clock("calibrate"):
            contact = calibrate(groom, shot.strands, clothes=live_shot(shot, groom).clothes, touching=shot.touching)
        expected = of_heads(cache.points.astype(np.float64), heads)
        groom.locks.points[:] = expected[0]
        motions = {"shot": expected}
        for name, of in {"default": live_shot(shot, groom).contact, "calibrated": contact}.items():
            live = live_shot(shot, groom)
            live.contact = of
            motions[name] = moved(live, heads, trunks, clock)
            measured[name] = {"contact": of, **compare(groom, expected, motions[name])}
        measured["tips_mm"] = along(motions, groom.locks.offsets)
    else:
        moved(live_shot(shot, groom), heads, trunks, clock)
    measured["still"] = still(live_shot(shot, groom), seconds)
    return clock.result(
        "live",
        {"recipe": recipe, "locks": locks, "frames": frames, "newton": newton, "seconds": seconds},
        per="step",
        warm_up=0,
        locks=len(groom.locks),
        vertices=len(groom.locks.points),
        **measured,
    )


def moved(live: Live, heads: Array, trunks: Array, clock: Clock) -> Array:
    """Positions of all points in the frame of the head, shape (frames, n, 3)."""
    live.head, live.trunk = heads[0], trunks[0]
    live.reset()
    points = [live.positions]
    for live.head, live.trunk in zip(heads[1:], trunks[1:], strict=True):
        with clock("step"):
            live.step()
        with clock("carry"):
            points.append(live.positions)
    return of_heads(np.array(points), heads)


def of_heads(points: Array, heads: Array) -> Array:
    """Points (frames, n, 3) in the frame of the groom."""
    return np.stack([(at - head[:3, 3]) @ head[:3, :3] for at, head in zip(points, heads, strict=True)])


def compare(groom: Groom, expected: Array, found: Array) -> dict[str, float]:
    """The motion that was found, by that expected; positions in the frame of the head, (frames, n, 3)."""
    offsets = groom.locks.offsets
    tips = offsets[1:] - 1
    d, e = ((points - points[:1])[:, tips] for points in (found, expected))
    together, of_expected = np.median(d, axis=1), np.median(e, axis=1)
    frames = range(EVERY, len(found), EVERY)
    return {
        "swing": root_mean_square(np.median(np.linalg.norm(d, axis=2), axis=1))
        / root_mean_square(np.median(np.linalg.norm(e, axis=2), axis=1)),
        "correlation": float(np.sum(together * of_expected) / np.sqrt(np.sum(together**2) * np.sum(of_expected**2))),
        "own_motion": own_motion(expected[0, tips], d),
        "own_motion_of_shot": own_motion(expected[0, tips], e),
        "tips_off_mm": 1e3 * float(np.linalg.norm(d - e, axis=2).mean()),
        "tips_move_mm": 1e3 * float(np.linalg.norm(e, axis=2).mean()),
        "volume": float(np.mean([volume(found[k]) / volume(expected[k]) for k in frames])),
        "covered": float(np.mean([covered(found[k]) / covered(expected[k]) for k in frames])),
        "radius": float(np.mean([radius(found[k], offsets) / radius(expected[k], offsets) for k in frames])),
        "still_frames": longest_rest(d),
        "still_frames_of_shot": longest_rest(e),
        "stretch_percent": 100.0 * (longest(found, offsets) - 1.0),
        "stretch_of_shot_percent": 100.0 * (longest(expected, offsets) - 1.0),
    }


def along(motions: dict[str, Array], offsets: NDArray[np.integer]) -> dict[str, list[float]]:
    """The median motion of tips from the first frame, along the line on which the shot's moves most [mm], by frame."""
    tips = {name: np.median((of - of[:1])[:, offsets[1:] - 1], axis=1) for name, of in motions.items()}
    line = np.linalg.svd(tips["shot"])[2][0]
    return {name: np.round(1e3 * of @ line, 2).tolist() for name, of in tips.items()}


def still(live: Live, seconds: float) -> dict[str, float]:
    """How far points go in some seconds without motion of the head."""
    before = live.positions
    for _ in range(round(seconds / live.dt)):
        live.step()
    return {"most_mm": 1e3 * float(np.linalg.norm(live.positions - before, axis=1).max())}


def root_mean_square(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))


def own_motion(roots: Array, motion: Array) -> float:
    """Part of the motion of tips, shape (frames, count, 3), that is not that of their neighbours."""
    near = np.asarray(KDTree(roots).query(roots, NEIGHBOURS + 1)[1])[:, 1:]
    own = motion - motion[:, near].mean(axis=2)
    return root_mean_square(own) / root_mean_square(motion)


def volume(points: Array) -> float:
    """Of the convex hull of every fifth point [m³]."""
    return float(ConvexHull(points[::5]).volume)


def covered(points: Array) -> int:
    """Cells of a picture from the front that have points in them."""
    return len(np.unique(np.floor(points[:, :2] / CELL).astype(np.int64), axis=0))


def longest_rest(motion: Array) -> int:
    """Most frames in a row in which a tip stands still, by motion of tips of shape (frames, count, 3)."""
    longest = rests = np.zeros(motion.shape[1], np.int64)
    for speed in np.linalg.norm(np.diff(motion, axis=0), axis=2):
        rests = np.where(speed < STILL, rests + 1, 0)
        longest = np.maximum(longest, rests)
    return int(longest.max())


def radius(points: Array, offsets: NDArray[np.integer]) -> float:
    """Median distance of locks from their centre lines [m]."""
    found = list[float]()
    for begin, end in pairwise(offsets):
        at, lock = np.linspace(-1.0, 1.0, end - begin), points[begin:end]
        line = np.polynomial.legendre.legval(at, np.polynomial.legendre.legfit(at, lock, DEGREE)).T
        found.append(np.sqrt(np.mean(np.sum((lock - line) ** 2, axis=1))))
    return float(np.median(found))


def longest(points: Array, offsets: NDArray[np.integer]) -> float:
    """Length of a lock by that in the first frame, at most in all frames; in 99 of 100 locks it is less."""
    edges = np.linalg.norm(np.diff(points, axis=1), axis=2)
    edges[:, offsets[1:-1] - 1] = 0.0
    lengths = np.add.reduceat(edges, offsets[:-1], axis=1)
    return float(np.quantile((lengths / lengths[:1]).max(axis=0), 0.99))
