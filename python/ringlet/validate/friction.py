"""Coulomb friction: sticking and sliding on a slope, creep of a sticking strand, and the tension ratio on a drum.

On a slope of angle α a strand sticks for tan α < μ, and else slides at g (sin α − μ cos α). Smoothed friction lets a
sticking strand creep to a fixed displacement: at a fraction s of creep speed times step, friction is
μ N (1 − (1 − s)⁴). On a drum that turns under a strand, the tension grows as e^{μφ} over the contact angle φ (Euler,
Eytelwein).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ringlet.data.curves import Curves
from ringlet.shot.contact import Contact
from ringlet.shot.material import Material
from ringlet.shot.solver import Solver
from ringlet.sim.obstacle import Body
from ringlet.sim.scene import Scene
from ringlet.sim.strands import Strands
from ringlet.validate.case import Case, Row

GRAVITY, STEP = 9.81, 1 / 240  # [m/s²], [s]
DISTANCE = 1e-3  # activation distance of contact [m]
CREEP = 1e-3  # creep speed [m/s]; a tangential displacement below CREEP · STEP is static friction
CONTACT = Contact(radius=DISTANCE / 2, creep_speed=CREEP)
SOLVER = Solver(tolerance=1e-12)


def on_a_slope(friction: float, slope: float, seconds: tuple[float, ...]) -> list[tuple[float, float]]:
    """Displacement [m] and velocity [m/s] of a strand down a slope, at times after the ground tilts.

    friction: coefficient μ
    slope:    slope of the ground, tan α
    seconds:  times [s]

    The root is prescribed, and joined by an edge so soft that the other vertices are free.
    """
    x = 5e-3 * np.arange(12)
    points = np.c_[x, np.full_like(x, 0.9 * DISTANCE), 0 * x]
    soft = np.where(x < 7e-3, 1e-14, 1.0)
    strands = Strands(Curves.from_list([points]), Material(drag=0.0, damping=0.0), 1, {"stretch": soft, "bend": soft})
    ground = Body(np.array([[-2.0, 0, 4], [-2, 0, -4], [8, 0, 0]]), np.array([[0, 1, 2]]), DISTANCE / 2, friction)
    scene = Scene(strands, [ground], CONTACT)
    along, down = GRAVITY * np.sin(np.arctan(slope)), -GRAVITY * np.cos(np.arctan(slope))
    for _ in range(60):
        scene.step(points, STEP, gravity=(0.0, down, 0.0), solver=SOLVER)
    begin, motion = float(strands.positions[2:, 0].mean()), []
    for _ in range(round(max(seconds) / STEP)):
        scene.step(points, STEP, gravity=(along, down, 0.0), solver=SOLVER)
        motion.append((float(strands.positions[2:, 0].mean()) - begin, float(strands.velocities[2:, 0].mean())))
    return [motion[round(t / STEP) - 1] for t in seconds]


def threshold(friction: float) -> float:
    """Smallest slope, tan α, on which the strand accelerates, by bisection."""
    sticks, slides = 0.9 * friction, 1.1 * friction
    while slides - sticks > 1e-3 * friction:
        middle = 0.5 * (sticks + slides)
        (_, before), (_, after) = on_a_slope(friction, middle, (0.15, 0.3))
        sticks, slides = (sticks, middle) if after > max(before, CREEP) else (middle, slides)
    return 0.5 * (sticks + slides)


def acceleration(friction: float, slope: float) -> float:
    """Acceleration of a sliding strand [m/s²]."""
    (_, before), (_, after) = on_a_slope(friction, slope, (0.15, 0.3))
    return (after - before) / 0.15


def tension_ratio(friction: float) -> tuple[float, float]:
    """Ratio of the tensions of a strand on both sides of a drum, and the contact angle [rad].

    The drum turns under a strand that is fixed at one end and pulled at the other.
    """
    # Coarser than the strand: its contacts wander over corners, which cost no friction.
    radius, facets, width, speed, dt, steps = 10e-3, 96, 5e-3, 0.05, STEP / 4, 120
    strand_radius = radius + 0.95 * DISTANCE
    polar = np.pi - np.linspace(0.0, np.pi, 36)
    leg = -strand_radius * np.pi / 35 * np.arange(1, 12)
    fixed_side = np.c_[np.full(11, -strand_radius), leg[::-1], 0 * leg]
    arc = strand_radius * np.c_[np.cos(polar), np.sin(polar), 0 * polar]
    points = np.concatenate([fixed_side, arc, fixed_side[::-1] * [-1, 1, 1]])
    strands = Strands(Curves.from_list([points]), Material(stretch_scale=1.0, bend_scale=0.0, drag=0.0), 1)

    k = np.arange(facets)
    turn = 2 * np.pi * k / facets
    ring, axis = radius * np.c_[np.cos(turn), np.sin(turn), 0 * turn], np.array([0, 0, width])
    drum = np.concatenate([ring - axis, ring + axis])
    following = np.roll(k, -1)
    triangles = np.concatenate([np.c_[k, following, following + facets], np.c_[k, following + facets, k + facets]])
    scene = Scene(strands, [Body(drum, triangles, DISTANCE / 2, friction)], CONTACT)

    pull = np.zeros_like(points)
    pull[-1, 1] = -0.01
    for step in range(1, steps + 1):
        angle = step * dt * speed / radius  # clockwise
        spin = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        scene.step(points, dt, bodies=[drum @ spin], forces=pull, solver=SOLVER)
    edges = np.diff(strands.positions, axis=0)
    strain = np.linalg.norm(edges, axis=1) / np.linalg.norm(np.diff(points, axis=0), axis=1) - 1
    first, last = (edges[side].sum(axis=0) for side in (slice(2, 6), slice(-6, -2)))
    angle = np.arccos(first @ last / (np.linalg.norm(first) * np.linalg.norm(last)))
    return float(strain[2:6].mean() / strain[-6:-2].mean()), float(angle)


def run() -> Iterator[Row]:
    for friction in (0.2, 0.5):
        yield Row(f"slope where μ = {friction} begins to slide, tan α", friction, threshold(friction), 0.01)
    for friction, slope in ((0.2, 0.3), (0.5, 0.6)):
        angle = np.arctan(slope)
        expected = GRAVITY * (np.sin(angle) - friction * np.cos(angle))
        got = acceleration(friction, slope)
        yield Row(f"sliding, μ = {friction}, tan α = {slope}: acceleration", float(expected), got, 0.02)
    for load in (0.1, 0.5, 0.9):  # W / μN; less than CREEP · load / 2 as long as load < 0.91
        creep = CREEP * STEP * (1 - (1 - load) ** 0.25)
        yield Row(f"gives way under {load:.0%} of μN", creep, on_a_slope(0.4, 0.4 * load, (0.25,))[0][0], 0.01)
    for friction in (0.1, 0.3, 0.5):
        got, angle = tension_ratio(friction)
        yield Row(f"round a drum, μ = {friction}: tension ratio", float(np.exp(friction * angle)), got, 0.03)


CASE = Case("friction", "Strands stick and slide on slopes and round a drum as Coulomb's law says", run)
