"""Live hair of a shot, and the rigid motion of a head in its clip."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ringlet import sim
from ringlet.api.caches import scalp_clip
from ringlet.api.grooms import load_groom
from ringlet.api.shots import read_shot
from ringlet.data.groom import Groom
from ringlet.data.rigid import best_rotation
from ringlet.live import Live
from ringlet.shot import Shot


def live_shot(shot: Shot | Path | str, groom: Groom | Path | str | None = None) -> Live:
    """The locks of a shot as live hair: with its material, forces and rate, and what it says of how they move.

    groom: in place of the one that the shot names

    Contact of the shot is not simulated, nor are its cloths; see ``Live``.
    """
    if not isinstance(shot, Shot):
        shot = read_shot(shot)
    groom = groom or shot.groom
    groom = groom if isinstance(groom, Groom) else load_groom(groom)
    return Live(
        sim.with_words(shot, groom),
        shot.strands,
        gravity=shot.forces.gravity,
        wind=shot.forces.wind,
        fps=groom.space.fps,
    )


def head_motion(groom: Groom, frames: tuple[int, int]) -> NDArray[np.float64]:
    """The rigid motion of the head at the frames of its clip, from the first to the last, as ``Live.head`` takes it.

    Shape (frames, 4, 4). It fits the triangles that carry roots best.
    """
    clip = scalp_clip(groom, frames)
    rooted = np.unique(groom.scalp.triangles[groom.locks.curve["root_triangle"]])
    groomed = np.asarray(groom.scalp.points, np.float64)[rooted]
    numbers = np.arange(frames[0], frames[1] + 1)
    now = np.stack([np.asarray(clip.at(float(frame)), np.float64)[rooted] for frame in numbers])
    transforms = np.tile(np.eye(4), (len(now), 1, 1))
    turns = best_rotation(np.broadcast_to(groomed, now.shape), now)  # of rows
    transforms[:, :3, :3] = turns.transpose(0, 2, 1)
    transforms[:, :3, 3] = now.mean(axis=1) - groomed.mean(axis=0) @ turns
    return transforms
