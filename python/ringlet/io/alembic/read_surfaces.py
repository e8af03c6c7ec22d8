"""Reads the polygon meshes of an archive; a subdivision surface as its cage."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError
from ringlet.data.mesh import Clip, Mesh
from ringlet.io.alembic.archive import Archive
from ringlet.io.polygons import check_polygons, polygon_places, triangulate


def has_faces(archive: Archive, schema: Any) -> bool:
    """Whether a mesh has faces; one without is as valid as a set without curves."""
    return len(schema.getValue(archive.first()).getFaceCounts()) > 0


def surface(archive: Archive, schema: Any, above: list[Any], frames: NDArray) -> tuple[Mesh, Clip | None]:
    """A mesh, with its clip at the frames where it moves."""
    where, sample = archive.where(schema), schema.getValue(archive.first())
    points = archive.placed(schema, above, None)
    counts = np.array(sample.getFaceCounts(), np.int64)
    indices = np.array(sample.getFaceIndices(), np.int64)
    check_polygons(counts, indices, len(points), where)
    corners, faces = triangulate(points, counts, indices, clockwise=True)
    uv, parameter = None, schema.getUVsParam()
    if parameter.valid():
        values, scope = archive.values(parameter), str(parameter.getScope())
        if scope == "kFacevaryingScope" and len(values) == len(indices):
            uv = values[corners].astype(np.float64)
        elif scope in ("kVertexScope", "kVaryingScope") and len(values) == len(points):
            uv = values[indices[corners]].astype(np.float64)
    _tell_unread(archive, schema, uv is not None)
    mesh = Mesh(
        name=f"{archive.path.name} {archive.name(schema)}",
        points=points,
        triangles=indices[corners].astype(np.int32),
        uv=uv,
        faces=faces.astype(np.int32),
        places=polygon_places(counts)[corners],
        regions=_regions(archive, schema, faces, len(counts)),
    )
    moves = any(timed.getNumSamples() > 1 for timed in (schema, *above))
    if not moves or not len(frames):
        return mesh, None
    clip = [archive.placed(schema, above, frame) for frame in frames]
    if any(at.shape != points.shape for at in clip):
        raise UserError(f"{where}: its number of points changes over time; export it with one topology")
    return mesh, Clip(frames, np.stack(clip), archive.fps)


def _regions(archive: Archive, schema: Any, faces: NDArray, count: int) -> dict[str, NDArray[np.int32]]:
    """Sets of faces as sets of triangles, by name; raises UserError for a face out of range."""
    regions = dict[str, NDArray[np.int32]]()
    for name in schema.getFaceSetNames():
        sample = schema.getFaceSet(name).getSchema().getValue(archive.first())
        chosen = np.array(sample.getFaces(), np.int64)
        if ((chosen < 0) | (chosen >= count)).any():
            raise UserError(f"{archive.where(schema)}/{name}: names a face that is not among {count}; export it again")
        regions[name] = np.flatnonzero(np.isin(faces, chosen)).astype(np.int32)
    return regions


def _tell_unread(archive: Archive, schema: Any, has_uv: bool) -> None:
    """Notes what a mesh of the archive has and the one that is read has not."""
    unheld, lost = archive.parameters(schema), list[str]()
    if schema.getUVsParam().valid() and not has_uv:
        unheld.add(schema.getUVsParam().getName())
    if unheld:
        lost.append(f"surfaces of an archive are read without {', '.join(sorted(unheld))}")
    if isinstance(schema, archive.library.geom.ISubDSchema):
        lost.append("its subdivision surface is read as its cage")
    elif schema.getNormalsParam().valid():
        lost.append("its normals are not read; surfaces are smooth")
    if schema.getVelocitiesProperty().valid() and schema.getNumSamples() < 2:
        lost.append("its velocities are not read; the motion is that of its points")
    archive.unread += [f"{archive.name(schema)}: {one}" for one in lost]
