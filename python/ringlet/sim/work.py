"""Settings that make frames take long, known before the first step: distance of contact, sizes of locks, motion."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from ringlet.data.curves import Curves
from ringlet.data.groom import Groom
from ringlet.data.mesh import Clip
from ringlet.data.rigid import best_rotation
from ringlet.shot import Shot
from ringlet.sim.obstacle import Obstacle

SAMPLE = 400  # points whose neighbours are counted
MOST_POINTS = 500_000  # among which they are counted
SAMPLED_POINTS = 50  # of a body, whose motion is measured
MOST_NEIGHBOURS = 300  # of a point, in other locks
MOST_TURN = 45.0  # of a body in a frame [degrees]
MOST_MOVE = 0.5  # of a body in a frame [m]
LEAST_LENGTH = 1e-6  # of a lock [m]


def heavy_work(
    shot: Shot, groom: Groom, clip: Clip, obstacles: Sequence[Obstacle], frames: tuple[int, int]
) -> Iterator[str]:
    """One sentence for each setting or motion that makes frames take minutes, with its remedy.

    clip:      animation of the scalp
    obstacles: colliders of the shot; of one that moves with the scalp the scalp is named
    frames:    first and last frame
    """
    yield from _short_locks(groom.locks)
    if shot.touching:
        yield from _wide_contact(groom.locks, shot.touching.radius)
    bodies = {"the head": clip} | {one.name: one.clip for one in obstacles if not one.is_surface_of(groom.scalp)}
    for name, motion in bodies.items():
        yield from _fast_motion(name, motion, frames)


def _short_locks(locks: Curves) -> Iterator[str]:
    lengths = locks.lengths()
    if (short := lengths < LEAST_LENGTH).any():
        shortest = int(lengths.argmin())
        yield (
            f"{short.sum()} of {len(locks)} locks are shorter than {1e6 * LEAST_LENGTH:g} µm, lock "
            f"{locks.ids[shortest]} is {lengths[shortest]:.2g} m long: see whether their file names the unit, or "
            "remove them"
        )


def _wide_contact(locks: Curves, radius: float) -> Iterator[str]:
    """Counts the points of other locks within the distance of contact of some points."""
    stride = max(1, len(locks.points) // MOST_POINTS)
    points = np.asarray(locks.points[::stride], np.float64)
    of = np.repeat(np.arange(len(locks)), locks.counts)[::stride]
    chosen = np.unique(np.linspace(0, len(points) - 1, SAMPLE).astype(int))
    tree, reach = KDTree(points), 2.0 * radius
    near = tree.query_ball_point(points[chosen], reach, return_length=True)
    own = [(np.linalg.norm(points[of == of[k]] - points[k], axis=1) <= reach).sum() for k in chosen]
    found = stride * float(np.mean(near - np.array(own)))
    if found > MOST_NEIGHBOURS:
        apart = float(np.median([_nearest_of_others(tree, of, int(k)) for k in chosen]))
        yield (
            f"contact.radius is {radius:g} m: each point of a lock has about {found:.0f} points of other locks within "
            f"twice that, so that frames take minutes and gigabytes. Other locks are {1e3 * apart:.2g} mm away: set it "
            f"to about {0.5 * apart:.1g}"
        )


def _nearest_of_others(tree: KDTree, of: NDArray[np.integer], k: int) -> float:
    """Distance of a point to the nearest of another lock [m]."""
    for count in (16, 256, len(of)):
        distance, index = tree.query(tree.data[k], min(count, len(of)))
        if (other := np.flatnonzero(of[index] != of[k])).size:
            return float(distance[other[0]])
    return np.inf


def _fast_motion(name: str, clip: Clip, frames: tuple[int, int]) -> Iterator[str]:
    """Finds the largest turn and the largest displacement of a body from one frame to the next."""
    chosen = np.unique(np.linspace(0, clip.points.shape[1] - 1, SAMPLED_POINTS).astype(int))
    some = Clip(clip.frames, clip.points[:, chosen], clip.fps)
    numbers = np.arange(max(frames[0], np.floor(clip.frames[0])), min(frames[1], np.ceil(clip.frames[-1])) + 1)
    if len(numbers) < 2:
        return
    points = np.stack([some.at(float(number)) for number in numbers])
    turns = rotations(points[:-1], points[1:])
    moves = np.linalg.norm(np.diff(points, axis=0), axis=2).max(axis=1)
    follow = "in one frame, which takes hair minutes to follow, if it can; see whether"
    if turns.max() > MOST_TURN:
        frame = numbers[1 + turns.argmax()]
        yield f"frame {frame:g}: {name} turns by {turns.max():.0f}° {follow} its animation is right, or slow it down"
    elif moves.max() > MOST_MOVE:
        frame = numbers[1 + moves.argmax()]
        yield f"frame {frame:g}: {name} moves by {moves.max():.2g} m {follow} its animation and its unit are right"


def rotations(before: NDArray[np.float64], after: NDArray[np.float64]) -> NDArray[np.float64]:
    """Angles of the rotations that fit points best [degrees], shape (k,), of points (k, n, 3)."""
    cosine = 0.5 * (np.trace(best_rotation(before, after), axis1=1, axis2=2) - 1.0)
    return np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
