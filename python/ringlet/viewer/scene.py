"""What else is in the picture: the bodies of a file, and the hair of a file that is no recipe."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ringlet import io
from ringlet.errors import UserError
from ringlet.groom import Groom, lay_hairs
from ringlet.mesh import Clip, Mesh
from ringlet.picture import made_of
from ringlet.viewer import protocol
from ringlet.viewer.looks import Look
from ringlet.viewer.wire import pack

# Where the points of a frame are [m], and its statistics.
ReadFrame = Callable[[float], tuple[np.ndarray, dict[str, Any]]]
USD = (".usd", ".usda", ".usdc", ".usdz")


def body_message(index: int, mesh: Mesh, points: np.ndarray, of: Callable[[Mesh], str] = made_of) -> bytes:
    """A mesh with its points as they stand [m]."""
    colors = mesh.colors if mesh.colors is not None else np.empty((0, 3))
    return pack(
        protocol.Body(index=index, name=mesh.name.split("/")[-1], made_of=of(mesh), color=mesh.color),
        points=points,
        triangles=mesh.triangles,
        colors=np.clip(colors, 0.0, 1.0),
    )


def read_bodies(scalp: Mesh, file: Path | None) -> list[tuple[Mesh, Clip | None]]:
    """All that is visible in the scalp's file, with how it moves; the scalp alone where the file says no more."""
    if file is None or file.suffix not in USD:
        return [(scalp, None)]
    return [(body.mesh, body.clip) for body in io.read_bodies(file)]


def read_scene(file: Path) -> tuple[list[tuple[Mesh, Clip | None]], Look]:
    """Bodies and hair of a USD file: a groom with all its hairs, or any curves as they are."""
    if file.suffix not in USD:
        raise UserError(f"{file.name}: is no recipe, shot or USD file; give one of them")
    try:
        groom = io.read_groom(file)
    except UserError:
        bodies, curves, _ = io.read_stage(file)
        if curves is None:
            raise UserError(f"{file.name}: has no hair; give a recipe, a shot or a USD file with curves") from None
        seen: list[tuple[Mesh, Clip | None]] = [(body.mesh, body.clip) for body in bodies]
        mesh = bodies[0].mesh if bodies else Mesh("none", np.zeros((0, 3)), np.zeros((0, 3), np.int32))
        return seen, Look(Groom(curves, curves, mesh), None, False)
    return read_bodies(groom.scalp, groom.scalp_file), Look(groom, lay_hairs(groom), False)


@contextmanager
def open_frames(file: Path, look: Look) -> Iterator[tuple[np.ndarray, ReadFrame]]:
    """The frames of a file whose locks move: their numbers, and what reads one of them while the file is open."""
    if look.hairs is None:
        frames = io.read_hair_frames(file)
        yield frames if len(frames) > 1 else frames[:0], lambda frame: (_hairs_at(file, frame, look), {})
        return
    with io.open_cache(file) as cache:
        if cache.size != len(look.groom.locks.points):
            raise UserError(f"{file.name}: is of another groom than that of the shot; choose a cache of the same groom")
        told = dict(zip(cache.frames.tolist(), cache.statistics, strict=False))
        yield cache.frames, lambda frame: (cache.points(frame), told.get(frame, {}))


def _hairs_at(file: Path, frame: float, look: Look) -> np.ndarray:
    points, first = io.read_hairs(file, frame).points, look.groom.locks
    if len(points) != len(first.points):
        raise UserError(f"{file.name}: has {len(points)} points at frame {frame:g}, {len(first.points)} at its first")
    return points
