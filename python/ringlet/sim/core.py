"""Settings as the core takes them. Fields are copied by name, in this file alone: a new setting needs no line here."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any, TypeVar

from ringlet import _core
from ringlet.data.settings import Section
from ringlet.shot.solver import SAFEGUARDS, ClothSolver, Solver

Vector = tuple[float, float, float]
Core = TypeVar("Core")

ENUMERATIONS = {"continuation": _core.Continuation, "integrator": _core.Integrator, "system": _core.System}
OF_RUN = ("accuracy", "substeps", "until_converged")  # settings of a solver that the core does not have


def assign(target: Core, settings: Section, *, without: Collection[str] = ()) -> Core:
    """Copies each setting to the attribute of the same name of an object of the core; returns that object."""
    for name, value in settings:
        if name not in without:
            setattr(target, name, value)
    return target


def step_settings(solver: Solver | ClothSolver, dt: float, gravity: Vector, wind: Vector) -> _core.StepSettings:
    """A step of ``dt`` [s] under gravity [m/s²] and wind [m/s], with the settings of a solver."""
    step = _core.StepSettings()
    step.dt, step.gravity, step.wind = dt, gravity, wind
    for name, value in solver:
        if name not in OF_RUN:
            setattr(step, name, _converted(name, value))
    if isinstance(solver, Solver):
        step.newton = solver.iterations
    return step


def _converted(name: str, value: Any) -> Any:
    """A setting as the core has it: a word as the member of an enumeration, a list of words as switches."""
    if name in ENUMERATIONS:
        return getattr(ENUMERATIONS[name], value)
    if name == "safeguards":
        switches = _core.Safeguards()
        for safeguard in SAFEGUARDS:
            setattr(switches, safeguard, safeguard in value)
        return switches
    return value
