"""Rods of few vertices on the centre lines of locks, as stiff as the coils about them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.spatial import KDTree

from ringlet.data.curves import Curves
from ringlet.motion import HelicalSpring
from ringlet.shot.material import Material
from ringlet.sim.strands import Strands

Array = NDArray[np.float64]

VERTICES = 8
HELD = 3  # vertices of a rod that the head holds, with its frame
HELD_EDGE = 0.02  # length of a held edge, as a fraction of the lock: longer ones would make the rest of the rod stiffer
DEGREE = 5  # of a centre line as a polynomial of the place on the lock
ROOT_WEIGHT = 30.0  # of the root in its fit, relative to other points
NEIGHBOURS, MIDDLE = 6, 5  # of a rod in a crowd, and the vertex that they are near
CROWDED = 2.0  # distance of the last of them in a crowd, in diameters of the coil
LEAST_RISE = 0.05  # sin α of a coil that is closer than any hair's

# A rod of 1 kg/m that is as stiff as its factors say: density, EA and 4π EI are 1.
UNIT = Material().model_copy(
    update={
        "youngs_modulus": 1.0,
        "radius": np.pi**-0.5,
        "density": 1.0,
        "stretch_scale": 1.0,
        "bend_scale": 1.0,
        "twist_ratio": 1.0,
        "limit_twist": False,
        "damping": 1.0,
        "drag": 1.0,
        "correct_resolution": False,
    }
)


@dataclass(frozen=True)
class Wire:
    """What a lock is made of, along its own length; shapes (count,).

    density: mass by length [kg/m]
    pull:    EA [N]
    bend:    EI [N m²]
    twist:   GJ [N m²]
    damping: time of the strains [s]
    drag:    of the air by length [kg/(m s)]
    """

    density: Array
    pull: Array
    bend: Array
    twist: Array
    damping: Array
    drag: Array
    mass_damping: float

    @classmethod
    def of(cls, locks: Curves, material: Material, factors: dict[str, Array], contact: Array | float = 0.0) -> Wire:
        """The mean of each lock's vertices, of compliances where these add up along it.

        factors: on the material at the vertices of the locks, by name as in ``Strands``, shape (n,) each
        contact: EI that neighbours add [N m²]
        """
        lock, counts = np.repeat(np.arange(len(locks)), locks.counts), locks.counts

        def mean(values: Array) -> Array:
            return np.bincount(lock, values, len(locks)) / counts if values.ndim else np.full(len(locks), values)

        def factor(name: str) -> Array:
            return np.asarray(factors.get(name, 1.0), np.float64)

        def stiffness(values: Array) -> Array:
            return 1.0 / mean(1.0 / np.maximum(values, 1e-12))

        area = np.pi * material.radius**2
        bend = material.bend_scale * material.youngs_modulus * area**2 / (4.0 * np.pi)
        pull = material.stretch_scale * material.youngs_modulus * area
        radius2 = factor("radius") ** 2
        wire = bend * stiffness(factor("bend") * radius2**2) + contact
        ratio = np.minimum(material.twist_ratio * mean(factor("twist")), 1.0 if material.limit_twist else np.inf)
        return cls(
            density=material.density * area * mean(radius2),
            pull=pull * stiffness(factor("stretch") * radius2),
            bend=wire,
            twist=np.maximum(ratio, 1e-3) * wire,
            damping=material.damping * mean(factor("damping")),
            drag=material.drag * mean(factor("drag")),
            mass_damping=material.mass_damping,
        )


@dataclass(frozen=True)
class Rods:
    """The rods of locks.

    curves: their vertices as groomed [m], ``VERTICES`` each
    radius: of the coil about each, the root of the mean square [m], shape (count,)
    rise:   length of each by that of its lock, shape (count,)
    """

    curves: Curves
    radius: Array
    rise: Array

    @property
    def points(self) -> Array:
        """The vertices as groomed [m], shape (n, 3)."""
        return np.asarray(self.curves.points, np.float64)

    @classmethod
    def of(cls, locks: Curves) -> Rods:
        """The rod on the centre line of each lock: a polynomial of the place along it, by least squares."""
        count = len(locks)
        vertices, radius, length = np.zeros((count, VERTICES, 3)), np.zeros(count), np.zeros(count)
        of_locks = np.asarray(locks.points, np.float64)
        for points in (counts := np.unique(locks.counts)):
            rows = np.flatnonzero(locks.counts == points)
            of_points = of_locks if len(counts) == 1 else of_locks[locks.point_rows(rows)]
            shape = of_points.reshape(len(rows), points, 3)
            fit, at_points, at_vertices = _bases(int(points))
            coefficients = fit @ shape
            axis = at_points @ coefficients
            vertices[rows] = at_vertices @ coefficients
            radius[rows] = np.sqrt(np.einsum("lpi,lpi->l", away := shape - axis, away) / points)
            length[rows] = np.linalg.norm(np.diff(vertices[rows], axis=1), axis=2).sum(axis=1)
        offsets = VERTICES * np.arange(count + 1, dtype=np.int32)
        curves = Curves(vertices.reshape(-1, 3), offsets, locks.ids)
        return cls(curves, radius, np.clip(length / locks.lengths(), LEAST_RISE, 1.0))

    @cached_property
    def lengths(self) -> Array:
        """Of the rods as groomed [m], shape (count,)."""
        return np.asarray(self.curves.lengths(), np.float64)

    def coil(self, wire: Wire) -> HelicalSpring:
        """The coils of a wire about them."""
        return HelicalSpring(self.radius, self.rise, wire.bend, wire.twist, wire.pull)

    def crowding(self) -> Array:
        """How much each is in a crowd, from 0 alone to 1 where as many others as touch in a crowd are near it."""
        if len(self.curves) <= NEIGHBOURS:
            return np.zeros(len(self.curves))
        middles = self.points.reshape(-1, VERTICES, 3)[:, MIDDLE]
        farthest = np.asarray(KDTree(middles).query(middles, NEIGHBOURS + 1)[0])[:, -1]
        return np.minimum(1.0, (CROWDED * 2.0 * self.radius / np.maximum(farthest, 1e-9)) ** 2)

    def strands(self, wire: Wire, rest: Array | None = None) -> Strands:
        """The rods in motion, as stiff and as heavy as coils of a wire are along their axes.

        rest: their rest shape [m], shape (n, 3); as groomed by default
        """
        curves = self.curves if rest is None else self.curves.with_points(rest)
        coil, bend = self.coil(wire), np.asarray(self.coil(wire).axial_bend)
        density = wire.density / self.rise * self.lengths / curves.lengths()
        factors = {
            "radius": np.sqrt(density),
            "stretch": coil.axial_stretch / density,
            "bend": 4.0 * np.pi * bend / density**2,
            "twist": coil.axial_twist / bend,
            "damping": wire.damping,
            "drag": wire.drag / self.rise,
        }
        return Strands(
            curves,
            UNIT.model_copy(update={"mass_damping": wire.mass_damping}),
            HELD,
            {name: np.repeat(factor, VERTICES) for name, factor in factors.items()},
        )


def places(count: int) -> tuple[NDArray[np.int32], Array]:
    """Of evenly spaced points on a lock, the vertex of its rod before each, and the weight of the one behind; (count,).

    The weight rises smoothly, with no slope at vertices.
    """
    at, vertices = np.linspace(0.0, 1.0, count), vertex_places()
    vertex = np.clip(np.searchsorted(vertices, at, side="right") - 1, 0, VERTICES - 2)
    u = (at - vertices[vertex]) / (vertices[vertex + 1] - vertices[vertex])
    return vertex.astype(np.int32), u * u * (3.0 - 2.0 * u)


def vertex_places() -> Array:
    """Where on a lock the vertices of its rod are, from 0 at the root to 1."""
    held = HELD_EDGE * np.arange(HELD)
    return np.concatenate([held[:-1], np.linspace(held[-1], 1.0, VERTICES - HELD + 1)]).astype(np.float64)


@cache
def _bases(points: int) -> tuple[Array, Array, Array]:
    """Of locks with so many points: the fit of coefficients, and polynomials at points and at vertices."""
    degree = min(DEGREE, points - 1)
    at_points = legendre.legvander(np.linspace(-1.0, 1.0, points), degree).astype(np.float64)
    weights = np.where(np.arange(points) == 0, ROOT_WEIGHT, 1.0)
    fit = np.asarray(np.linalg.pinv(at_points * weights[:, None]) * weights, np.float64)
    return fit, at_points, legendre.legvander(2.0 * vertex_places() - 1.0, degree).astype(np.float64)
