"""Resting contacts: where groomed locks lie on bodies and on one another, and the forces there at the start."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array, diags_array, eye_array
from scipy.sparse.linalg import splu

from ringlet.data.curves import Curves
from ringlet.shot.contact import ShotContact
from ringlet.sim.contact_radii import contact_radii
from ringlet.sim.obstacle import Body, Obstacle
from ringlet.sim.penetration import penetration_depths
from ringlet.sim.scene import Scene
from ringlet.sim.strands import Strands

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

LEAST_OVERLAP = 0.03  # of the distance of contact; a pair that overlaps less has to sink in before it carries a lock
REGULARISATION = 1e-9  # of the least squares: of contacts that act on the same vertices alike, the smallest forces


@dataclass
class RestingContacts:
    """Contacts that can carry locks.

    vertices: the four of each pair, those of a body after the locks', shape (k, 4)
    weights:  of the contact force on those of locks, shape (k, 4); 0 on a body
    acting:   the vertices that it acts on, shape (k, 4); in place of those of a body, the lock's
    normal:   the direction in which the first of the two is pushed, of length 1, shape (k, 3)
    tangent:  the direction across it that is nearest to the last edge of the pair, shape (k, 3)
    body:     1 + the index of the body; 0: another lock, shape (k,)
    """

    vertices: NDArray[np.int32]
    weights: Array
    acting: Indices
    normal: Array
    tangent: Array
    body: Indices


def resting_contacts(
    contact: ShotContact, locks: Curves, strands: Strands, obstacles: Sequence[Obstacle]
) -> RestingContacts:
    """The contacts of locks as groomed, as their scene has them: of two locks the nearest, and of each vertex and body.

    A tip carries no other lock, which would slide off, and a vertex that begins inside a body is not carried by it. Nor
    does a pair carry that overlaps by less than ``LEAST_OVERLAP``.
    """
    surfaces = [np.asarray(one.mesh.points, np.float64) for one in obstacles]
    bodies = [
        Body(surface, one.mesh.triangles, one.settings.thickness, one.settings.friction)
        for one, surface in zip(obstacles, surfaces, strict=True)
    ]
    scene = Scene(strands, bodies, contact, radii=contact_radii(contact, locks))
    vertices, values = scene.touching()
    at, count = scene.positions, len(locks.points)

    weights, of_lock = values[:, :4], vertices < count
    body = np.searchsorted(np.cumsum([count, *map(len, surfaces)]), vertices.max(axis=1), side="right")  # 0: of locks
    main = np.take_along_axis(vertices, np.where(of_lock, np.abs(weights), -1.0).argmax(axis=1)[:, None], axis=1)[:, 0]
    lock = np.sort(np.searchsorted(locks.offsets, vertices[:, [0, 3]], side="right") - 1, axis=1)
    at_tip = (np.isin(vertices, locks.offsets[1:] - 1) & (np.abs(weights) > 0.5)).any(axis=1)
    carries = np.where(body == 0, (lock[:, 0] != lock[:, 1]) & ~at_tip, ~np.asarray(strands.held)[main])
    for k, surface in enumerate(surfaces):
        on_it = np.flatnonzero((body == k + 1) & carries)
        carries[on_it] = penetration_depths(at[main[on_it]], obstacles[k].mesh.triangles, surface) == 0.0

    gap = np.linalg.norm(np.einsum("kv,kvi->ki", weights, at[vertices]), axis=1)
    carries &= gap <= (1.0 - LEAST_OVERLAP) * values[:, 7]
    two = np.where(body[:, None] == 0, lock, np.c_[main, count + body])  # what touches: two locks, or vertex and body
    chosen = np.flatnonzero(carries)
    by_gap = chosen[np.argsort(gap[chosen], kind="stable")]
    _, first = np.unique(two[by_gap], axis=0, return_index=True)
    nearest = by_gap[first]
    normal = values[nearest, 4:7]
    normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    tangent = at[vertices[nearest, 3]] - at[vertices[nearest, 2]]
    tangent = tangent - (tangent * normal).sum(axis=1, keepdims=True) * normal
    return RestingContacts(
        vertices[nearest],
        np.where(of_lock[nearest], weights[nearest], 0.0),
        np.where(of_lock[nearest], vertices[nearest], main[nearest, None]).astype(np.int64),
        normal,
        tangent / np.maximum(np.linalg.norm(tangent, axis=1, keepdims=True), 1e-300),
        body[nearest],
    )


def initial_contact_forces(
    contact: ShotContact, locks: Curves, strands: Strands, obstacles: Sequence[Obstacle], support: Array
) -> tuple[NDArray[np.int32], Array]:
    """Contact forces that add up to the support of locks: vertices (k, 4), forces [N] (k, 3).

    ``Scene.set_initial_forces`` takes them.

    support: the forces that carry the locks at their vertices [N], shape (n, 3)

    Least squares: there are as many equations as vertices, and fewer forces.
    """
    contacts = resting_contacts(contact, locks, strands, obstacles)
    count = len(contacts.body)
    rows, columns = contacts.acting.ravel(), np.repeat(np.arange(count), 4)
    acts = coo_array((contacts.weights.ravel(), (rows, columns)), (len(support), count)).tocsr()
    acts = diags_array((~np.asarray(strands.held)).astype(float)) @ acts  # held vertices need no support
    force = np.zeros((count, 3))
    if count > 0:
        force = splu(csc_array(acts.T @ acts + REGULARISATION * eye_array(count))).solve(acts.T @ support)
    frame = np.stack([contacts.normal, contacts.tangent, np.cross(contacts.normal, contacts.tangent)], axis=1)
    force = np.einsum("kai,ki->ka", frame, force)
    pushes = force[:, 0] > 0.0
    return contacts.vertices[pushes], force[pushes]
