"""Benchmark scene of published strand solvers: tight 4C wisps on a twirling sphere."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ringlet import Body, Clock, Contact, Curves, Material, Scene, Solver, Strands, UserError, solver_counts

FPS = 30.0
GRAVITY = (0.0, -9.81, 0.0)
PRESCRIBED = 4  # vertices of a wisp below the sphere's surface
RADIUS = 0.1525  # radius of the published sphere [m]
DISTANCE = math.sqrt(2) * 1e-3  # activation distance of contact [m]
SPACING = 4  # distance of neighbouring heads [radii]


def run(
    strands: int = 256,
    contacts: Literal["on", "off"] = "off",
    friction: float = 0.3,
    newton: int = 3,
    extra: int = 60,
    steps: int = 90,
    radius: float = RADIUS,
    heads: int = 1,
) -> dict[str, Any]:
    """Twirls ``strands`` wisps of 101 vertices, 5 a turn, at 30 steps per second.

    40 frames of rest, then 50 about each of ±z, ±y, ±x.

    contacts: ``on``: wisps collide with each other and the sphere; ``off``: without contact
    friction: coefficient of friction; 0 in the published scene
    newton:   iterations of every step
    extra:    further iterations for stretched strands whose motion was limited; none in the published code
    steps:    number of frames, of the scene's 340
    radius:   radius of the sphere [m]; a larger one turns slower, so that roots have the same speed
    heads:    spheres in a row without mutual contact; the wisps are divided evenly
    """
    if contacts not in ("on", "off"):
        raise UserError(f"bench twirl: contacts is {contacts}; must be on or off")
    if not radius > 0:
        raise UserError(f"bench twirl: radius is {radius}; must be positive")
    if not 1 <= heads <= strands:
        raise UserError(f"bench twirl: heads is {heads}; must be from 1 to {strands}, the strands")
    scale = radius / RADIUS
    crowds = [(strands + head) // heads for head in range(heads)]
    wisps = [groom(crowd, scale, seed=1 + head) for head, crowd in enumerate(crowds)]
    centres = SPACING * radius * np.arange(heads)[:, None] * (1, 0, 0)
    curves = Curves.from_list(
        [points + centre for grown, centre in zip(wisps, centres, strict=True) for points in grown]
    )
    moving = Strands(curves, Material(damping=0.0, drag=0.0), PRESCRIBED)
    solver = Solver(newton=newton, extra=extra, tolerance=1e-12)  # never reached, so that all iterations are run
    ball, triangles = sphere(radius, max(round(32 * scale), 4))
    bodies = [Body(ball + centre, triangles, DISTANCE / 2, friction) for centre in centres]
    contact = Contact(radius=DISTANCE / 2, friction=friction)
    scene = Scene(moving, bodies, contact, np.repeat(np.arange(heads), crowds))
    clock = Clock()
    reports, contact_reports = [], []
    rotation = np.eye(3)
    hair = [np.concatenate(grown) for grown in wisps]
    for step in range(steps):
        rotation = turn(step, scale) @ rotation
        targets = np.concatenate([rotate(points, rotation) + c for points, c in zip(hair, centres, strict=True)])
        moved_bodies = [rotate(ball, rotation) + centre for centre in centres]
        with clock("step"):
            if contacts == "on":
                contact_report, report = scene.step(
                    targets, 1 / FPS, bodies=moved_bodies, gravity=GRAVITY, solver=solver
                )
                contact_reports.append(contact_report)
            else:
                report = moving.step(targets, 1 / FPS, gravity=GRAVITY, solver=solver)
            reports.append(report)
    return clock.result(
        "twirl",
        {
            "strands": strands,
            "contacts": contacts,
            "friction": friction,
            "newton": newton,
            "extra": extra,
            "steps": steps,
            "radius": radius,
            "heads": heads,
        },
        per="step",
        warm_up=2,
        strands=strands,
        vertices=len(curves.points),
        **solver_counts(reports, contact_reports),
    )


def sphere(radius: float = RADIUS, rings: int = 32) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """A UV sphere: points [m], and triangles counter-clockwise from outside."""
    sides = 2 * rings
    polar = np.linspace(0, np.pi, rings + 1)[1:-1, None]
    around = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    ring = np.stack([np.sin(polar) * np.sin(around), np.cos(polar) + 0 * around, np.sin(polar) * np.cos(around)], -1)
    points = radius * np.concatenate([[[0, 1, 0]], ring.reshape(-1, 3), [[0, -1, 0]]])
    last, k = len(points) - 1, np.arange(sides)
    after = (k + 1) % sides
    triangles = [np.c_[0 * k, 1 + k, 1 + after], np.c_[0 * k + last, last - sides + after, last - sides + k]]
    for row in range(rings - 2):
        a, b = 1 + row * sides + k, 1 + row * sides + after
        triangles += [np.c_[a, a + sides, b + sides], np.c_[a, b + sides, b]]
    return points, np.concatenate(triangles).astype(np.int32)


def wisp() -> NDArray[np.float64]:
    """The 4C wisp along y: radius and pitch 5 mm, straight at its root; positions [m], shape (101, 3)."""
    k = np.arange(2, 100)
    angle = 0.4 * np.pi * k
    coil = np.c_[-0.5 * np.cos(angle), 15 + 0.1 * k, 0.5 * np.sin(angle)]
    return 0.01 * np.concatenate([[(-1, 14, 0), (0, 14, 0), (0, 15, 0)], coil])


def groom(count: int, scale: float = 1, seed: int = 1) -> list[NDArray[np.float64]]:
    """``count`` wisps on the upper half of a sphere ``scale`` times as large as the published one.

    Roots have a minimum distance; each wisp has a random rotation about its own axis.
    """
    random = np.random.default_rng(seed)
    min_distance = (0.05 if count <= 1000 * scale**2 else 0.04) / scale
    upright = wisp() + [0, (scale - 1) * RADIUS, 0]
    roots: list[NDArray[np.float64]] = []
    while len(roots) < count:
        azimuth, height = random.uniform(0, 2 * np.pi), random.uniform(0, 1)
        level = np.sqrt(1 - height**2)
        root = np.array([level * np.cos(azimuth), height, level * np.sin(azimuth)])
        if not roots or np.linalg.norm(np.array(roots) - root, axis=1).min() > min_distance:
            roots.append(root)
    return [upright @ (to_direction(root) @ about((0, 1, 0), random.uniform(0, 2 * np.pi))).T for root in roots]


def to_direction(direction: NDArray[np.float64]) -> NDArray[np.float64]:
    """The smallest rotation from +y to a unit direction of the upper half."""
    x, y, z = direction
    axis = np.array([z, 0.0, -x])
    sine = np.linalg.norm(axis)
    return about(axis / sine, np.arctan2(sine, y)) if sine > 1e-12 else np.eye(3)


def turn(step: int, scale: float = 1) -> NDArray[np.float64]:
    """Rotation of a sphere ``scale`` times as large in one frame: 0.15 / scale cos(0.6 π t) rad about an axis."""
    if step < 40:
        return np.eye(3)
    phase, frame = divmod(step - 40, 50)
    axis = ((0, 0, 1), (0, 0, -1), (0, 1, 0), (0, -1, 0), (1, 0, 0), (-1, 0, 0))[phase % 6]
    return about(axis, 0.15 / scale * np.cos(0.6 * np.pi * frame / FPS))


def rotate(points: NDArray[np.float64], rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotates points about the origin, shape (n, 3).

    Without @: threads of the BLAS library would spin on the processors that are timed.
    """
    return np.einsum("ij,kj->ik", points, rotation)


def about(axis: Any, angle: float) -> NDArray[np.float64]:
    """Rotation matrix about a unit axis by an angle [rad] (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
