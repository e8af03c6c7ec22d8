"""The obstacles of cosseratbench as bodies."""

from __future__ import annotations

import numpy as np
from cosseratbench.scenario import Cylinder, Obstacle, Plane, Scenario  # pyright: ignore[reportMissingImports]
from numpy.typing import NDArray

from ringlet.sim.obstacle import Body
from ringlet.validate.cosserat_bench.rods import unit

ROUND = 1e-3  # how far the facets of a cylinder leave its surface, in radii of the rods
WIDE = 100.0  # size of a plane, in lengths of the longest rod


def _across(axis: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Two unit vectors that make a right-handed frame with a unit axis."""
    first = unit(np.asarray(np.cross(axis, np.eye(3)[np.abs(axis).argmin()]), np.float64))
    return first, np.asarray(np.cross(axis, first), np.float64)


def _plane(plane: Plane, scenario: Scenario, friction: float) -> Body:
    """A triangle below the rods."""
    normal = plane.unit_normal
    first, second = _across(normal)
    point = np.asarray(plane.point, float)
    middle = np.mean([np.mean(rod.centerline, axis=0) for rod in scenario.rods], axis=0)
    foot = middle - ((middle - point) @ normal) * normal
    size = WIDE * max(rod.length for rod in scenario.rods)
    turns = 2.0 * np.pi * np.arange(3) / 3
    points = foot + size * (np.outer(np.cos(turns), first) + np.outer(np.sin(turns), second))
    return Body(points, np.array([[0, 1, 2]]), 0.0, friction)


def _cylinder(cylinder: Cylinder, scenario: Scenario, friction: float) -> Body:
    """A prism whose corners are on the cylinder, with its two ends."""
    rod_radius = min(rod.radius for rod in scenario.rods)
    sides = int(np.ceil(np.pi / np.sqrt(2.0 * ROUND * rod_radius / cylinder.radius)))
    axis = cylinder.unit_axis
    first, second = _across(axis)
    k, turns = np.arange(sides), 2.0 * np.pi * np.arange(sides) / sides
    ring = cylinder.radius * (np.outer(np.cos(turns), first) + np.outer(np.sin(turns), second))
    half = 0.5 * cylinder.length * axis
    points = np.asarray(cylinder.center, float) + np.concatenate([ring - half, ring + half, [-half, half]])
    after = np.roll(k, -1)
    triangles = [
        np.c_[k, after, after + sides],
        np.c_[k, after + sides, k + sides],
        np.c_[after, k, np.full(sides, 2 * sides)],
        np.c_[k + sides, after + sides, np.full(sides, 2 * sides + 1)],
    ]
    return Body(points, np.concatenate(triangles), 0.0, friction)


def bodies(scenario: Scenario) -> list[Body]:
    """The obstacles of a scenario; the larger coefficient of friction of obstacle and rods applies."""
    of_rods = max(rod.friction for rod in scenario.rods)

    def body(obstacle: Obstacle) -> Body:
        make = _plane if isinstance(obstacle, Plane) else _cylinder
        return make(obstacle, scenario, max(obstacle.friction, of_rods))

    return [body(obstacle) for obstacle in scenario.obstacles]
