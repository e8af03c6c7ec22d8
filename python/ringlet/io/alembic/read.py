"""Reads archives: all curves and surfaces, at the frames of their samples."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ringlet.data import limits
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.hair_scene import CurveSet, HairScene
from ringlet.data.reads import record
from ringlet.data.regular import check_regular
from ringlet.data.stage import StageSpace
from ringlet.io.alembic.archive import Archive
from ringlet.io.alembic.library import SHAPE, library
from ringlet.io.alembic.read_curves import curve_sets
from ringlet.io.alembic.read_surfaces import has_faces, surface
from ringlet.io.unreal import name_guides

MAGIC = b"Ogawa", b"\x89HDF"


@contextmanager
def open_alembic(path: Path, space: StageSpace) -> Iterator[HairScene]:
    """Opens an archive; its frames are read as they are asked for.

    space: unit and up-axis of the archive

    Raises UserError for a file that is not readable, and for curves or meshes that are not valid.
    """
    modules = library(path)
    check_regular(path)
    _check_magic(path)
    record(path)
    try:
        opened = modules.abc.IArchive(str(path))
        rate = float(modules.abc.GetArchiveInfo(opened).get("dccFPS") or 0.0)
        yield _scene(Archive(modules, path, space), opened.getTop(), rate if 1e-2 <= rate <= 1e5 else 0.0)
    except RuntimeError as error:
        line = next(iter(str(error).splitlines()), "it is damaged")
        raise UserError(f"{path}: cannot be read as Alembic ({line[:120]}); export it again") from None


def read_alembic_curves(path: Path, prim: str | None, space: StageSpace) -> Curves:
    """Reads the curves of an archive in their first frame: those of a name, or by default the only ones."""
    with open_alembic(path, space) as scene:
        found = [one for one in scene.sets if prim is None or one.name == prim]
        if len(found) != 1:
            names = ", ".join(one.name for one in scene.sets) or "none"
            wrong = "has no such curves" if not found else f"has {len(found)} sets of curves"
            raise UserError(f"{path}: {wrong}; name one of: {names}")
        return found[0].curves


def _check_magic(path: Path) -> None:
    if not path.is_file():
        raise UserError(f"{path}: there is no such file; check the name")
    with path.open("rb") as file:
        if not file.read(8).startswith(MAGIC):
            raise UserError(f"{path}: is no Alembic archive; choose another")


def _scene(archive: Archive, top: Any, rate: float) -> HairScene:
    """Everything below the top object.

    rate: frames per second that the archive names; 0 for none, so that they are those of the fastest samples
    """
    sets, meshes, frames = list[CurveSet](), list[tuple[Any, list[Any]]](), set[float]()
    found = list(_objects(archive, top, []))
    timed = [schema for schema, _ in found if _moves(archive, schema)]
    timed += [xform for _, above in found for xform in above if xform.getNumSamples() > 1]
    cycles = [one.getTimeSampling().getTimeSamplingType().getTimePerCycle() for one in timed]
    if rate:
        archive.fps = rate
    elif cycles and 1e-5 < min(cycles) < 100.0:
        archive.fps = round(1.0 / min(cycles), 6)
    for schema, above in found:
        times = {
            archive.frame(one.getTimeSampling().getSampleTime(k))
            for one in (schema, *above)
            if _moves(archive, one)
            for k in range(one.getNumSamples())
        }
        frames |= times
        if isinstance(schema, archive.library.geom.ICurvesSchema):
            sets += curve_sets(archive, schema, above, bool(times))
        else:
            meshes.append((schema, above))
    if len(frames) > limits.FRAMES:
        raise UserError(f"{archive.path}: has {len(frames)} frames; must be at most {limits.FRAMES:,}")
    archive.unread += name_guides(sets)
    ordered = np.array(sorted(frames))
    bodies = [surface(archive, schema, above, ordered) for schema, above in meshes if has_faces(archive, schema)]
    space = StageSpace(archive.space.meters_per_unit, archive.space.up_axis, archive.fps)
    return HairScene(sorted(sets, key=lambda one: one.guide), bodies, ordered, space, archive.unread)


def _objects(archive: Archive, parent: Any, above: list[Any]) -> Iterator[tuple[Any, list[Any]]]:
    """The schemas of curves and meshes below an object, each with those of the transforms above it."""
    geom, wrap = archive.library.geom, archive.library.abc.WrapExistingFlag.kWrapExisting
    for child in (parent.getChild(index) for index in range(parent.getNumChildren())):
        data, path = child.getMetaData(), above
        if geom.IXform.matches(data):
            path = [*above, geom.IXform(child, wrap).getSchema()]
        for kind in (geom.ICurves, geom.IPolyMesh, geom.ISubD):
            if kind.matches(data):
                schema = kind(child, wrap).getSchema()
                own = child.getName() != parent.getName() + SHAPE
                archive.names[id(schema)] = child.getName() if own else parent.getName()
                yield schema, path
        if geom.INuPatch.matches(data) or geom.IPoints.matches(data):
            archive.unread.append(f"{child.getName()} is neither curves nor a mesh, and is not read")
        yield from _objects(archive, child, path)


def _moves(archive: Archive, timed: Any) -> bool:
    """Whether a schema has positions that are not its rest pose: several samples, or one at a frame."""
    if timed.getNumSamples() > 1:
        return True
    if not isinstance(timed, archive.library.geom.ICurvesSchema):
        return False
    parameters, sampling = timed.getArbGeomParams(), timed.getTimeSampling()
    is_timed = sampling.getTimeSamplingType().getTimePerCycle() != 1.0 or sampling.getSampleTime(0) != 0.0
    return is_timed and parameters.valid() and parameters.getPropertyHeader("rest") is not None
