"""Wavefront OBJ: meshes and polylines.

Format: http://paulbourke.net/dataformats/obj/. A file stores neither its unit nor its up-axis.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.explain import shown
from ringlet.data.files import replacing
from ringlet.data.mesh import Mesh
from ringlet.data.reads import record
from ringlet.data.regular import read_bytes
from ringlet.data.stage import StageSpace
from ringlet.data.surfaces import UNCOLORED, Color, color_of
from ringlet.io.polygons import check_polygons, polygon_places, triangulate
from ringlet.io.space import check_points, from_metres, to_metres

MOST_BYTES = 1_000_000_000  # of a file, which takes about 20 times as much memory
MAX_POINTS = 2**31 - 1
MAX_GROUPS = 100  # largest number of groups of a face


@dataclass
class _Content:
    """Parsed contents of a file; indices count from 0."""

    points: list[list[float]] = field(default_factory=list)
    uv: list[list[float]] = field(default_factory=list)
    faces: list[list[int]] = field(default_factory=list)
    face_uv: list[list[int]] = field(default_factory=list)
    groups: dict[str, list[int]] = field(default_factory=dict)
    materials: dict[str, list[int]] = field(default_factory=dict)
    libraries: list[str] = field(default_factory=list)
    lines: list[list[int]] = field(default_factory=list)


def read_obj_mesh(path: Path, space: StageSpace) -> Mesh:
    """Reads all faces as one mesh; groups (``g``), objects (``o``) and materials (``usemtl``) become regions.

    Colours are those of the materials, ``Kd`` in their library or else what their names say.
    """
    content = _parse(path)
    points = np.array(content.points, np.float64).reshape(-1, 3)
    check_points(points, str(path))
    counts = np.array([len(face) for face in content.faces], np.int64)
    indices = np.array([index for face in content.faces for index in face], np.int64)
    if len(indices) and indices.max() >= len(points):
        raise UserError(f"{path}: a face uses point {indices.max() + 1}; must be from 1 to {len(points)}")
    check_polygons(counts, indices, len(points), str(path))
    corners, faces = triangulate(points, counts, indices)

    uv, uv_indices = (
        np.array(content.uv).reshape(-1, 2),
        np.array([i for face in content.face_uv for i in face], np.int64),
    )
    if len(uv_indices) == len(indices) and (bad := np.flatnonzero((uv_indices < 0) | (uv_indices >= len(uv)))).size:
        raise UserError(f"{path}: a face uses vt {uv_indices[bad[0]] + 1}; must be from 1 to {len(uv)}")
    triangles = indices[corners].astype(np.int32)
    materials = {name: _triangles_of(np.array(chosen), faces) for name, chosen in content.materials.items()}
    return Mesh(
        name=path.name,
        points=to_metres(points, space),
        triangles=triangles,
        uv=uv[uv_indices][corners] if len(uv_indices) == len(indices) else None,
        faces=faces.astype(np.int32),
        places=polygon_places(counts)[corners],
        regions=materials | {name: _triangles_of(np.unique(chosen), faces) for name, chosen in content.groups.items()},
        colors=_vertex_colors(materials, _library_colors(path, content.libraries), triangles, len(points)),
    )


def _triangles_of(chosen: NDArray[np.integer], faces: NDArray[np.integer]) -> NDArray[np.int32]:
    """Triangles of chosen polygons, in order.

    chosen: ascending indices of polygons
    faces:  polygon of each triangle, ascending
    """
    begin, end = np.searchsorted(faces, chosen), np.searchsorted(faces, chosen, side="right")
    before = np.cumsum(end - begin) - (end - begin)
    return (np.repeat(begin - before, end - begin) + np.arange((end - begin).sum())).astype(np.int32)


def _vertex_colors(
    materials: dict[str, NDArray[np.int32]], library: dict[str, Color], triangles: NDArray[np.int32], count: int
) -> NDArray[np.float64] | None:
    """Colours of vertices, shape (count, 3), by the materials of their triangles; None where these say nothing."""
    colors = {name: library.get(name, color_of(name)) for name in materials}
    if all(color is UNCOLORED for color in colors.values()):
        return None
    of_vertices = np.tile(UNCOLORED, (count, 1))
    for name, chosen in materials.items():
        of_vertices[triangles[chosen]] = colors[name]
    return of_vertices


def _library_colors(path: Path, libraries: list[str]) -> dict[str, Color]:
    """Diffuse colours (``Kd``) of materials by name, of the libraries in the folder of a file that are there."""
    colors, name = dict[str, Color](), ""
    for library in (path.parent / Path(one).name for one in libraries):
        if not library.is_file():
            continue
        record(library)
        for line in read_bytes(library, most=MOST_BYTES).decode("utf-8-sig", errors="replace").splitlines():
            key, *words = line.split() or [""]
            if key == "newmtl":
                name = " ".join(words)
            elif key == "Kd" and len(words) == 3:
                with suppress(ValueError):
                    red, green, blue = map(float, words)
                    colors[name] = red, green, blue
    return colors


def read_obj_curves(path: Path, space: StageSpace) -> Curves:
    """Reads the polylines (``l``), root first."""
    content = _parse(path)
    points = np.array(content.points, np.float64).reshape(-1, 3)
    check_points(points, str(path))
    points = to_metres(points, space)
    for line in content.lines:
        if min(line) < 0 or max(line) >= len(points):
            raise UserError(f"{path}: a line uses point {max(line) + 1}; must be from 1 to {len(points)}")
    return Curves.from_list([points[line] for line in content.lines]).check(str(path))


def write_obj_curves(curves: Curves, path: Path, space: StageSpace) -> None:
    """Writes curves as polylines."""
    with replacing(path) as aside, aside.open("w", encoding="ascii") as file:
        file.writelines(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in from_metres(curves.points, space).tolist())
        for first, last in zip(curves.offsets[:-1].tolist(), curves.offsets[1:].tolist(), strict=True):
            file.write(f"l {' '.join(map(str, range(first + 1, last + 1)))}\n")


def _parse(path: Path) -> _Content:
    content, named, material = _Content(), [], ""
    text = read_bytes(path, most=MOST_BYTES).decode("utf-8-sig", errors="replace")
    record(path)
    for number, line in enumerate(text.replace("\\\n", " ").splitlines(), 1):
        key, *words = line.split("#", 1)[0].split() or [""]
        try:
            if key == "v":
                x, y, z = map(float, words[:3])
                content.points.append([x, y, z])
            elif key == "vt":
                u, v = map(float, (*words, "0")[:2])
                content.uv.append([u, v])
            elif key == "f":
                parts = [word.split("/") for word in words]
                content.faces.append([_index(part[0], len(content.points)) for part in parts])
                content.face_uv.append([_index(part[1], len(content.uv)) for part in parts if part[1:] and part[1]])
                for name in named:
                    content.groups.setdefault(name, []).append(len(content.faces) - 1)
                if material:
                    content.materials.setdefault(material, []).append(len(content.faces) - 1)
            elif key == "l" and words:
                content.lines.append([_index(word.split("/")[0], len(content.points)) for word in words])
            elif key == "usemtl":
                material = " ".join(words)
            elif key == "mtllib":
                content.libraries.append(" ".join(words))
            elif key in ("g", "o"):
                named = list(dict.fromkeys(words))
                if len(named) > MAX_GROUPS:
                    raise UserError(f"{path}: line {number} names {len(named)} groups; must be at most {MAX_GROUPS}")
        except _IndexOutOfRangeError as error:
            raise UserError(f"{path}: line {number} uses point {error}") from None
        except ValueError:
            raise UserError(f"{path}: line {number} is '{line.strip()[:60]}'; must be numbers after '{key}'") from None
    return content


class _IndexOutOfRangeError(ValueError):
    """An index that names no element."""


def _index(word: str, count: int) -> int:
    """Converts an OBJ index, which counts from 1 or backwards from the last element, to one that counts from 0.

    Raises _IndexOutOfRangeError for 0, and for an index that no file has.
    """
    index = int(word)
    if index == 0:
        raise _IndexOutOfRangeError("0; must be from 1, or from -1 backwards")
    if index < -count:
        raise _IndexOutOfRangeError(f"{shown(index)}; there are {count} before it")
    if index > MAX_POINTS:
        raise _IndexOutOfRangeError(f"{shown(index)}; must be at most {MAX_POINTS}")
    return index - 1 if index > 0 else count + index
