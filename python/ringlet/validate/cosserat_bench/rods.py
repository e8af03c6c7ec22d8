"""The rods of a scenario of cosseratbench as strands, and what is given of their motion."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from cosseratbench.scenario import End, Motion, Rod, Scenario  # pyright: ignore[reportMissingImports]
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.shot.material import Material
from ringlet.sim.strands import Strands
from ringlet.validate.cosserat_bench.ends import fitting

Points = NDArray[np.float64]
FACTORS = ("radius", "stretch", "bend", "twist")


class Driven(NamedTuple):
    """An end that is moved.

    node:     row of the end node
    vertices: rows of the vertices that move with it
    edge:     row of the edge whose director turns with it
    """

    motion: Motion
    node: int
    vertices: slice
    edge: int


class RodStrand:
    """One rod as a strand whose vertices are the nodes of the rod and those of its ends (see ``ends.py``).

    nodes:     rows of the rod's nodes
    elements:  rows of its elements, by their first vertices
    free_root: whether the first vertex follows the first element
    start:     positions at the start [m], shape (n, 3)
    rest:      and in the straight rest shape
    held:      which vertices are held, shape (n,)
    factors:   on the material by vertex, one row for each of ``FACTORS``, shape (4, n)
    forces:    loads [N], shape (n, 3)
    driven:    the ends that are moved
    """

    def __init__(self, rod: Rod, count: int) -> None:
        self.rod = rod
        before, after = fitting(rod, End.START), fitting(rod, End.END)
        along = np.concatenate([-np.array(before.extras[::-1]), np.arange(count + 1), count + np.array(after.extras)])
        along *= rod.length / count
        first, last = len(before.extras), len(before.extras) + count
        self.nodes, self.elements = slice(first, last + 1), slice(first, last)
        self.free_root = not (before.held or before.framed)

        nodes = rod.nodes(count)
        tangents = unit(np.diff(nodes, axis=0))
        start = [nodes[0] + np.outer(along[:first], tangents[0]), nodes]
        self.start = np.concatenate([*start, nodes[-1] + np.outer(along[last + 1 :] - along[last], tangents[-1])])
        self.rest = np.outer(along, (1.0, 0.0, 0.0))

        self.held = np.ones(len(along), bool)
        self.held[self.nodes] = False
        self.held[first], self.held[last] = before.held, after.held
        self.factors = np.ones((len(FACTORS), len(along)))
        for end, node, next_to_it in ((before, first, first - 1), (after, last, last + 1)):
            for row, changes in ((node, end.node), (next_to_it, end.first)):
                for name, factor in changes.items():
                    self.factors[FACTORS.index(name), row] = factor
        self.forces = np.zeros_like(self.start)
        for load in rod.loads:
            self.forces[first if load.at is End.START else last] += load.force
        self.driven: list[Driven] = []
        if rod.start_motion is not None:
            self.driven.append(Driven(rod.start_motion, first, slice(0, first + 1), first - 1))
        if rod.end_motion is not None:
            self.driven.append(Driven(rod.end_motion, last, slice(last, None), len(along) - 2))

    def targets(self, time: float, ahead: Points) -> Points:
        """Positions of the held vertices at a time [m], shape (n, 3).

        ahead: where all vertices are then, if they keep their velocities [m], shape (n, 3)
        """
        targets = self.start.copy()
        if self.free_root:  # continues the first element
            targets[0] = 2.0 * ahead[1] - ahead[2]
        for motion, node, vertices, _ in self.driven:
            at = self.start[node]
            displacement, rotation = motion.pose(time)
            if motion.slides_along is not None:
                displacement = displacement + motion.axis * (motion.axis @ (ahead[node] - at))
            targets[vertices] = at + displacement + (self.start[vertices] - at) @ rotation.T
        return targets

    def turn(self, directors: Points, at_start: Points, now: Points, targets: Points, time: float) -> None:
        """Sets the directors of driven ends so that a step to ``targets`` takes them to those of a time [s]."""
        for motion, _, _, edge in self.driven:
            here, there = (unit(points[edge + 1] - points[edge]) for points in (now, targets))
            directors[edge] = transported(motion.pose(time)[1] @ at_start[edge], there, here)

    def frames(self, positions: Points, directors: Points) -> tuple[Points, Points]:
        """Two unit vectors across each element, shapes (count, 3): its director, and tangent × director."""
        tangents = unit(np.diff(positions[self.nodes], axis=0))
        own = directors[self.elements]
        own = unit(own - np.sum(own * tangents, axis=1, keepdims=True) * tangents)
        return own, np.cross(tangents, own)


class RodStrands:
    """All rods of a scenario as strands of one material, with its decay of velocities [1/s].

    Raises NotImplementedError where rods differ in what the strands of a scene share.
    """

    def __init__(self, scenario: Scenario, count: int, decay: float) -> None:
        rods = scenario.rods
        for name in ("material", "radius", "friction"):
            if len({getattr(rod, name) for rod in rods}) > 1:
                raise NotImplementedError(f"rods that differ in {name}")
        self.rods = [RodStrand(rod, count) for rod in rods]
        self.strands = Strands(
            Curves.from_list([rod.rest for rod in self.rods]),
            _material(rods[0], decay),
            np.concatenate([rod.held for rod in self.rods]),
            dict(zip(FACTORS, np.concatenate([rod.factors for rod in self.rods], axis=1), strict=True)),
        )
        self.strands.place(np.concatenate([rod.start for rod in self.rods]))
        self.forces = np.concatenate([rod.forces for rod in self.rods])
        self._at_start = self.strands.directors.copy()
        # Between the core's directors and the scenario's; it does not change.
        self._angles = [
            _angles(rod.frames(positions, directors), rod.rod.directors(count))
            for rod, positions, directors in self._each(self.strands.positions, self.strands.directors)
        ]

    def _each(self, *arrays: Points) -> Iterator[tuple[Any, ...]]:
        """Each rod with its rows of arrays over all vertices."""
        offsets = self.strands.curves.offsets
        for rod, first, end in zip(self.rods, offsets, offsets[1:], strict=False):
            yield rod, *(array[first:end] for array in arrays)

    def targets(self, time: float, dt: float) -> Points:
        """Turns the clamps for a step of ``dt`` [s] to a time; returns the targets of the step [m], shape (n, 3)."""
        now, directors = self.strands.positions, self.strands.directors
        ahead = now + dt * self.strands.velocities
        targets = np.concatenate([rod.targets(time, own) for rod, own in self._each(ahead)])
        for rod, *own in self._each(directors, self._at_start, now, targets):
            rod.turn(*own, time)
        return targets

    @property
    def state(self) -> list[tuple[Points, Points]]:
        """Positions of nodes [m] and directors of elements of each rod, shapes (count + 1, 3) and (count, 3)."""
        found = []
        each = self._each(self.strands.positions, self.strands.directors)
        for angles, (rod, positions, directors) in zip(self._angles, each, strict=True):
            first, second = rod.frames(positions, directors)
            found.append((positions[rod.nodes].copy(), np.cos(angles) * first + np.sin(angles) * second))
        return found


def unit(vectors: Points) -> Points:
    """Unit vectors along the last axis."""
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True), np.float64)


def transported(across: Points, before: Points, after: Points) -> Points:
    """A vector across the unit tangent ``before``, turned by the smallest rotation that takes it to ``after``."""
    share = float(across @ after) / (1.0 + float(before @ after))
    return across - share * (before + after)


def _angles(frames: tuple[Points, Points], directors: Points) -> Points:
    """Angle of each director from the first of its frame towards the second [rad], shape (count, 1)."""
    first, second = (np.sum(directors * axis, axis=1, keepdims=True) for axis in frames)
    return np.arctan2(second, first)


def _material(rod: Rod, decay: float) -> Material:
    return Material(
        youngs_modulus=rod.material.youngs_modulus,
        radius=rod.radius,
        density=rod.material.density,
        stretch_scale=1.0,
        limit_twist=False,
        twist_ratio=2.0 * rod.material.shear_modulus / rod.material.youngs_modulus,  # GJ / EI of a circle
        damping=0.0,
        mass_damping=decay,
        drag=0.0,
        correct_resolution=False,
    )
