"""Benchmark of strands with cloth: a sheet of cloth falls onto curls on a ball, all in contact."""

from __future__ import annotations

from typing import Any

import numpy as np
from cloth import sheet
from twirl import RADIUS, sphere

from ringlet import Body, Clock, Cloth, ClothMaterial, Contact, Curves, Material, Scene, Solver, Strands, solver_counts

WIDTH = 0.4  # width of the sheet [m]


def run(
    strands: int = 200, points: int = 40, side: int = 40, newton: int = 5, steps: int = 24, fps: float = 24.0
) -> dict[str, Any]:
    """Simulates a sheet of ``side`` × ``side`` vertices that falls onto ``strands`` curls on a ball.

    points: points of each curl
    newton: iteration limit of every step
    fps:    steps per second, one per frame
    """
    curls, (ball, triangles) = grown(strands, points), sphere()
    moving = Strands(curls, Material(bend_scale=6.0, damping=0.004), 3)
    falling = sheet(side)
    falling.points = WIDTH * (falling.points - [0.5, 0.5, 0.0])[:, [0, 2, 1]] + [0.0, RADIUS + 0.07, 0.0]
    cloth = Cloth(falling, ClothMaterial(thickness=2e-3))
    body = Body(ball, triangles)
    scene = Scene(moving, [body], Contact(radius=4e-4), np.zeros(strands, int), [cloth])
    solver = Solver(newton=newton)
    clock, reports, contacts = Clock(), [], []
    for _ in range(steps):
        with clock("step"):
            contact, report = scene.step(None, 1 / fps, gravity=(0.0, -9.81, 0.0), solver=solver)
        reports.append(report)
        contacts.append(contact)
    return clock.result(
        "mixed",
        {"strands": strands, "points": points, "side": side, "newton": newton, "steps": steps, "fps": fps},
        per="step",
        warm_up=2,
        vertices=len(scene.positions),
        **solver_counts(reports, contacts),
        lag=max(contact["lag"] for contact in contacts),
        cloth_stretch=scene.cloth_reports[0]["max_stretch"],
    )


def grown(count: int, points: int) -> Curves:
    """Curls of 6 cm on the upper half of the ball, on a golden-angle spiral."""
    k = np.arange(count)
    up, azimuth = 1.0 - k / count, k * np.pi * (3.0 - np.sqrt(5.0))
    normal = np.stack([np.sqrt(1 - up**2) * np.cos(azimuth), up, np.sqrt(1 - up**2) * np.sin(azimuth)], axis=1)
    side = np.cross(normal, [0.6, 0.0, 0.8])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    t = np.linspace(0.0, 1.0, points)
    width = 0.004 * np.clip(4 * t, 0.0, 1.0)
    curls = []
    for direction, across, turn in zip(normal, side, k, strict=True):
        other, angle = np.cross(direction, across), 2 * np.pi * points / 12 * t + turn
        curl = width[:, None] * (np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * other)
        curls.append((RADIUS + 0.06 * t)[:, None] * direction + curl)
    return Curves.from_list(curls)
