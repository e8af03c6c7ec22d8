"""Meshes and curves from a file of any known format, chosen by its suffix."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.mesh import Clip, Mesh
from ringlet.data.stage import StageSpace
from ringlet.io.hair import read_hair
from ringlet.io.obj import read_obj_curves, read_obj_mesh
from ringlet.io.usd.curves import read_usd_curves
from ringlet.io.usd.mesh import read_usd_clip, read_usd_mesh
from ringlet.io.usd.stage import read_usd_space

METRES = StageSpace()


def read_mesh(path: Path | str, prim: str | None = None, *, space: StageSpace = METRES) -> Mesh:
    """Reads a mesh in its rest pose, in metres and Y-up, from USD or OBJ.

    Polygons are cut into fans (subdivision surfaces by their cage). Face ``GeomSubset``s, or the groups of an OBJ,
    become regions. The rest pose is the default value of the points, or the first time sample where there is none. A
    USD file without ``metersPerUnit`` is in centimetres, as USD has it.

    prim:  its path in USD; by default the only mesh, or the only one with a region called ``scalp``
    space: unit and up-axis of an OBJ, which does not say
    """
    path = Path(path)
    return read_obj_mesh(_whole(path, prim), space) if _is(path, ".obj") else read_usd_mesh(path, prim)


def read_clip(
    path: Path | str,
    prim: str | None = None,
    frames: tuple[float, float] | None = None,
    *,
    space: StageSpace = METRES,
) -> Clip:
    """Reads the positions of a mesh at all whole frames, with every transform above it applied.

    prim, space: as for ``read_mesh``
    frames:      first and last frame, instead of the range of the stage; a mesh that does not move gives one sample
    """
    path = Path(path)
    if _is(path, ".obj"):
        return Clip(np.zeros(1), read_obj_mesh(_whole(path, prim), space).points[None], space.fps)
    return read_usd_clip(path, prim, frames)


def read_curves(path: Path | str, prim: str | None = None, *, space: StageSpace = METRES) -> Curves:
    """Reads curves in their rest pose as polylines, in metres and Y-up, from USD, OBJ or .hair.

    Cubic curves of USD are evaluated at 6 points per segment, but for pinned Catmull-Rom curves, which keep their
    vertices. Names come from a primvar like ``groom_id``, or are 0, 1, 2 …; primvars become attributes, ``widths`` the
    attribute ``width`` [m].

    prim:  the path of a ``BasisCurves`` prim in USD; by default the only one there is
    space: unit and up-axis of an OBJ or .hair file, which do not say
    """
    path = Path(path)
    if _is(path, ".obj"):
        return read_obj_curves(_whole(path, prim), space)
    return read_hair(_whole(path, prim), space) if _is(path, ".hair") else read_usd_curves(path, prim)


def read_space(path: Path | str, *, space: StageSpace = METRES) -> StageSpace:
    """Unit, up-axis and rate of a file; ``space`` for an OBJ or .hair file.

    Where a USD file does not say: 0.01 m (USD's own fallback), Y and 24.
    """
    return space if _is(Path(path), ".obj", ".hair") else read_usd_space(path)


def _is(path: Path, *suffixes: str) -> bool:
    return path.suffix.lower() in suffixes


def _whole(path: Path, prim: str | None) -> Path:
    """The path of a file that is read whole; refuses a prim in it."""
    if prim is not None:
        raise UserError(f"{path}: has no prims such as {prim}; leave it out")
    return path
