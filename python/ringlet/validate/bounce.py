"""Hanging coils of all types hang, bounce, settle and swing as the words of their motion say.

Expected values: linear theory (``ringlet.motion``). Measured: a lock of each type, plucked along its axis and across,
in the steps of both integrators. A pluck moves several modes that are close to one another; their frequencies and decay
are found by the matrix pencil (Hua and Sarkar 1990), exact for a sum of damped vibrations. Of those with at least
0.4 of the largest amplitude the one nearest to the expected frequency counts.

The theory itself is compared with the closed formulas of a spring whose lower end is free (Love 1927, art. 271, and
docs/theory/hanging_coil.md). It bounces at f = 1 / (4 L √(λ φ)) and lengthens under its weight by g / 32 f². L is the
length of its wire, λ its mass by length, and φ = R² (cos²α / GJ + sin²α / EI) its flexibility by length.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.mesh import Mesh
from ringlet.groom import PRESETS, make_groom, parse_recipe
from ringlet.motion import CoilLengths, HangingLocks, HelicalSpring, Integrator, Stepping
from ringlet.shot.material import Material
from ringlet.shot.solver import Solver
from ringlet.sim.hanging import hang
from ringlet.sim.strands import Strands
from ringlet.validate.case import Case, Row
from ringlet.validate.rods import bending_stiffness, line_density, rod_material, strand

Array = NDArray[np.float64]

# Length of the lock [m] and its vertices, by type.
LOCKS = {
    "2A": (0.2, 60),
    "2B": (0.2, 60),
    "2C": (0.2, 80),
    "3A": (0.15, 90),
    "3B": (0.12, 100),
    "3C": (0.08, 110),
    "4A": (0.05, 120),
    "4B": (0.04, 120),
    "4C": (0.04, 130),
}
# Width and pitch of the coils [mm], with their variation, and what else differs from the preset. The theory is linear:
# coils are closer than those of a preset that hang, so that a bounce is a small part of what they can give.
COILS: dict[str, tuple[float, float, float, float, str]] = {
    "2A": (9, 0.3, 72, 0.15, ""),
    "2B": (13, 0.25, 56, 0.15, ""),
    "2C": (17, 0.25, 46, 0.15, ""),
    "3A": (25, 0.2, 36, 0.15, "flatness = 0.1"),
    "3B": (16, 0.2, 22, 0.15, ""),
    "3C": (9, 0.2, 12, 0.15, ""),
    "4A": (5, 0.2, 6.5, 0.15, ""),
    "4B": (4.5, 0.3, 5.5, 0.25, ""),
    "4C": (3.5, 0.3, 4.2, 0.25, ""),
}
GRAVITY, PULL = 9.81, 0.2  # [m/s²]
DAMPING = 0.01  # relative to critical
AGREES = 0.05
# By integrator: steps a period, and periods of a bounce: enough to tell modes apart that are close to one another.
STEPS: dict[Integrator, tuple[int, int]] = {"bdf2": (24, 32), "backward_euler": (48, 12)}
SWINGS = 6  # periods of a swing
SHEET = Mesh(
    "sheet", 0.03 * np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1.0]]), np.array([[0, 1, 2], [0, 2, 3]])
)


def lock(kind: str) -> Curves:
    """A lock of a type that hangs from a sheet."""
    length, points = LOCKS[kind]
    width, wider, pitch, longer, more = COILS[kind]
    recipe = parse_recipe(
        f"""
        ringlet = 2
        seed = 5
        scalp = {{ file = "sheet" }}
        guides = {{ count = 1, length = "{length} m", lift = 1, gravity_bend = 0 }}
        locks = {{ count = 1, points = {points} }}
        [curl]
        preset = "{kind}"
        width = {{ value = "{width} mm", vary = {wider} }}
        pitch = {{ value = "{pitch} mm", vary = {longer} }}
        {more}
        """
    )
    locks = make_groom(recipe, SHEET).locks
    return locks.with_points(np.ascontiguousarray(locks.points * [1.0, -1.0, 1.0]))


@dataclass
class Plucked:
    """A lock that hangs still, to be plucked.

    groomed, hanging: where it was groomed and where it hangs [m], shapes (n, 3)
    """

    strands: Strands
    groomed: Array
    hanging: Array
    locks: HangingLocks

    @classmethod
    def of(cls, kind: str) -> Plucked:
        """Hair of a type, whose bounce has a fraction of critical damping."""
        curves, material = lock(kind), Material(drag=0.0, damping=0.0)
        groomed = np.asarray(curves.points, np.float64)

        def hung(material: Material) -> Plucked:
            strands = Strands(curves, material, 3)
            locks = hang(strands, groomed, (0.0, -GRAVITY, 0.0))
            return cls(strands, groomed, strands.positions.copy(), locks)

        omega = 2.0 * np.pi * hung(material).locks.words().bounce[0]
        return hung(material.model_copy(update={"damping": 2.0 * DAMPING / omega}))

    def rings(self, pull: Array, steps: Stepping, count: int) -> Array:
        """Displacement of the lock along a pull [m/s²] from which it is released, step by step, less its start."""
        strands, along = self.strands, pull / np.linalg.norm(pull)
        strands.place(self.hanging)
        strands.settle(gravity=tuple(pull - [0.0, GRAVITY, 0.0]), steps=200)
        strands.place(strands.positions.copy())
        solver = Solver(newton=20, tolerance=1e-11, integrator=steps.integrator)
        moved = []
        for _ in range(count):
            strands.step(self.hanging, steps.dt, gravity=(0.0, -GRAVITY, 0.0), solver=solver)
            moved.append(strands.masses @ ((strands.positions - self.hanging) @ along))
        return np.array(moved[3:])  # the first steps of BDF-2 are not of one kind

    def sag(self) -> float:
        """How much longer it hangs than it is groomed after five seconds of a shot's steps, as a fraction."""
        self.strands.place(self.groomed)
        for _ in range(120):
            self.strands.step(self.groomed, 1.0 / 24.0, gravity=(0.0, -GRAVITY, 0.0))
        coils = CoilLengths(self.strands.curves)
        return float(coils.of(self.strands.positions)[0] / coils.of(self.groomed)[0] - 1.0)


def vibrations(series: Array, most: int = 14) -> tuple[NDArray[np.complex128], Array]:
    """Factors z by which a step multiplies the vibrations in a series, and their amplitudes: matrix pencil."""
    windows = np.lib.stride_tricks.sliding_window_view(series, len(series) // 2)
    _, size, rows = np.linalg.svd(windows, full_matrices=False)
    rows = rows[: min(most, int((size > 1e-6 * size[0]).sum()))].T
    z = np.linalg.eigvals(np.linalg.lstsq(rows[:-1], rows[1:], rcond=None)[0]).astype(np.complex128)
    powers = z ** np.arange(len(series))[:, None]
    amplitudes = np.linalg.lstsq(powers, series.astype(np.complex128), rcond=None)[0]
    return z[z.imag > 0.0], np.abs(amplitudes[z.imag > 0.0])


def strongest(series: Array, steps: Stepping, near: float) -> tuple[float, float]:
    """Frequency [Hz] and time to settle [s] of the vibration in a series that is strong and next to a frequency."""
    z, amplitudes = vibrations(series)
    shown, settle = steps.shown(steps.exponent(z))
    chosen = np.where(amplitudes > 0.4 * amplitudes.max(), np.abs(shown - near), np.inf).argmin()
    return float(shown[chosen]), float(settle[chosen])


def agreement(kind: str, integrator: Integrator) -> Iterator[tuple[str, float, float]]:
    """Each word of a type at the steps of an integrator: what it is, by theory, measured."""
    plucked, (per_period, bounces) = Plucked.of(kind), STEPS[integrator]
    own = plucked.locks.words()
    axis = plucked.hanging[-1] - plucked.hanging[0]
    across = np.cross(axis, [0.0, 0.0, 1.0])
    yield "sag", own.sag[0], plucked.sag()
    for name, pull, periods in (("bounce", axis, bounces), ("swing", across, SWINGS)):
        steps = Stepping(1.0 / (getattr(own, name)[0] * per_period), integrator)
        words = plucked.locks.words(steps)
        expected = getattr(words, name)[0]
        series = plucked.rings(PULL * pull / np.linalg.norm(pull), steps, periods * per_period)
        found, settled = strongest(series, steps, expected)
        yield f"{name} [Hz]", expected, found
        if name == "bounce":
            yield "settle [s]", words.settle[0], settled


def spring(turns: int) -> Iterator[tuple[str, float, float]]:
    """Bounce and lengthening of a close coil under little weight: by the closed formulas, by the theory of locks."""
    radius, pitch, per_turn, gravity = 5e-3, 3e-3, 24, 1e-3
    turn = 2.0 * np.pi * np.arange(-2, turns * per_turn + 1) / per_turn
    points = np.c_[radius * np.cos(turn), -pitch * turn / (2.0 * np.pi), radius * np.sin(turn)]
    material = rod_material()
    angle, length = np.arctan2(pitch, 2.0 * np.pi * radius), turns * np.hypot(2.0 * np.pi * radius, pitch)
    bend = bending_stiffness(material)
    coil = HelicalSpring(radius, np.sin(angle), bend, material.twist_ratio * bend)
    bounce = 0.25 / (length * np.sqrt(line_density(material) * coil.flexibility))
    words = hang(strand(points, material, 3), points, (0.0, -gravity, 0.0)).words()
    yield "bounce [Hz]", bounce, words.bounce[0]
    yield "sag", gravity / (32.0 * bounce**2) / np.linalg.norm(points[-1] - points[0]), words.sag[0]


def run() -> Iterator[Row]:
    for turns in (8, 16):
        for name, expected, got in spring(turns):
            yield Row(f"close coil of {turns} turns, {name}, by theory", expected, got, 0.03)
    for integrator in STEPS:
        for kind in LOCKS if integrator == "bdf2" else ("2C", "3B", "4A"):
            for name, expected, got in agreement(kind, integrator):
                yield Row(f"{kind}, {integrator}, {name}", expected, got, AGREES)


assert set(LOCKS) == set(COILS) == set(PRESETS) - {"1"}
CASE = Case("bounce", "Coils of all types hang, bounce, settle and swing as the words of their motion say", run)
