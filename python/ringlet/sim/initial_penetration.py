"""Initial penetration: vertices inside colliders, edges through cloth and overlaps of locks as a shot begins."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh
from ringlet.sim.garment import SimulatedGarment
from ringlet.sim.obstacle import Body
from ringlet.sim.penetration import edge_triangle_intersections, mesh_edges, penetration_depths
from ringlet.sim.scene import Scene

Array = NDArray[np.float64]

WORST = 5  # places that a report lists


def report_inside(locks: Curves, mesh: Mesh, depth: Array) -> dict[str, Any]:
    """Vertices of locks inside a mesh: how many of how many locks, and the deepest of them."""
    inside = np.flatnonzero(depth > 0.0)
    deepest = inside[np.argsort(-depth[inside], kind="stable")[:WORST]]
    return {
        "mesh": mesh.name,
        "vertices": len(inside),
        "locks": len(np.unique(_lock_of(locks, inside))),
        "depth": float(depth.max(initial=0.0)),
        "worst": [{**_place(locks, vertex), "depth": float(depth[vertex])} for vertex in deepest],
        "marks": _marks(locks.points[inside], depth[inside]),
    }


def report_overlaps(locks: Curves, scene: Scene) -> dict[str, Any]:
    """Initial overlaps between locks: pairs nearer than the distance of contact, and coincident locks."""
    at = scene.strands.positions
    vertices, values = scene.touching()
    pairs = _lock_of(locks, vertices[:, [0, 3]])
    of_two = (vertices < len(at)).all(axis=1) & (pairs[:, 0] != pairs[:, 1])
    vertices, weights, reach, pairs = vertices[of_two], values[of_two, :4], values[of_two, 7], pairs[of_two]
    distance = np.linalg.norm(np.einsum("kv,kvi->ki", weights, at[vertices]), axis=1)
    nearest = np.argsort(distance, kind="stable")[:WORST]
    of_coincident = scene.coincident[(scene.coincident < len(at)).all(axis=1)]
    coincident = np.unique(np.sort(locks.ids[_lock_of(locks, of_coincident)], axis=1), axis=0)
    return {
        "coincident": coincident[coincident[:, 0] != coincident[:, 1]].tolist(),
        "places": len(pairs),
        "locks": len(np.unique(pairs)),
        "depth": float((reach - distance).max(initial=0.0)),
        "worst": [
            {
                **_place(locks, int(vertices[k, 0])),
                "other": int(locks.ids[pairs[k, 1]]),
                "distance": float(distance[k]),
            }
            for k in nearest
        ],
        "marks": _marks(locks.points[vertices[:, 0]], reach - distance),
    }


def refuse_intersecting(garment: SimulatedGarment, names: Sequence[str], bodies: Sequence[Body]) -> None:
    """Refuses a cloth that intersects a body or begins inside it, but for vertices that this body holds."""
    cloth, triangles = garment.cloth, garment.cloth.mesh.triangles
    for k, (name, body) in enumerate(zip(names, bodies, strict=True)):
        free = ~cloth.held if k == garment.pinned_to else np.ones(len(cloth.held), bool)
        edges, faces = mesh_edges(triangles), triangles[free[triangles].all(axis=1)]
        edges = edges[free[edges].all(axis=1)]
        surface, sides = np.asarray(body.points, np.float64), np.asarray(body.triangles, np.int32)
        through = edge_triangle_intersections(cloth.positions[edges], surface[sides])
        back = edge_triangle_intersections(surface[mesh_edges(sides)], cloth.positions[faces])
        places = [edges[through[:, 0], 0], faces[back[:, 1], 0], _inside(cloth.positions, free, sides, surface)]
        vertices = np.unique(np.concatenate(places))
        if len(vertices):
            place = ", ".join(f"{x:.3g}" for x in cloth.positions[vertices[0]])
            raise UserError(
                f"shot: cloth '{garment.name}' begins "
                f"{'through' if len(through) or len(back) else 'inside'} '{name}' at "
                f"{len(vertices)} of its vertices, such as {vertices[0]} at ({place}) m; move it out, or leave that "
                "mesh out of the colliders"
            )


def _inside(points: Array, free: NDArray[np.bool_], triangles: NDArray[np.int32], corners: Array) -> NDArray[np.int64]:
    """The free points inside a closed mesh."""
    return np.flatnonzero(free & (penetration_depths(points, triangles, corners) > 0.0))


def report_intersections(locks: Curves, garments: Sequence[SimulatedGarment]) -> list[dict[str, Any]]:
    """Intersections of each cloth with locks, with itself and with other cloths, which stay as they are."""
    return [found for one in garments for found in _intersections(locks, one, garments) if found["places"]]


def _intersections(
    locks: Curves, through: SimulatedGarment, garments: Sequence[SimulatedGarment]
) -> Iterator[dict[str, Any]]:
    triangles = through.cloth.mesh.triangles
    corners = through.cloth.positions[triangles]
    segments = np.delete(np.arange(len(locks.points) - 1), locks.offsets[1:-1] - 1)
    points = np.asarray(locks.points, np.float64)
    found = np.unique(edge_triangle_intersections(points[segments[:, None] + [0, 1]], corners)[:, 0])
    vertices = segments[found]
    yield {
        "what": "locks",
        "cloth": through.name,
        "places": len(found),
        "locks": len(np.unique(_lock_of(locks, vertices))),
        "worst": [_place(locks, int(vertex)) for vertex in vertices[:WORST]],
        "marks": _marks(locks.points[vertices], np.ones(len(vertices))),
    }
    for other in garments:
        edges = mesh_edges(other.cloth.mesh.triangles)
        pairs = edge_triangle_intersections(other.cloth.positions[edges], corners)
        if other is through:
            pairs = pairs[~(edges[pairs[:, 0], :, None] == triangles[pairs[:, 1], None, :]).any(axis=(1, 2))]
        places = other.cloth.positions[edges[pairs[:, 0], 0]]
        worst = [{"place": place.tolist()} for place in places[:WORST]]
        marks = _marks(places, np.ones(len(places)))
        yield {"what": other.name, "cloth": through.name, "places": len(pairs), "worst": worst, "marks": marks}


def start_report(
    inside: list[dict[str, Any]], piercing: list[dict[str, Any]], overlapping: dict[str, Any]
) -> dict[str, Any]:
    """The report of a start, with the ``marks`` of every place in one list."""
    marks = [mark for found in (*inside, *piercing, overlapping) for mark in found.pop("marks")]
    return {"inside": inside, "piercing": piercing, "overlapping": overlapping, "marks": marks}


def _marks(places: NDArray[np.floating], depth: Array) -> list[list[float]]:
    """Rows of a place [m], to a tenth of a millimetre, and its depth relative to the worst of its kind, from 0 to 1."""
    depths = np.clip(depth / max(float(depth.max(initial=0.0)), 1e-12), 0.0, 1.0)
    rows = zip(places, depths, strict=True)
    return [[*(round(float(x), 4) for x in place), round(float(d), 3)] for place, d in rows]


def _lock_of(locks: Curves, vertices: NDArray[np.integer]) -> NDArray[np.int64]:
    """The index of the lock that each vertex belongs to."""
    return np.searchsorted(locks.offsets, vertices, side="right") - 1


def _place(locks: Curves, vertex: int) -> dict[str, Any]:
    """A vertex for an artist: the id of its lock, its number from the root, its position [m]."""
    lock = int(_lock_of(locks, np.array(vertex)))
    return {
        "lock": int(locks.ids[lock]),
        "vertex": int(vertex - locks.offsets[lock]),
        "place": [float(x) for x in locks.points[vertex]],
    }
