"""Live hair of a shot, and the rigid motions of head and trunk in its clip."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ringlet import io, sim
from ringlet.api.caches import scalp_clip
from ringlet.api.grooms import load_groom
from ringlet.api.shots import read_shot
from ringlet.data.groom import Groom
from ringlet.data.mesh import Mesh
from ringlet.data.rigid import best_rotation
from ringlet.deform.orientation import outward
from ringlet.live import Live
from ringlet.live.neck import neck
from ringlet.shot import Shot

USD = (".usd", ".usda", ".usdc", ".usdz")
SHOULDERS = 0.1  # of a scalp's mesh, from below, that moves as the trunk does, relative to its height


def live_shot(shot: Shot | Path | str, groom: Groom | Path | str | None = None) -> Live:
    """The locks of a shot as live hair: with its material, forces and rate, and what it says of how they move.

    groom: in place of the one that the shot names

    What is visible below the neck in the head's file goes with the trunk, as at rest. Contact of the shot is not
    simulated, nor are its cloths; see ``Live``.
    """
    if not isinstance(shot, Shot):
        shot = read_shot(shot)
    groom = groom or shot.groom
    groom = groom if isinstance(groom, Groom) else load_groom(groom)
    return Live(
        sim.with_words(shot, groom),
        shot.strands,
        clothes=clothes_of(groom),
        gravity=shot.forces.gravity,
        wind=shot.forces.wind,
        fps=groom.space.fps,
    )


def head_motion(groom: Groom, frames: tuple[int, int]) -> NDArray[np.float64]:
    """The rigid motion of the head at the frames of its clip, from the first to the last, as ``Live.head`` takes it.

    Shape (frames, 4, 4). It fits the triangles that carry roots best.
    """
    return _motion(groom, frames, np.unique(groom.scalp.triangles[groom.locks.curve["root_triangle"]]))


def trunk_motion(groom: Groom, frames: tuple[int, int]) -> NDArray[np.float64]:
    """The rigid motion of what is below the neck, as ``Live.trunk`` takes it; that of the head where the scalp's mesh
    ends above. Shape (frames, 4, 4)."""
    height = np.asarray(groom.scalp.points, np.float64)[:, 1]
    shoulders = np.flatnonzero(height <= height.min() + SHOULDERS * np.ptp(height))
    return _motion(groom, frames, shoulders)


def clothes_of(groom: Groom) -> list[Mesh]:
    """The visible meshes of a groom's head file that lie below the neck."""
    if groom.scalp_file is None or groom.scalp_file.suffix not in USD:
        return []
    joint = neck(groom)[1]
    meshes = [mesh for mesh in io.read_meshes(groom.scalp_file, groom.cage) if groom.shows(mesh.name)]
    below = [mesh for mesh in meshes if mesh.points[:, 1].mean() < joint and mesh.name != groom.scalp.name]
    return [replace(mesh, triangles=outward(mesh.points, mesh.triangles, groom.scalp.points)) for mesh in below]


def _motion(groom: Groom, frames: tuple[int, int], points: NDArray[np.integer]) -> NDArray[np.float64]:
    """The rigid motion that fits some points of the scalp's mesh best, shape (frames, 4, 4)."""
    clip = scalp_clip(groom, frames)
    groomed = np.asarray(groom.scalp.points, np.float64)[points]
    numbers = np.arange(frames[0], frames[1] + 1)
    now = np.stack([np.asarray(clip.at(float(frame)), np.float64)[points] for frame in numbers])
    transforms = np.tile(np.eye(4), (len(now), 1, 1))
    turns = best_rotation(np.broadcast_to(groomed, now.shape), now)  # of rows
    transforms[:, :3, :3] = turns.transpose(0, 2, 1)
    transforms[:, :3, 3] = now.mean(axis=1) - groomed.mean(axis=0) @ turns
    return transforms
