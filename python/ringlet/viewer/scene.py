"""What else is in the picture: the bodies of a file, and the hair of a file that is no recipe."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ringlet import api, io
from ringlet.data.errors import UserError
from ringlet.data.mesh import Clip, Mesh
from ringlet.groom import Groom, lay_hairs
from ringlet.picture import made_of
from ringlet.shot import Shot
from ringlet.viewer import protocol
from ringlet.viewer.looks import Look
from ringlet.viewer.wire import pack

USD = (".usd", ".usda", ".usdc", ".usdz")


@dataclass(frozen=True)
class Seen:
    """A mesh in the picture.

    clip:  how it moves on its own; None for one that stands
    cloth: what it is called if it is cloth, which frames move
    """

    mesh: Mesh
    clip: Clip | None = None
    cloth: str = ""

    def message(self, index: int) -> bytes:
        """The message that shows it where it rests, as a groom does."""
        mesh = self.mesh
        colors = mesh.colors if mesh.colors is not None else np.empty((0, 3))
        material = "cloth" if self.cloth else made_of(mesh)
        return pack(
            protocol.Body(index=index, name=mesh.name.split("/")[-1], made_of=material, color=mesh.color),
            points=mesh.points,
            triangles=mesh.triangles,
            colors=np.clip(colors, 0.0, 1.0),
        )

    def at(self, frame: float, cloths: Mapping[str, NDArray]) -> NDArray:
        """Where its points are at a frame [m], shape (n, 3). cloths: where those of cloths are, by their names."""
        moved = cloths.get(self.cloth)
        if moved is not None and moved.shape == self.mesh.points.shape:
            return moved
        return self.clip.at(frame) if self.clip else self.mesh.points


class Moved(NamedTuple):
    """What a frame holds: where the points of locks are [m], its statistics, and where those of cloths are."""

    points: NDArray
    statistics: dict[str, Any]
    cloths: Mapping[str, NDArray]


ReadFrame = Callable[[float], Moved]


def read_bodies(scalp: Mesh, file: Path | None, cloths: Mapping[str, str] | None = None) -> list[Seen]:
    """All that is visible in a file, with how it moves; the scalp alone where the file says no more.

    cloths: what those that are cloth are called, by the paths of their prims
    """
    if file is None or file.suffix not in USD:
        return [Seen(scalp)]
    names = cloths or {}
    return [Seen(body.mesh, body.clip, names.get(body.prim, "")) for body in io.read_bodies(file)] or [Seen(scalp)]


def dressed(head: list[Seen], shot: Shot, groom: Groom) -> list[Seen]:
    """What is seen of a shot: what is visible with the head, which may be cloth, and what the shot brings along.

    Raises UserError where a file that it names cannot be read.
    """
    cloths, colliders = api.brought_along(shot, groom)
    named = {cloth.mesh.name: cloth.name for cloth in cloths if cloth.file == groom.scalp_file}
    bodies = [Seen(seen.mesh, seen.clip, named.get(seen.mesh.name, "")) for seen in head]
    there = {seen.cloth for seen in bodies}
    bodies += [Seen(cloth.mesh, cloth.clip, cloth.name) for cloth in cloths if cloth.name not in there]
    return bodies + [Seen(collider.mesh, collider.clip) for collider in colliders]


def read_scene(file: Path) -> tuple[list[Seen], Look]:
    """Bodies and hair of a USD file: a groom with all its hairs, or any curves as they are."""
    if file.suffix not in USD:
        raise UserError(f"{file.name}: is no recipe, shot or USD file; give one of them")
    try:
        groom = io.read_groom(file)
    except UserError:
        bodies, curves, _ = io.read_stage(file)
        if curves is None:
            raise UserError(f"{file.name}: has no hair; give a recipe, a shot or a USD file with curves") from None
        seen = [Seen(replace(body.mesh, points=body.clip.points[0]), body.clip) for body in bodies]
        mesh = bodies[0].mesh if bodies else Mesh("none", np.zeros((0, 3)), np.zeros((0, 3), np.int32))
        return seen, Look(Groom(curves, curves, mesh), None, False)
    cloths: dict[str, str] = {}
    if io.is_cache(file):
        with io.open_cache(file) as cache:
            cloths = cache.cloth_prims
    return read_bodies(groom.scalp, file, cloths), Look(groom, lay_hairs(groom), False)


@contextmanager
def open_frames(file: Path, look: Look) -> Iterator[tuple[np.ndarray, ReadFrame]]:
    """The frames of a file whose locks move: their numbers, and what reads one of them while the file is open."""
    if look.hairs is None:
        frames = io.read_hair_frames(file)
        yield frames if len(frames) > 1 else frames[:0], lambda frame: Moved(_hairs_at(file, frame, look), {}, {})
        return
    with io.open_cache(file) as cache:
        if cache.size != len(look.groom.locks.points):
            raise UserError(f"{file.name}: is of another groom than that of the shot; choose a cache of the same groom")
        told = dict(zip(cache.frames.tolist(), cache.statistics, strict=False))
        yield cache.frames, lambda frame: Moved(cache.points(frame), told.get(frame, {}), cache.cloths_at(frame))


def _hairs_at(file: Path, frame: float, look: Look) -> np.ndarray:
    points, first = io.read_hairs(file, frame).points, look.groom.locks
    if len(points) != len(first.points):
        raise UserError(f"{file.name}: has {len(points)} points at frame {frame:g}, {len(first.points)} at its first")
    return points
