"""Binds a groom anew to a head that has changed since."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.binding import root_places
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.data.mesh import Mesh
from ringlet.data.rigid import best_rotation
from ringlet.groom.several import with_each

SAME_SURFACE = 0.1  # largest deviation of roots from a similar arrangement, relative to its size
NEAR = 0.01  # farthest from a new surface that a root is bound to it [m]

Array = NDArray[np.float64]


class Similarity(NamedTuple):
    """A rotation of row vectors with a scale, which takes a centre to another one."""

    turn: Array
    scale: float
    before: Array
    after: Array

    def of(self, points: NDArray[np.floating]) -> Array:
        """The places of points, shape (n, 3)."""
        return self.scale * (np.asarray(points, np.float64) - self.before) @ self.turn + self.after


def rebind(groom: Groom) -> Groom:
    """The groom on its scalp as that is now: each lock begins on its root, turned as the roots are, of the same shape.

    Roots keep triangle and weights where the mesh was moved, turned, scaled or sculpted, and curves without roots are
    moved as these are. On another mesh they go to the nearest place. Raises UserError where that is farther than 1 cm.
    """
    moved = _motion(groom.locks, groom.scalp)
    if moved is None and groom.grooms:
        return with_each(groom, rebind)
    if moved is None and groom.offsets is not None:
        raise UserError(
            f"rebind: {groom.scalp.name} is another mesh than that of the adopted hair; adopt it again: "
            "ringlet adopt HAIR --head FILE"
        )
    if moved is None:
        locks, guides = (_on_nearest(curves, groom) for curves in (groom.locks, groom.guides))
    else:
        locks, guides = (
            _moved(c, moved.of(c.roots) if (places := _places(c, groom.scalp)) is None else places, moved.turn)
            for c in (groom.locks, groom.guides)
        )
    worn = [accessory.moved(groom.locks.points, locks.points) for accessory in groom.accessories]
    return replace(groom, locks=locks, guides=guides, accessories=worn)


def _places(curves: Curves, scalp: Mesh) -> Array | None:
    """The places of the roots on the scalp; None where a root has none, or a wrong one."""
    if not {"root_triangle", "root_barycentric"} <= curves.curve.keys():
        return None
    triangle = curves.curve["root_triangle"]
    if ((triangle < 0) | (triangle >= len(scalp.triangles))).any():
        return None
    return root_places(curves, scalp.points, scalp.triangles)


def _motion(locks: Curves, scalp: Mesh) -> Similarity | None:
    """The motion of the roots to their places on the scalp; None where these are no similar arrangement."""
    if (places := _places(locks, scalp)) is None:
        return None
    roots = np.asarray(locks.roots, np.float64)
    turn, centres = best_rotation(roots, places), (roots.mean(axis=0), places.mean(axis=0))
    turned, after = (roots - centres[0]) @ turn, places - centres[1]
    size = np.sqrt((after**2).sum())
    moved = Similarity(turn, float((turned * after).sum() / max((turned**2).sum(), 1e-300)), *centres)
    return moved if np.sqrt(((moved.of(roots) - places) ** 2).sum()) <= SAME_SURFACE * size else None


def _on_nearest(curves: Curves, groom: Groom) -> Curves:
    scalp = groom.scalp
    region = np.ascontiguousarray(scalp.region(groom.region), np.int32)
    roots = np.ascontiguousarray(curves.roots, np.float64)
    triangle, weights, distance = _core.bind_roots(scalp.points, scalp.triangles, roots, region)
    if distance.max() > NEAR:
        raise UserError(
            f"rebind: the root of lock {curves.ids[distance.argmax()]} is {distance.max():.3g} m from {scalp.name}, "
            f"which is another mesh; at most {NEAR:g} m is allowed: make the groom again from its recipe"
        )
    bound = replace(curves, curve={**curves.curve, "root_triangle": triangle, "root_barycentric": weights})
    return _moved(bound, root_places(bound, scalp.points, scalp.triangles), np.eye(3))


def _moved(curves: Curves, places: Array, turn: Array) -> Curves:
    """Curves moved rigidly, each to its root's place."""
    counts = curves.counts
    from_root = curves.points - np.repeat(curves.roots, counts, axis=0)
    return curves.with_points(from_root @ turn + np.repeat(places, counts, axis=0))
