"""What hair wears: meshes that operators put around locks, and that stay with these through later operators."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ringlet.data.accessory import Accessory, carried
from ringlet.data.curves import Curves
from ringlet.data.groom import WORN_MASS, WORN_RADIUS
from ringlet.data.mesh import Mesh
from ringlet.data.pigment import linear_color
from ringlet.groom.operators.operator import UP, Context, arc_lengths, at_lengths, unit

AROUND, ACROSS = 48, 12  # points of a mesh of revolution, and of its profile


@dataclass(frozen=True)
class Worn:
    """A mesh around locks as an operator leaves them.

    mesh:   at the place where it is then [m]; its name is unique in the groom
    ids:    of the locks that carry it, shape (k,)
    parts:  of the length of each, from root (0) to tip (1), where it carries the mesh, shape (k,)
    places: positions there [m], shape (k, 3)
    radii:  distances from these to the outside of the mesh [m], shape (k,); 0: in contact it is as thin as the locks
    mass:   [kg]
    """

    mesh: Mesh
    ids: NDArray[np.int64]
    parts: NDArray[np.float64]
    places: NDArray[np.float64]
    radii: NDArray[np.float64]
    mass: float = 0.0

    @classmethod
    def around(cls, mesh: Mesh, curves: Curves, rows: NDArray[np.integer], parts: NDArray[np.floating]) -> Worn:
        """A mesh that locks carry at some parts of their length, each at all of them."""
        ids, each = np.repeat(curves.ids[rows], len(parts)), np.tile(np.asarray(parts, np.float64), len(rows))
        return cls(mesh, ids, each, _places(curves, ids, each)[0], np.zeros(len(ids)))


def accessories(worn: Iterable[Worn], locks: Curves) -> list[Accessory]:
    """What the locks of a finished groom wear, where these have it now."""
    made = []
    for one in worn:
        places, vertices = _places(locks, one.ids, one.parts)
        points = carried(one.mesh.points, one.places, places)
        made.append(Accessory(replace(one.mesh, points=points), np.unique(vertices)))
    return made


def loaded(worn: Iterable[Worn], locks: Curves) -> Curves:
    """The locks with the masses and radii of what they wear, lumped at their nearest points: ``WORN_MASS`` and
    ``WORN_RADIUS`` where there are any."""
    mass, radius = np.zeros(len(locks.points), np.float32), np.zeros(len(locks.points), np.float32)
    for one in worn:
        vertices = _places(locks, one.ids, one.parts)[1]
        np.add.at(mass, vertices, one.mass / len(vertices))
        np.maximum.at(radius, vertices, one.radii.astype(np.float32))
    if not (mass.any() or radius.any()):
        return locks
    return replace(locks, point={**locks.point, WORN_MASS: mass, WORN_RADIUS: radius})


def revolved(name: str, middle: NDArray, axis: NDArray, profile: NDArray, color: tuple[float, float, float]) -> Mesh:
    """A closed mesh of revolution about a unit axis through a middle [m].

    profile: distance from the axis and height along it [m], anticlockwise around the solid, shape (k, 2)
    """
    across = unit(np.cross(axis, np.eye(3)[np.abs(axis).argmin()]) if abs(axis @ UP) > 0.99 else np.cross(UP, axis))
    angle = np.linspace(0.0, 2.0 * np.pi, AROUND, endpoint=False)
    out = np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * np.cross(axis, across)
    points = middle + profile[None, :, :1] * out[:, None] + profile[None, :, 1:] * axis
    count = len(profile)
    i, j = np.meshgrid(np.arange(AROUND), np.arange(count), indexing="ij")
    i1, j1 = (i + 1) % AROUND, (j + 1) % count
    corner = [(p * count + q).ravel() for p, q in ((i, j), (i1, j), (i1, j1), (i, j1))]
    triangles = np.concatenate([np.stack([corner[0], corner[k], corner[k + 1]], axis=1) for k in (1, 2)])
    return Mesh(name, points.reshape(-1, 3), triangles.astype(np.int32), color=color)


def volume(mesh: Mesh) -> float:
    """Volume inside a closed mesh [m³]."""
    a, b, c = np.asarray(mesh.points, np.float64)[mesh.triangles].transpose(1, 0, 2)
    return float(np.sum(a * np.cross(b, c))) / 6.0


def ring(radius: float, width: float, height: float, roundness: float = 1.0) -> NDArray[np.float64]:
    """Profile of a ring around a hole of a radius, so wide and high [m]: an ellipse, squarer with less roundness."""
    angle = np.linspace(0.0, 2.0 * np.pi, ACROSS, endpoint=False)
    x, y = (np.sign(c) * np.abs(c) ** roundness for c in (np.cos(angle), np.sin(angle)))
    return np.stack([radius + 0.5 * width * (1.0 + x), 0.5 * height * y], axis=1)


def ball(width: float, hole: float) -> NDArray[np.float64]:
    """Profile of a ball of a width around a hole of another [m]."""
    last = np.arccos(hole / width)
    angle = np.linspace(-last, last, ACROSS)
    return 0.5 * width * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def chosen_color(colors: Sequence[str], name: str, context: Context) -> tuple[float, float, float]:
    """The linear one of some colours for what is worn under a name, at random."""
    chance = float(context.random(f"color of {name}").uniform(np.zeros(1, np.int64))[0])
    red, green, blue = linear_color(colors[int(chance * len(colors))]).tolist()
    return red, green, blue


def _places(curves: Curves, ids: NDArray, parts: NDArray) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Positions at parts of locks [m], shape (k, 3), and the nearest of their points, shape (k,)."""
    order = np.argsort(curves.ids, kind="stable")
    rows = order[np.searchsorted(curves.ids, ids, sorter=order)]
    points = curves.points.reshape(len(curves), -1, 3)[rows]
    run = arc_lengths(points)
    along = parts * run[:, -1]
    nearest = np.abs(run - along[:, None]).argmin(axis=1)
    return np.asarray(at_lengths(points, along[:, None])[:, 0], np.float64), curves.offsets[rows] + nearest
