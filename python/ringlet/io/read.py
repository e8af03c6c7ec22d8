"""Reads meshes and curves of any supported format, chosen by the file's suffix."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.mesh import Clip, Mesh
from ringlet.data.stage import StageSpace
from ringlet.io.alembic import read_alembic_curves
from ringlet.io.hair import read_hair
from ringlet.io.obj import read_obj_curves, read_obj_mesh
from ringlet.io.tfx import read_tfx
from ringlet.io.usd.curves import read_usd_curves
from ringlet.io.usd.mesh import read_usd_clip, read_usd_head, read_usd_mesh
from ringlet.io.usd.stage import read_usd_space

METRES = StageSpace()


def read_mesh(
    path: Path | str,
    prim: str | None = None,
    *,
    space: StageSpace = METRES,
    cage: bool | None = None,
    notes: list[str] | None = None,
) -> Mesh:
    """Reads a mesh in its rest pose, in metres and Y-up, from USD or OBJ.

    Convex polygons are triangulated as fans, others by ear clipping. A Catmull-Clark subdivision surface is refined
    until most of it is nearer than 0.1 mm to its limit surface, by three levels or to 200 000 faces at most; its points
    lie on that surface. Face ``GeomSubset``s, or the groups of an OBJ, become regions. The rest pose is the default
    value of the points, or else the first time sample. A USD file without ``metersPerUnit`` is in centimetres, the
    fallback of USD.

    prim:  prim path in USD; by default the only mesh, or the only one with a region called ``scalp``
    space: unit and up-axis of an OBJ, which stores neither
    cage:  reads the cages of subdivision surfaces; by default as the groom in the file was made, else not
    notes: receives a sentence for what is not read as a render shows it

    Raises UserError for a file that is not readable, or has no such mesh.
    """
    path = Path(path)
    if _has_suffix(path, ".abc"):
        raise UserError(
            f"{path}: meshes of Alembic are read by ringlet convert alone; run: ringlet convert {path} "
            f"{path.with_suffix('.usdc')}, and name that file"
        )
    return (
        read_obj_mesh(_without_prim(path, prim), space)
        if _has_suffix(path, ".obj")
        else read_usd_mesh(path, prim, cage, notes)
    )


def read_head(
    path: Path | str,
    prim: str | None = None,
    *,
    space: StageSpace = METRES,
    cage: bool | None = None,
    notes: list[str] | None = None,
) -> tuple[Mesh, list[Mesh], StageSpace]:
    """Reads a mesh that hair grows on, the other visible surfaces of its file, and the space of the file.

    An OBJ has no other surfaces. Parameters and errors: as for ``read_mesh``
    """
    path = Path(path)
    if _has_suffix(path, ".obj", ".abc"):
        return read_mesh(path, prim, space=space, cage=cage, notes=notes), [], space
    return read_usd_head(path, prim, cage, notes)


def read_clip(
    path: Path | str,
    prim: str | None = None,
    frames: tuple[int, int] | None = None,
    fps: float | None = None,
    *,
    space: StageSpace = METRES,
    cage: bool | None = None,
) -> Clip:
    """Reads the positions of a mesh at all whole frames, in world space.

    prim, space, cage: as for ``read_mesh``
    frames:      first and last frame of a shot, instead of the range of the stage; the clip also has the frame beside
                 the first that gives the velocity there. A static mesh gives one sample
    fps:         frames per second of the shot; by default those of the file
    """
    path = Path(path)
    if _has_suffix(path, ".obj"):
        return Clip(np.zeros(1), read_obj_mesh(_without_prim(path, prim), space).points[None], space.fps)
    return read_usd_clip(path, prim, frames, fps, cage)


def read_curves(
    path: Path | str, prim: str | None = None, *, space: StageSpace = METRES, notes: list[str] | None = None
) -> Curves:
    """Reads curves in their rest pose as polylines, in metres and Y-up, from USD, Alembic, OBJ, .hair or .tfx.

    Cubic curves of USD are evaluated at 6 points per segment; pinned Catmull-Rom curves keep their vertices. Ids come
    from a primvar like ``groom_id``, or are 0, 1, 2 …. Primvars become attributes, and ``widths`` the attribute
    ``width`` [m]. The value of an attribute is its default, or else its first sample.

    prim:  path of a ``BasisCurves`` prim in USD, or name of curves in Alembic; by default the only ones
    space: unit and up-axis of another file than USD, which stores neither
    notes: receives a sentence for each thing in the file that is not used

    Raises UserError for a file that is not readable, or has no such curves.
    """
    path = Path(path)
    if _has_suffix(path, ".abc"):
        return read_alembic_curves(path, prim, space)
    readers = {".obj": read_obj_curves, ".hair": read_hair, ".tfx": read_tfx}
    if reader := readers.get(path.suffix.lower()):
        return reader(_without_prim(path, prim), space)
    return read_usd_curves(path, prim, notes)


def read_space(path: Path | str, *, space: StageSpace = METRES) -> StageSpace:
    """Unit, up-axis and frame rate of a USD file; ``space`` for a file of another format.

    Fallbacks of a USD file: 0.01 m, Y and 24 frames per second.
    """
    return space if _has_suffix(Path(path), ".obj", ".hair", ".tfx", ".abc") else read_usd_space(path)


def _has_suffix(path: Path, *suffixes: str) -> bool:
    return path.suffix.lower() in suffixes


def _without_prim(path: Path, prim: str | None) -> Path:
    """Returns the path of a format without prims; raises UserError when one is named."""
    if prim is not None:
        raise UserError(f"{path}: has no prims such as {prim}; leave it out (false in a variant)")
    return path
