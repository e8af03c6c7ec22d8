"""Ringlet as a solver of cosseratbench."""

from __future__ import annotations

import math
from collections.abc import Callable
from importlib.metadata import version
from typing import Any, ClassVar

import numpy as np
from cosseratbench.scenario import Scenario  # pyright: ignore[reportMissingImports]
from cosseratbench.solver import Capability, Diverged  # pyright: ignore[reportMissingImports]
from cosseratbench.trajectory import Trajectory  # pyright: ignore[reportMissingImports]

from ringlet.shot.contact import Contact
from ringlet.shot.solver import Solver
from ringlet.sim.scene import Scene
from ringlet.validate.cosserat_bench.bodies import bodies
from ringlet.validate.cosserat_bench.rods import Points, RodStrands

# Steps are stable at any length; these are of the accuracy of 50 elements, in units of 1 / the slowest frequency.
DYNAMIC_STEP, QUASI_STATIC_STEP = 0.004, 0.02
SOLVER = Solver(newton=50, tolerance=1e-9, linear_tolerance=0.02)
STIFFNESS = 1000.0  # of contacts: rods overlap by about a hundredth of their radius
CREEP_SPEED = 1e-4  # [m/s]

Step = Callable[[Points, float], dict[str, Points]]  # targets [m] and time step [s] → the report of every strand


class RingletSolver:
    """Discrete elastic rods with implicit contact.

    time_step_scale: multiplies the time step
    """

    name = "ringlet"
    backend_version = version("ringlet")
    capabilities: ClassVar = frozenset(
        {
            Capability.STRETCH,
            Capability.ROD_CONTACT,
            Capability.ROD_FRICTION,
            Capability.CYLINDER_CONTACT,
            Capability.PLANE_CONTACT,
        }
    )

    def __init__(self, time_step_scale: float = 1.0) -> None:
        self.time_step_scale = time_step_scale

    def _steps(self, scenario: Scenario, n_frames: int) -> tuple[float, int]:
        """The time step [s], and how many of them make a frame."""
        interval = scenario.duration / (n_frames - 1)
        length = QUASI_STATIC_STEP if scenario.quasi_static else DYNAMIC_STEP
        count = math.ceil(interval * scenario.slowest_frequency() / (self.time_step_scale * length))
        return interval / count, count

    def settings(self, scenario: Scenario, *, n_elements: int, n_frames: int) -> dict[str, Any]:
        """The numerical choices for a scenario."""
        of_contact = {"contact_stiffness": STIFFNESS, "creep_speed": CREEP_SPEED} if _can_touch(scenario) else {}
        return {
            "integrator": _integrator(scenario),
            "time_step": self._steps(scenario, n_frames)[0],
            "damping_rate": _damping(scenario),
            "newton_tolerance": SOLVER.tolerance,
            **of_contact,
        }

    def run(self, scenario: Scenario, *, n_elements: int, n_frames: int) -> Trajectory:
        """Simulates a scenario; raises Diverged, and NotImplementedError for what strands cannot do."""
        dt, per_frame = self._steps(scenario, n_frames)
        rods = RodStrands(scenario, n_elements, _damping(scenario))
        step = _step(scenario, rods)
        frames = [rods.state]
        for frame in range(1, n_frames):
            for k in range(1, per_frame + 1):
                time = ((frame - 1) * per_frame + k) * dt
                if step(rods.targets(time, dt), dt)["nan"].any():
                    raise Diverged("positions are not finite", time=time)
            frames.append(rods.state)
        positions, directors = (
            tuple(np.stack([frame[rod][k] for frame in frames]) for rod in range(len(scenario.rods))) for k in (0, 1)
        )
        return Trajectory(np.linspace(0.0, scenario.duration, n_frames), positions, directors)


def _integrator(scenario: Scenario) -> str:
    return "backward_euler" if scenario.quasi_static else "bdf2"


def _damping(scenario: Scenario) -> float:
    """Rate at which velocities decay [1/s]: critical for the slowest mode where the equilibrium is the result."""
    return 2.0 * scenario.slowest_frequency() if scenario.quasi_static else 0.0


def _can_touch(scenario: Scenario) -> bool:
    return bool(scenario.obstacles) or len(scenario.rods) > 1 or scenario.self_contact


def _step(scenario: Scenario, rods: RodStrands) -> Step:
    """The step of a scene where something can touch, else of the strands alone."""
    solver = SOLVER.model_copy(update={"integrator": _integrator(scenario)})
    given: dict[str, Any] = {"gravity": scenario.gravity, "forces": rods.forces, "solver": solver}
    if not _can_touch(scenario):
        return lambda targets, dt: rods.strands.step(targets, dt, **given)
    rod = scenario.rods[0]
    contact = Contact(radius=rod.radius, friction=rod.friction, stiffness=STIFFNESS, creep_speed=CREEP_SPEED)
    scene = Scene(rods.strands, bodies(scenario), contact)
    return lambda targets, dt: scene.step(targets, dt, **given)[1]
