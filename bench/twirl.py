"""The scene that published strand solvers are compared on: tight 4C wisps on a sphere that is twirled."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ringlet import Clock, Curves, Material, Solver, Strands, UserError, solver_counts

FPS = 30.0
HELD = 4  # the vertices of a wisp inside the sphere's surface


def run(strands: int = 256, contacts: Literal["off"] = "off", newton: int = 3, steps: int = 90) -> dict[str, Any]:
    """Twirls ``strands`` wisps of 101 vertices, 5 a turn, at 30 steps per second.

    40 frames of rest, then 50 about each of ±z, ±y, ±x.

    contacts: ``off``: wisps pass through one another and through the sphere
    newton:   iterations of every step
    steps:    how many of the scene's 340 frames are run
    """
    if contacts != "off":
        raise UserError(f"bench twirl: contacts is {contacts}; must be off: there is no contact yet")
    wisps = groom(strands)
    curves = Curves.from_list(wisps)
    moving = Strands(curves, Material(damping=0.0, drag=0.0), HELD)
    solver = Solver(newton=newton, tolerance=1e-12)  # never reached: all iterations are spent
    clock = Clock()
    reports = []
    turned = np.eye(3)
    for step in range(steps):
        turned = turn(step) @ turned
        # Not with @: the threads of the matrix library would wait actively, on the processors that are timed.
        targets = np.einsum("ij,kj->ik", curves.points, turned)
        with clock("step"):
            reports.append(moving.step(targets, 1 / FPS, gravity=(0.0, -9.81, 0.0), solver=solver))
    return clock.result(
        "twirl",
        {"strands": strands, "contacts": contacts, "newton": newton, "steps": steps},
        per="step",
        warm_up=2,
        strands=strands,
        vertices=len(curves.points),
        **solver_counts(reports),
    )


def wisp() -> NDArray[np.float64]:
    """The 4C wisp: radius and pitch 5 mm, straight at its root; positions [m], shape (101, 3), axis along y."""
    k = np.arange(2, 100)
    angle = 0.4 * np.pi * k
    coil = np.c_[-0.5 * np.cos(angle), 15 + 0.1 * k, 0.5 * np.sin(angle)]
    return 0.01 * np.concatenate([[(-1, 14, 0), (0, 14, 0), (0, 15, 0)], coil])


def groom(count: int, seed: int = 1) -> list[NDArray[np.float64]]:
    """``count`` wisps on the upper half of the sphere, their roots kept apart, each spun about its own axis."""
    random = np.random.default_rng(seed)
    apart = 0.05 if count <= 1000 else 0.04
    roots: list[NDArray[np.float64]] = []
    while len(roots) < count:
        azimuth, height = random.uniform(0, 2 * np.pi), random.uniform(0, 1)
        level = np.sqrt(1 - height**2)
        root = np.array([level * np.cos(azimuth), height, level * np.sin(azimuth)])
        if not roots or np.linalg.norm(np.array(roots) - root, axis=1).min() > apart:
            roots.append(root)
    return [wisp() @ (to_direction(root) @ about((0, 1, 0), random.uniform(0, 2 * np.pi))).T for root in roots]


def to_direction(direction: NDArray[np.float64]) -> NDArray[np.float64]:
    """The smallest rotation that takes +y to a unit direction of the upper half."""
    x, y, z = direction
    axis = np.array([z, 0.0, -x])
    sine = np.linalg.norm(axis)
    return about(axis / sine, np.arctan2(sine, y)) if sine > 1e-12 else np.eye(3)


def turn(step: int) -> NDArray[np.float64]:
    """How the sphere turns in one frame: 0.15 cos(0.6 π t) rad about the axis of that part of the scene."""
    if step < 40:
        return np.eye(3)
    part, frame = divmod(step - 40, 50)
    axis = ((0, 0, 1), (0, 0, -1), (0, 1, 0), (0, -1, 0), (1, 0, 0), (-1, 0, 0))[part % 6]
    return about(axis, 0.15 * np.cos(0.6 * np.pi * frame / FPS))


def about(axis: Any, angle: float) -> NDArray[np.float64]:
    """Rotation matrix (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
