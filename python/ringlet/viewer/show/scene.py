"""The scene around the hair: bodies of a file, and the hair of a USD file."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ringlet import io
from ringlet.api.shots import cloths_and_colliders
from ringlet.data.accessory import Accessory
from ringlet.data.errors import UserError
from ringlet.data.groom import shows
from ringlet.data.mesh import Clip, Mesh
from ringlet.data.surfaces import material_of
from ringlet.groom import Groom, lay_hairs
from ringlet.shot import Shot
from ringlet.viewer import protocol
from ringlet.viewer.show.display_groom import DisplayGroom
from ringlet.viewer.wire import pack

USD = (".usd", ".usda", ".usdc", ".usdz")


@dataclass(frozen=True)
class VisibleMesh:
    """A visible mesh.

    clip:  animation of the mesh; None for a static one
    cloth: name of the cloth that frames move; empty for other meshes
    worn:  the accessory that locks carry, and the points of these at rest [m]; None for other meshes
    """

    mesh: Mesh
    clip: Clip | None = None
    cloth: str = ""
    worn: tuple[Accessory, NDArray] | None = None

    def message(self, index: int, of: int, origin: NDArray) -> bytes:
        """Message with the mesh in its rest pose, relative to an origin [m], as one of the scene."""
        mesh = self.mesh
        colors = mesh.colors if mesh.colors is not None else np.empty((0, 3))
        material = "cloth" if self.cloth else material_of(mesh.name)
        return pack(
            protocol.Body(index=index, of=of, name=mesh.name.split("/")[-1], made_of=material, color=mesh.color),
            points=mesh.points - origin,
            triangles=mesh.triangles,
            colors=np.clip(colors, 0.0, 1.0),
        )

    def at(self, frame: float, state: FrameState) -> NDArray:
        """Positions of the points at a frame with its contents [m], shape (n, 3)."""
        if self.worn is not None:
            accessory, rest = self.worn
            return accessory.at(rest, state.points)
        moved = state.cloths.get(self.cloth)
        if moved is not None and moved.shape == self.mesh.points.shape:
            return moved
        return self.clip.at(frame) if self.clip else self.mesh.points


class FrameState(NamedTuple):
    """Contents of a frame: positions of the locks [m], statistics, and positions of the cloths [m] by name."""

    points: NDArray
    statistics: dict[str, Any]
    cloths: Mapping[str, NDArray]


ReadFrame = Callable[[float], FrameState]


def read_meshes(scalp: Mesh, file: Path | None, *, cage: bool, hidden: Collection[str]) -> list[VisibleMesh]:
    """Visible meshes of the head's file at rest; the scalp alone when the file has none.

    cage, hidden: as in the groom
    """
    found = io.read_meshes(file, cage) if file is not None and file.suffix in USD else []
    seen = [mesh for mesh in found if shows(mesh.name, hidden)]
    return [VisibleMesh(mesh) for mesh in seen or [scalp]]


def worn_meshes(groom: Groom) -> list[VisibleMesh]:
    """What the hair of a groom wears."""
    return [VisibleMesh(one.mesh, worn=(one, groom.locks.points)) for one in groom.accessories]


def read_bodies(
    scalp: Mesh,
    file: Path | None,
    frames: tuple[int, int] | None = None,
    fps: float | None = None,
    cloths: Mapping[str, str] | None = None,
    cage: bool | None = None,
) -> list[VisibleMesh]:
    """Visible meshes of a file with their animation; the scalp alone when the file has none.

    frames, fps: first and last frame, and their rate; by default those of the file
    cloths:      names of cloths, by prim path
    cage:        reads cages of subdivision surfaces; by default as the groom in the file was made
    """
    if file is None or file.suffix not in USD:
        return [VisibleMesh(scalp)]
    names, bodies = cloths or {}, io.read_bodies(file, frames=frames, fps=fps, cage=cage)
    return [VisibleMesh(body.mesh, body.clip, names.get(body.prim, "")) for body in bodies] or [VisibleMesh(scalp)]


def shot_meshes(shot: Shot, groom: Groom) -> list[VisibleMesh]:
    """Visible meshes of a shot at its frames: those of the head's file, then cloths and colliders of the shot.

    Raises UserError when a file of the shot cannot be read.
    """
    head = read_bodies(groom.scalp, groom.scalp_file, shot.frames, groom.space.fps, cage=groom.cage)
    cloths, colliders = cloths_and_colliders(shot, groom)
    head = [body for body in head if groom.shows(body.mesh.name)]
    of_head = {cloth.mesh.name for cloth in cloths if cloth.file == groom.scalp_file}
    bodies = [body for body in head if body.mesh.name not in of_head]
    bodies += [VisibleMesh(cloth.mesh, cloth.clip, cloth.name) for cloth in cloths]
    return bodies + [VisibleMesh(collider.mesh, collider.clip) for collider in colliders]


def read_scene(file: Path) -> tuple[list[VisibleMesh], DisplayGroom]:
    """Bodies and hair of a USD file: a groom with its render hairs, or plain curves.

    Raises UserError for another file type and for a file without hair.
    """
    if file.suffix not in USD:
        raise UserError(f"{file.name}: is no recipe, shot or USD file; give one of them")
    try:
        groom = io.read_groom(file)
    except UserError:
        shown, curves, _ = io.read_stage(file)
        if curves is None:
            raise UserError(f"{file.name}: has no hair; give a recipe, a shot or a USD file with curves") from None
        visible = [VisibleMesh(replace(body.mesh, points=body.clip.points[0]), body.clip) for body in shown]
        mesh = shown[0].mesh if shown else Mesh("none", np.zeros((0, 3)), np.zeros((0, 3), np.int32))
        return visible, DisplayGroom(Groom(curves, curves, mesh), None, False)
    cloths: dict[str, str] = {}
    frames: tuple[int, int] | None = None
    if io.is_cache(file):
        with io.open_cache(file) as cache:
            cloths, frames = cache.cloth_prims, (math.floor(cache.frames[0]), math.ceil(cache.frames[-1]))
    worn = {one.mesh.name for one in groom.accessories}  # carried by locks, also in a cache
    bodies = [body for body in read_bodies(groom.scalp, file, frames, cloths=cloths) if body.mesh.name not in worn]
    return bodies, DisplayGroom(groom, lay_hairs(groom), False)


@contextmanager
def open_frames(file: Path, display: DisplayGroom) -> Iterator[tuple[np.ndarray, ReadFrame]]:
    """Opens the frames of a file: their numbers, and a function that reads one while the file is open.

    Raises UserError for a cache of another groom.
    """
    if display.hairs is None:
        frames = io.read_hair_frames(file)
        yield (
            frames if len(frames) > 1 else frames[:0],
            lambda frame: FrameState(_hairs_at(file, frame, display), {}, {}),
        )
        return
    with io.open_cache(file) as cache:
        locks = display.groom.locks
        if cache.size != len(locks.points) or not np.array_equal(cache.ids, locks.ids):
            raise UserError(f"{file.name}: belongs to another groom than the shot; choose a cache of the same groom")
        statistics = dict(zip(cache.frames.tolist(), cache.statistics, strict=False))
        yield (
            cache.frames,
            lambda frame: FrameState(cache.points(frame), statistics.get(frame, {}), cache.cloths_at(frame)),
        )


def _hairs_at(file: Path, frame: float, display: DisplayGroom) -> np.ndarray:
    points, first = io.read_hairs(file, frame).points, display.groom.locks
    if len(points) != len(first.points):
        raise UserError(
            f"{file.name}: has {len(points)} points at frame {frame:g}, {len(first.points)} at its first; make it again"
        )
    return points
