"""Benchmark of curl preservation under a strong motion: hairs on simulated curls, and the conventional warp.

The conventional warp simulates straight guides and displaces curls by the nearest of them.
"""

from __future__ import annotations

import dataclasses
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet import Clock, Groom, build_groom, build_hairs, read_recipe, read_shot, simulate

EXAMPLE = Path(__file__).parents[1] / "examples" / "child"

PER_LOCK = 12
CARRIED, DISPLACED = "carried by simulated curls", "displaced by straight guides"

SHOT = """
ringlet = 2
groom = "{groom}"
frames = [1, {frames}]
preroll = 2
[strands]
damping = 0.004
bend_scale = {bend_scale}
[solver]
newton = 10
"""


def run(
    locks: int = 300, points: int = 72, frames: int = 30, nearest: int = 3, bend_scale: float = 0.5
) -> dict[str, Any]:
    """Simulates the example head's clip twice: curls, and the same locks without curl.

    locks:      groom guides
    points:     points of a guide and of a hair
    frames:     number of frames, of the clip's 48; the head turns quickly from 19 to 33
    nearest:    straight guides that the conventional warp blends for each hair; one lock in four has one
    bend_scale: bend scale of both
    """
    clock = Clock()
    with clock("both"):
        _, rest, simulated, warped_hairs = warped(locks, points, frames, nearest, bend_scale)
    before = measure(rest, points)
    # Change of the curl by the motion itself: the first hair of a lock is the simulated guide.
    guide_change = np.repeat(
        np.stack(measure(simulated, points))[:, ::PER_LOCK] / np.stack(before)[:, ::PER_LOCK], PER_LOCK, axis=1
    )
    hair_change = np.stack(measure(simulated, points)) / np.stack(before)
    relative_change = np.delete(hair_change / guide_change, np.s_[::PER_LOCK], axis=1)
    of_guide = {
        name: float(np.percentile(np.abs(kept - 1.0), 90))
        for name, kept in zip(("radius", "bend", "length"), relative_change, strict=True)
    }
    methods = {}
    for name, hairs in ((CARRIED, simulated), (DISPLACED, warped_hairs)):
        after = measure(hairs, points)
        moved = np.linalg.norm(hairs - rest, axis=1).reshape(-1, points)[:, -1]
        methods[name] = {
            "tips_moved_mm": 1e3 * float(np.median(moved)),
            "radius_kept_median": float(np.median(after[0] / before[0])),
            "radius_change_90_percent": float(np.percentile(np.abs(after[0] / before[0] - 1.0), 90)),
            "bend_kept_median": float(np.median(after[1] / before[1])),
            "bend_change_90_percent": float(np.percentile(np.abs(after[1] / before[1] - 1.0), 90)),
            "length_change_90_percent": float(np.percentile(np.abs(after[2] / before[2] - 1.0), 90)),
        }
    methods[CARRIED]["change_relative_to_guide_90_percent"] = of_guide
    return clock.result(
        "warp",
        {"locks": locks, "points": points, "frames": frames, "nearest": nearest, "bend_scale": bend_scale},
        per="both",
        warm_up=0,
        hairs=len(rest) // points,
        radius_mm=1e3 * float(np.median(before[0])),
        turns=float(np.median(before[1])),
        methods=methods,
    )


def warped(
    locks: int, points: int, frames: int, nearest: int, bend_scale: float
) -> tuple[Groom, NDArray[np.floating], NDArray[np.floating], NDArray[np.floating]]:
    """The groom, and its hairs at rest, on simulated curls, and after the conventional warp [m], shape (n, 3).

    The frame is the one with the largest displacement of the straight guides.
    """
    text = (EXAMPLE / "curls.recipe.toml").read_text()
    text = text.replace("count = 1050", f"count = {locks}").replace("points = 96", f"points = {points}")
    text = text.replace("pitch = { value = 1.2, vary = 0.2 }", f"curls = {{ value = {points / 12}, vary = 0.1 }}")
    text = text.replace('"head.usdc"', f'"{(EXAMPLE / "head.usdc").as_posix()}"').replace(
        "per_lock = 36", f"per_lock = {PER_LOCK}"
    )
    with tempfile.TemporaryDirectory() as folder:
        recipe, shot = Path(folder) / "warp.recipe.toml", Path(folder) / "warp.shot.toml"
        recipe.write_text(text)
        shot.write_text(SHOT.format(groom=recipe.as_posix(), frames=frames, bend_scale=bend_scale))
        groom = build_groom(read_recipe(recipe))
        shapes = groom.shapes
        assert shapes is not None
        guides = shapes.take(np.arange(0, len(shapes), 4))
        straight = dataclasses.replace(groom, locks=guides)
        curls, lines = (simulate(read_shot(shot), each) for each in (groom, straight))
    hairs = build_hairs(groom)
    rest = hairs.curves.points.astype(float)
    each = len(guides.points) // len(guides)
    bends = [head_at_rest(guides.points, now, each) for now in lines.points]
    hardest = int(np.argmax([np.linalg.norm(bent - guides.points, axis=1).mean() for bent in bends]))
    bent = bends[hardest]
    simulated = hairs.deformed(head_at_rest(groom.locks.points, curls.points[hardest], points), groom.scalp.points)
    warped_hairs = conventional(rest, hairs.curves.roots, guides.points, bent, len(guides), points, nearest)
    return groom, rest, simulated.astype(float), warped_hairs


def head_at_rest(before: NDArray, now: NDArray, points: int) -> NDArray[np.floating]:
    """Removes the rigid motion of the head from guides, by the motion of their roots (Kabsch)."""
    roots, rest_roots = now[::points].astype(float), before[::points]
    left, _, right = np.linalg.svd((roots - roots.mean(axis=0)).T @ (rest_roots - rest_roots.mean(axis=0)))
    rotation = left @ np.diag([1.0, 1.0, np.linalg.det(left @ right)]) @ right
    return (now - roots.mean(axis=0)) @ rotation + rest_roots.mean(axis=0)


def conventional(
    rest: NDArray, roots: NDArray, before: NDArray, now: NDArray, guides: int, points: int, nearest: int
) -> NDArray[np.floating]:
    """Displaces hairs by the nearest straight guides, at the same relative arc length."""
    moved = (now - before).reshape(guides, -1, 3)
    u = np.linspace(0.0, 1.0, points) * (moved.shape[1] - 1)
    i = np.minimum(u.astype(int), moved.shape[1] - 2)
    t = (u - i)[None, :, None]
    moved = (1.0 - t) * moved[:, i] + t * moved[:, i + 1]
    distance = np.linalg.norm(roots[:, None] - before.reshape(guides, -1, 3)[None, :, 0], axis=2)
    chosen = np.argsort(distance, axis=1)[:, :nearest]
    weight = 1.0 / np.maximum(np.take_along_axis(distance, chosen, axis=1), 1e-4) ** 2
    weight /= weight.sum(axis=1, keepdims=True)
    return rest + np.einsum("hk,hkpx->hpx", weight, moved[chosen]).reshape(-1, 3)


def measure(hairs: NDArray, points: int) -> tuple[NDArray, NDArray, NDArray]:
    """Radius of the curl [m], total bend [turns] and length [m] of each hair.

    The radius is the RMS distance from the axis, the mean over a turn of 12 points, without half a turn at each end.
    It is measured across the axis, so that a curl sheared along the axis loses radius.
    """
    curves = hairs.reshape(-1, points, 3)
    sums = np.cumsum(np.concatenate([np.zeros((len(curves), 1, 3)), curves], axis=1), axis=1)
    axis = (sums[:, 12:] - sums[:, :-12]) / 12.0
    axis = 0.5 * (axis[:, 1:] + axis[:, :-1])
    along = np.gradient(axis, axis=1)
    along /= np.maximum(np.linalg.norm(along, axis=2, keepdims=True), 1e-12)
    radial = curves[:, 6 : 6 + axis.shape[1]] - axis
    radial -= np.sum(radial * along, axis=2, keepdims=True) * along
    radius = np.sqrt(np.mean(np.sum(radial**2, axis=2), axis=1))
    edges = np.diff(curves, axis=1)
    lengths = np.linalg.norm(edges, axis=2)
    cosine = np.sum(edges[:, 1:] * edges[:, :-1], axis=2) / np.maximum(lengths[:, 1:] * lengths[:, :-1], 1e-12)
    return radius, np.arccos(np.clip(cosine, -1.0, 1.0)).sum(axis=1) / (2.0 * np.pi), lengths.sum(axis=1)
