"""Benchmark of cloth: a square sheet that hangs from two corners in wind or, with contact, falls onto a sphere."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from twirl import RADIUS, sphere

from ringlet import Body, Clock, Cloth, ClothMaterial, ClothSolver, Mesh, Scene, Solver, UserError

BALL = 0.3  # radius of the sphere [m]
PHASES = ("pairs", "assemble", "solve", "search", "filter")


def run(
    side: int = 100, newton: int = 2, steps: int = 24, bend: float = 1e-5, fps: float = 24.0, contacts: str = "off"
) -> dict[str, Any]:
    """Simulates a sheet of ``side`` × ``side`` vertices, one metre wide, with a fixed number of iterations.

    newton:   iterations of every step
    bend:     bending stiffness [N m]
    fps:      steps per second, one per frame
    contacts: ``off``: it swings from two corners; ``on``: it falls onto a sphere, with self-contact
    """
    params = {"side": side, "newton": newton, "steps": steps, "bend": bend, "fps": fps, "contacts": contacts}
    if contacts not in ("on", "off"):
        raise UserError(f"bench cloth: contacts is {contacts!r}; must be on or off")
    return onto_a_sphere(params) if contacts == "on" else in_the_wind(params)


def in_the_wind(params: dict[str, Any]) -> dict[str, Any]:
    """Runs the sheet in wind; params: arguments of ``run``."""
    side, newton, steps, bend, fps = (params[name] for name in ("side", "newton", "steps", "bend", "fps"))
    mesh = sheet(side)
    moving = Cloth(mesh, ClothMaterial(bend=bend), np.array([side * (side - 1), side * side - 1]))
    solver = ClothSolver(newton=newton, tolerance=1e-12)  # never reached, so that all iterations are run
    clock = Clock()
    reports = []
    for _ in range(steps):
        with clock("step"):
            report = moving.step(mesh.points, 1 / fps, gravity=(0.0, -9.81, 0.0), wind=(0.5, 0.0, 2.0), solver=solver)
        reports.append(report)
    return clock.result(
        "cloth",
        params,
        per="step",
        warm_up=2,
        vertices=len(mesh.points),
        contacts=0,
        newton=float(np.mean([report["newton"] for report in reports])),
        linear_iterations=float(np.mean([report["linear"] for report in reports])),
        line_search_cuts=int(sum(report["cuts"] for report in reports)),
        nan=int(sum(report["nan"] for report in reports)),
        max_stretch=float(max(report["max_stretch"] for report in reports)),
    )


def onto_a_sphere(params: dict[str, Any]) -> dict[str, Any]:
    """Runs the sheet in contact; params: arguments of ``run``."""
    mesh, (ball, triangles) = sheet(params["side"]), sphere()
    mesh.points = (mesh.points - [0.5, 0.5, 0.0])[:, [0, 2, 1]] + [0.0, BALL + 5e-3, 0.0]
    moving = Cloth(mesh, ClothMaterial(bend=params["bend"], thickness=4e-3))
    scene = Scene(bodies=[Body(BALL / RADIUS * ball, triangles, thickness=2e-3)], cloths=[moving])
    solver, clock, reports, stretches = Solver(newton=params["newton"], tolerance=1e-12), Clock(), [], []
    for _ in range(params["steps"]):
        with clock("step"):
            report, _ = scene.step(None, 1 / params["fps"], gravity=(0.0, -9.81, 0.0), solver=solver)
        reports.append(report)
        stretches.append(scene.cloth_reports[0]["max_stretch"])
    names = ("contacts", "candidates", "violations", "linear_iterations", "newton")
    return clock.result(
        "cloth",
        params,
        per="step",
        warm_up=2,
        vertices=len(mesh.points),
        **{name: float(np.mean([report[name] for report in reports])) for name in names},
        closest=min(report["closest"] for report in reports),
        lag=max(report["lag"] for report in reports),
        max_stretch=max(stretches),
        phases_wall_ms={name: 1e3 * float(np.mean([report[f"time_{name}"] for report in reports])) for name in PHASES},
    )


def sheet(side: int) -> Mesh:
    """A unit square in the plane of x and y [m], cut into squares of two triangles."""
    x, y = np.meshgrid(np.linspace(0, 1, side), np.linspace(0, 1, side))
    corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    triangles: NDArray[np.int32] = np.concatenate(
        [
            np.c_[corner, corner + 1, corner + side + 1],
            np.c_[corner, corner + side + 1, corner + side],
        ]
    ).astype(np.int32)
    return Mesh("sheet", np.c_[x.ravel(), y.ravel(), np.zeros(x.size)], triangles)
