"""Normal contact forces: the equilibrium gap of a strand that is pressed onto the ground, or onto strands across it.

A contact of activation distance r, stiffness k and onset a has the force k (r − g)²/2a at gaps g down to r − a. With
s = r − a/2, it is k (s − g) down to s/2, and k s²/4g below.
The stiffness of a vertex is 0.01, 0.1 or 1 times ``k``, against strands also 0.001 times: the lowest level whose force
at gap 0.25 r or more suffices. The remembered load halves in a quarter of a second, so that the vertex softens again.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.shot.contact import Contact
from ringlet.shot.material import Material
from ringlet.shot.solver import Solver
from ringlet.sim.obstacle import Body
from ringlet.sim.scene import Scene
from ringlet.sim.strands import Strands
from ringlet.validate.case import Case, Row

DISTANCE, STEP = 1e-3, 1 / 240  # activation distance r [m], time step [s]
PRESSES = (0.0005, 0.002, 0.004, 0.02, 0.05, 0.2, 0.5, 1.0, 3.0, 10.0)  # loads [k r]
LEVELS = (0.01, 0.1, 1.0)  # stiffness levels [k]
STRAND_PRESSES = (0.0001, 0.0005, 0.001, 0.0015)  # loads [k r]
STRAND_LEVELS = (0.001, *LEVELS)  # of contacts between strands [k]
ONSET = 0.15  # depth over which the stiffness of the barrier rises from 0 [r]


def pressed(*presses: float, steps: int = 100, on_strands: bool = False) -> list[float]:
    """Gaps relative to r after ``steps`` steps under each load in turn [k r]; velocities are reset after each step.

    on_strands: below each vertex a held strand lies across, in place of the ground
    """
    x = 5e-3 * np.arange(64)
    curves = [np.c_[x, np.full_like(x, 0.99 * DISTANCE), 0 * x]]
    if on_strands:
        curves += [np.array([[at, 0.0, z] for z in (-1e-3, 1e-3, 3e-3)]) for at in x]
    points = np.concatenate(curves)
    soft = np.ones(len(points))
    soft[:2] = 1e-14  # edges so soft that the vertices behind them are free
    strands = Strands(Curves.from_list(curves), Material(drag=0.0), 2, {"stretch": soft, "bend": soft})
    ground = Body(np.array([[-2.0, 0, 4], [-2, 0, -4], [8, 0, 0]]), np.array([[0, 1, 2]]), DISTANCE / 2, 0.0)
    scene = Scene(strands, [] if on_strands else [ground], Contact(radius=DISTANCE / 2))
    middle, length = 34, 5e-3
    stretch, bend, _ = strands.stiffness
    k = strands.masses[middle] / STEP**2 + bend[middle] / length**2 + 0.1 * stretch[middle]
    gaps = []
    for press in presses:
        gravity = press * k * DISTANCE / strands.masses[middle]
        for _ in range(steps):
            scene.step(points, STEP, gravity=(0.0, -gravity, 0.0), solver=Solver(tolerance=1e-12))
            strands.velocities[:] = 0.0
        gaps.append(float(strands.positions[middle, 1] / DISTANCE))
    return gaps


def gap_under(press: NDArray[np.floating], levels: tuple[float, ...] = LEVELS) -> NDArray[np.floating]:
    """Equilibrium gap relative to r under loads [k r], shape (n,), at the lowest sufficient level, or the last."""
    press = np.asarray(press, float)
    by_level = press / np.select([press <= level for level in levels], levels, levels[-1])
    middle = 1 - 0.5 * ONSET
    return np.select(
        [by_level < 0.5 * ONSET, by_level < 0.5 * middle],
        [1 - np.sqrt(2 * ONSET * by_level), middle - by_level],
        middle**2 / (4 * by_level),
    )


def run() -> Iterator[Row]:
    for press, gap in zip(PRESSES, gap_under(np.array(PRESSES)), strict=True):
        yield Row(f"gap / r under {press:g} k r", float(gap), pressed(press)[0], 1e-3)
    for press in STRAND_PRESSES:  # two edges push at each vertex, each with half of the force
        gap = float(gap_under(np.array([0.5 * press]), STRAND_LEVELS)[0])
        yield Row(f"gap / r under {press:g} k r, on strands", gap, pressed(press, on_strands=True)[0], 1e-3)
    first, after = 0.5, 0.002
    gaps = pressed(first, after, steps=5), pressed(first, after, steps=600)
    hard = float(gap_under(np.array([after]), LEVELS[-1:])[0])
    yield Row(f"{after:g} k r, 0.02 s after {first:g} k r", hard, gaps[0][1], 1e-3)
    yield Row(f"{after:g} k r, 2.5 s after {first:g} k r", float(gap_under(np.array([after]))[0]), gaps[1][1], 1e-3)


CASE = Case("push", "A contact is as hard as what it has to bear asks for, and bears it where its formula says", run)
