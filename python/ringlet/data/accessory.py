"""Accessories: small meshes that hair wears, such as the band of a tie or a bead on a braid."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ringlet.data.mesh import Mesh
from ringlet.data.rigid import best_rotation

FLAT = 1e-9  # extent across a line, relative to that along it, of positions that are on the line


@dataclass(frozen=True)
class Accessory:
    """A mesh that points of locks carry rigidly.

    mesh:     in the rest pose [m]; its name is that of its prim
    vertices: points of the groom's locks, shape (k,): around the mesh, or the roots that it stays with
    """

    mesh: Mesh
    vertices: NDArray[np.int64]

    def at(self, rest: NDArray[np.floating], points: NDArray[np.floating]) -> NDArray[np.float64]:
        """Points of the mesh [m], shape (n, 3), for the points of all locks at rest and now, shape (m, 3) each."""
        return carried(self.mesh.points, rest[self.vertices], points[self.vertices])

    def moved(self, rest: NDArray[np.floating], points: NDArray[np.floating]) -> Accessory:
        """The accessory of a groom whose locks have other points at rest; as for ``at``."""
        return Accessory(replace(self.mesh, points=self.at(rest, points)), self.vertices)


def carried(points: NDArray, before: NDArray, after: NDArray) -> NDArray[np.float64]:
    """Points (n, 3) moved by the rigid motion that fits positions before and after best, shape (k, 3) each.

    Positions on a line leave a twist about it, which is none then.
    """
    before, after = np.asarray(before, np.float64), np.asarray(after, np.float64)
    middle, moved = before.mean(axis=0), after.mean(axis=0)
    if _on_a_line(before - middle):
        rotation = _smallest_rotation(*(_along(one - one.mean(axis=0)) for one in (before, after)))
    else:
        rotation = best_rotation(before, after)
    result: NDArray[np.float64] = (np.asarray(points, np.float64) - middle) @ rotation + moved
    return result


def _on_a_line(offsets: NDArray) -> bool:
    sizes = np.linalg.svd(offsets, compute_uv=False)
    return len(sizes) < 2 or bool(sizes[1] <= FLAT * max(sizes[0], 1e-30))


def _along(offsets: NDArray) -> NDArray[np.float64]:
    """Unit vector from the first of some positions on a line to the last; 0 where they are one."""
    chord = offsets[-1] - offsets[0]
    unit: NDArray[np.float64] = chord / max(float(np.linalg.norm(chord)), 1e-30)
    return unit


def _smallest_rotation(a: NDArray, b: NDArray) -> NDArray[np.float64]:
    """The smallest rotation of rows from unit vector a to b: two reflections."""
    half = a + b
    if half @ half < 1e-12:
        return np.eye(3)
    half = half / np.linalg.norm(half)
    rotation: NDArray[np.float64] = (np.eye(3) - 2.0 * np.outer(a, a)) @ (np.eye(3) - 2.0 * np.outer(half, half))
    return rotation
