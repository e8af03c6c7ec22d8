"""What keeps things apart, and what keeps them from sliding."""

from __future__ import annotations

import numpy as np
from ringlet.curves import Curves
from ringlet.shot import Body, Contact, Material, Scene, Strands
from ringlet.validate import friction as coulomb

from theory.answer import Answer, Panel

DISTANCE, STEP = 1e-3, 1 / 240  # [m] at which contact begins, [s]


def barrier() -> Answer:
    """A strand that lies on the ground and is pressed down ever harder."""
    x = 5e-3 * np.arange(12)
    points = np.c_[x, np.full_like(x, 0.9 * DISTANCE), 0 * x]
    soft = np.where(x < 7e-3, 1e-14, 1.0)  # its root is held, but by an edge so soft that the rest of it is free
    ground = Body(np.array([[-2.0, 0, 4], [-2, 0, -4], [8, 0, 0]]), np.array([[0, 1, 2]]), DISTANCE / 2, 0.0)
    presses, gaps = np.geomspace(0.05, 10.0, 9), []
    for press in presses:
        strands = Strands(Curves.from_list([points]), Material(drag=0.0), 1, {"stretch": soft, "bend": soft})
        scene = Scene(strands, [ground], Contact(radius=DISTANCE / 2))
        middle, length = 6, 5e-3
        stretch, bend, _ = strands.stiffness
        k = strands.masses[middle] / STEP**2 + bend[middle] / length**2 + 0.1 * stretch[middle]
        gravity = press * k * DISTANCE / strands.masses[middle]
        for _ in range(100):
            scene.step(points, STEP, gravity=(0.0, -gravity, 0.0), solver=coulomb.SOLVER)
            strands.velocities[:] = 0.0
        gaps.append(strands.positions[middle, 1] / DISTANCE)
    between = np.geomspace(presses[-1], presses[0], 100)
    exact = np.where(between < 0.5, 1 - between, 0.25 / between)
    return Answer(
        [Panel("force / k r", "gap / r", {"by formula": (between, exact)}, {"by formula": (presses, gaps)}, log=True)],
        [
            (f"gap / r under {press:.3g} k r", 1 - press if press < 0.5 else 0.25 / press, gap)
            for press, gap in zip(presses, gaps, strict=True)
        ],
    )


def friction() -> Answer:
    """A strand on a slope, and one round a drum that turns."""
    rows, exact, got = [], {}, {}
    for mu in (0.2, 0.5):
        slopes, name = mu + np.array([0.1, 0.25, 0.5]), f"μ = {mu}"
        between = np.linspace(0.0, 1.0, 101)
        angle = np.arctan(between)
        pull = coulomb.GRAVITY * (np.sin(angle) - mu * np.cos(angle))
        found = [coulomb.acceleration(mu, float(slope)) for slope in slopes]
        stuck = coulomb.acceleration(mu, 0.5 * mu)
        exact[name] = between, np.maximum(pull, 0.0)
        got[name] = [0.5 * mu, *slopes], [stuck, *found]
        for slope, one in zip(slopes, found, strict=True):
            rows.append(
                (f"{name}, tan α = {slope:.3g}: acceleration [m/s²]", float(np.interp(slope, between, pull)), one)
            )
    drums = {mu: coulomb.tension_ratio(mu) for mu in (0.1, 0.2, 0.3, 0.4, 0.5)}
    wound = np.linspace(0.0, 1.8, 50)
    rows += [
        (f"μ = {mu}: tensions before and behind the drum", float(np.exp(mu * turn)), ratio)
        for mu, (ratio, turn) in drums.items()
    ]
    turns = [mu * turn for mu, (_, turn) in drums.items()]
    return Answer(
        [
            Panel("tan α", "acceleration [m/s²]", exact, got),
            Panel(
                "μ φ",
                "ratio of tensions",
                {"exp μφ": (wound, np.exp(wound))},
                {"exp μφ": (turns, [ratio for ratio, _ in drums.values()])},
            ),
        ],
        rows,
    )
