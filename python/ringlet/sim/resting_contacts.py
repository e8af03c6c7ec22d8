"""Where locks rest on bodies and on one another, and how these share what bears them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array, diags_array, eye_array
from scipy.sparse.linalg import splu

from ringlet.data.curves import Curves
from ringlet.shot.contact import ShotContact
from ringlet.sim.obstacle import Body, Obstacle
from ringlet.sim.penetration import penetration_depths
from ringlet.sim.scene import Scene
from ringlet.sim.strands import Strands

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

VAGUE = 1e-9  # of forces that act on the same vertices alike, the least are taken


@dataclass
class RestingContacts:
    """Where locks are borne by what touches them.

    vertices: the four of each pair, those of a body after the locks', shape (k, 4)
    weights:  with which a force acts on those of locks, shape (k, 4); 0 on a body
    acting:   the vertices that it acts on, shape (k, 4); those of a body are the lock's
    away:     which way the first of the two is pushed, of length 1, shape (k, 3)
    aside:    across that, as far as it goes towards the last vertex from the one before, shape (k, 3)
    body:     1 + which it is; 0: another lock, shape (k,)
    """

    vertices: NDArray[np.int32]
    weights: Array
    acting: Indices
    away: Array
    aside: Array
    body: Indices


def resting_contacts(
    contact: ShotContact, locks: Curves, strands: Strands, obstacles: Sequence[Obstacle]
) -> RestingContacts:
    """Locks that are as near to a body or to one another as they touch are pushed away from it, as the scene has it.

    Two locks where they are nearest, a lock and a body where they are nearest to each vertex. Not what begins inside a
    body, and not at a lock's tip, off which another would slide.
    """
    surfaces = [np.asarray(one.mesh.points, np.float64) for one in obstacles]
    bodies = [
        Body(surface, one.mesh.triangles, one.settings.thickness, one.settings.friction)
        for one, surface in zip(obstacles, surfaces, strict=True)
    ]
    scene = Scene(strands, bodies, contact)
    vertices, values = scene.touching()
    at, count = scene.positions, len(locks.points)

    weights, of_lock = values[:, :4], vertices < count
    body = np.searchsorted(np.cumsum([count, *map(len, surfaces)]), vertices.max(axis=1), side="right")  # 0: of locks
    main = np.take_along_axis(vertices, np.where(of_lock, np.abs(weights), -1.0).argmax(axis=1)[:, None], axis=1)[:, 0]
    lock = np.sort(np.searchsorted(locks.offsets, vertices[:, [0, 3]], side="right") - 1, axis=1)
    places = np.where(body[:, None] == 0, lock, np.c_[main, count + body])
    at_tip = (np.isin(vertices, locks.offsets[1:] - 1) & (np.abs(weights) > 0.5)).any(axis=1)
    counts = np.where(body == 0, (lock[:, 0] != lock[:, 1]) & ~at_tip, ~np.asarray(strands.held)[main])
    for k, surface in enumerate(surfaces):
        on_it = np.flatnonzero((body == k + 1) & counts)
        counts[on_it] = penetration_depths(at[main[on_it]], obstacles[k].mesh.triangles, surface) == 0.0
    chosen = np.flatnonzero(counts)
    apart = np.linalg.norm(np.einsum("kv,kvi->ki", weights[chosen], at[vertices[chosen]]), axis=1)
    by_distance = chosen[np.argsort(apart, kind="stable")]
    _, first = np.unique(places[by_distance], axis=0, return_index=True)
    nearest = by_distance[first]
    away = values[nearest, 4:7]
    away = away / np.linalg.norm(away, axis=1, keepdims=True)
    aside = at[vertices[nearest, 3]] - at[vertices[nearest, 2]]
    aside = aside - (aside * away).sum(axis=1, keepdims=True) * away
    return RestingContacts(
        vertices[nearest],
        np.where(of_lock[nearest], weights[nearest], 0.0),
        np.where(of_lock[nearest], vertices[nearest], main[nearest, None]).astype(np.int64),
        away,
        aside / np.maximum(np.linalg.norm(aside, axis=1, keepdims=True), 1e-300),
        body[nearest],
    )


def initial_contact_forces(
    contact: ShotContact, locks: Curves, strands: Strands, obstacles: Sequence[Obstacle], borne: Array
) -> tuple[NDArray[np.int32], Array]:
    """How what touches locks shares what bears them, as ``Scene.bear`` takes it: vertices (k, 4), forces [N] (k, 3).

    borne: what ``support`` found for them [N], shape (n, 3)

    Every vertex is borne by the sum of what touches there: as many equations as vertices, and fewer forces.
    """
    rests = resting_contacts(contact, locks, strands, obstacles)
    rows, columns = rests.acting.ravel(), np.repeat(np.arange(len(rests.body)), 4)
    acts = coo_array((rests.weights.ravel(), (rows, columns)), (len(borne), len(rests.body))).tocsr()
    acts = diags_array((~np.asarray(strands.held)).astype(float)) @ acts  # what is held bears all that it has to
    count = len(rests.body)
    force = np.zeros((count, 3))
    if count > 0:
        force = splu(csc_array(acts.T @ acts + VAGUE * eye_array(count))).solve(acts.T @ borne)
    frame = np.stack([rests.away, rests.aside, np.cross(rests.away, rests.aside)], axis=1)
    force = np.einsum("kai,ki->ka", frame, force)
    bears = force[:, 0] > 0.0
    return rests.vertices[bears], force[bears]
