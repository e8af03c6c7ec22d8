"""What else is in the picture: the bodies of a file, and the hair of a file that is no recipe."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from ringlet import io
from ringlet.errors import UserError
from ringlet.groom import Groom, lay_hairs
from ringlet.mesh import Clip, Mesh
from ringlet.picture import made_of
from ringlet.viewer import protocol
from ringlet.viewer.looks import Look
from ringlet.viewer.wire import pack

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


def body_messages(scalp: Mesh, file: Path | None, of: Callable[[Mesh], str] = made_of) -> list[bytes]:
    """The bodies in their rest pose."""
    return [body_message(k, mesh, mesh.points, of) for k, (mesh, _) in enumerate(read_bodies(scalp, file))]


def read_scene(file: Path) -> tuple[list[bytes], Look]:
    """Bodies and hair of a USD file: a groom with all its hairs, or any curves as they are."""
    if file.suffix not in USD:
        raise UserError(f"{file.name}: is no recipe, shot or USD file; give one of them")
    try:
        groom = io.read_groom(file)
    except UserError:
        bodies, curves, frames = io.read_stage(file)
        if curves is None:
            raise UserError(f"{file.name}: has no hair; give a recipe, a shot or a USD file with curves") from None
        at = frames[0] if len(frames) else 0.0
        mesh = bodies[0].mesh if bodies else Mesh("none", np.zeros((0, 3)), np.zeros((0, 3), np.int32))
        messages = [body_message(k, body.mesh, body.clip.at(at)) for k, body in enumerate(bodies)]
        return messages, Look(Groom(curves, curves, mesh), None, False)
    return body_messages(groom.scalp, groom.scalp_file), Look(groom, lay_hairs(groom), False)
