"""What strands must hold inside to be still under loads.

The energy of a strand with a material frame depends on the edges' vectors and on how directors turn about them; where
it is still, its derivative by an edge is the load of all that is beyond, and its derivative by a director is zero. From
the tip to the root these are as many equations for each edge as there are forces: one that stretches it, two that bend
the corner at its beginning, one that twists the edge before.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.curves import Curves
from ringlet.shot.joints import Joints, corners, edges, rotate, turns, twists

Array = NDArray[np.float64]


def balance(
    curves: Curves, points: Array, directors: Array, loads: Array, held: int, twisting: Array | None = None
) -> Joints:
    """Forces [N] along edges, moments [N m] at corners and about edges that balance loads.

    points, directors: where the strands are still [m] and their directors, shapes (n, 3)
    loads:             what pulls at each vertex [N], shape (n, 3)
    held:              vertices of each strand that are held from its root; at least three, which hold its frame
    twisting:          what turns the director of each edge besides, as a nail does [N m], shape (n,)
    Each is the derivative of the elastic energy by the quantity of the same name in ``Joints``. Exact, whatever the
    shape and the stiffness; what happens between held vertices is not asked for, and zero.
    """
    length, tangent = edges(curves, points)
    length = np.where(length > 0.0, length, 1.0)
    bending, by_frame = _bend_gradients(curves, length, tangent, directors)
    binormal = _binormals(curves, tangent)
    found = Joints(np.zeros(len(points)), np.zeros((len(points), 2)), np.zeros(len(points)))
    beyond = np.zeros((len(curves), 3))
    twisting = np.zeros(len(points)) if twisting is None else twisting
    for k in range(curves.counts.max() - 2, held - 2, -1):
        going = curves.counts > k + 1
        edge = curves.offsets[:-1][going] + k
        beyond[going] += loads[edge + 1]
        # What the corner at its end and the twist of the edge itself take of it is known; of the twist before, that it
        # differs by what the bend and what else turns it do to the director.
        before = binormal[edge - 1] / length[edge, None]
        left = beyond[going] - np.einsum("ni,nij->nj", found.bend[edge + 1], bending[edge + 1, :, 0])
        behind = found.twist[edge] + twisting[edge]
        left -= found.twist[edge, None] * binormal[edge] / length[edge, None] + behind[:, None] * before
        matrix = np.empty((len(edge), 3, 3))
        matrix[:, :, 0] = tangent[edge]
        matrix[:, :, 1:] = np.swapaxes(bending[edge, :, 1] - by_frame[edge, :, None] * before[:, None], 1, 2)
        solved = np.linalg.solve(matrix, left[:, :, None])[:, :, 0]
        found.length[edge], found.bend[edge] = solved[:, 0], solved[:, 1:]
        found.twist[edge - 1] = behind - np.einsum("ni,ni->n", solved[:, 1:], by_frame[edge])
    return found


def _bend_gradients(curves: Curves, length: Array, tangent: Array, directors: Array) -> tuple[Array, Array]:
    """Of the two bends at each vertex: by the edges before and behind, shape (n, 2, 2, 3), and by the director, (n, 2).

    The formulas are those of the core (energy/strand/frame.h).
    """
    gradients, by_frame = np.zeros((len(length), 2, 2, 3)), np.zeros((len(length), 2))
    corner = corners(curves)
    before, behind, director = tangent[corner - 1], tangent[corner], directors[corner]
    across = np.cross(behind, director)
    cosine, normal = np.einsum("ni,ni->n", before, behind), np.cross(before, behind)
    sine = np.linalg.norm(normal, axis=1)
    bent = sine > 1e-8
    normal /= np.where(bent, sine, 1.0)[:, None]
    ratio = np.where(bent, np.arctan2(sine, cosine) / np.where(bent, sine, 1.0), 1.0)
    turn = turns(before, behind)
    for k, axis in enumerate((director, across)):
        part = np.einsum("ni,ni->n", axis, np.cross(normal, behind))
        first = np.cross(before, rotate(axis, -turn)) + ((ratio - 1.0) * part)[:, None] * normal
        second = ((1.0 - ratio * cosine) * part)[:, None] * normal - np.cross(behind, axis)
        gradients[corner, k, 0] = first / length[corner - 1, None]
        gradients[corner, k, 1] = second / length[corner, None]
    by_frame[corner, 0] = np.einsum("ni,ni->n", turn, across)
    by_frame[corner, 1] = -np.einsum("ni,ni->n", turn, director)
    return gradients, by_frame


def _binormals(curves: Curves, tangent: Array) -> Array:
    """Half the curvature binormals at the ends of the edges that twist: the derivative of twist, times the length."""
    binormal = np.zeros_like(tangent)
    edge = twists(curves)
    cosine = np.einsum("ni,ni->n", tangent[edge], tangent[edge + 1])
    binormal[edge] = np.cross(tangent[edge], tangent[edge + 1]) / np.maximum(1.0 + cosine, 1e-9)[:, None]
    return binormal
