"""Solvers of time steps."""

from __future__ import annotations

from typing import Literal, get_args

from pydantic import Field, ValidationInfo, field_validator

from ringlet.data.settings import Section, refuse

Continuation = Literal["material_frame", "least_energy", "history"]
Safeguard = Literal["flip_history", "winding_number", "straight_fade"]
SAFEGUARDS: tuple[Safeguard, ...] = get_args(Safeguard)
MOST_ITERATIONS = 1000


class Solver(Section):
    """Solver of a time step."""

    newton: int = Field(
        default=5,
        ge=1,
        le=MOST_ITERATIONS,
        description="Newton iterations per step: 5 for a look, 20 for the final run. With fewer, hair lags behind "
        "its forces; 1 is stable too",
    )
    extra: int = Field(
        default=60,
        ge=0,
        le=MOST_ITERATIONS,
        description="largest number of further iterations, for locks that are stretched by over 3 % where contact "
        "limits their motion; fewer make a step cheaper and leave them stretched",
    )
    until_converged: bool = Field(
        default=False,
        description=f"iterate until every lock has converged, at most {MOST_ITERATIONS} times, whatever `newton` is",
    )
    substeps: int = Field(default=1, ge=1, le=1000, description="steps per frame")
    tolerance: float = Field(
        default=1e-6, gt=0, le=1e-2, description="[m] a lock has converged when no vertex moves further than this"
    )
    accuracy: float = Field(
        default=5e-4,
        gt=0,
        le=1,
        description="[m] motion that a frame in contact may miss, by estimate, before the report asks for a look; 5 % "
        "of its motion where that is more",
    )
    system: Literal["conjugate_gradient", "direct"] = Field(
        default="conjugate_gradient",
        description="how the linear system of locks in contact is solved: by conjugate gradients, or by factoring the "
        "whole, which takes longer",
    )
    linear_tolerance: float = Field(
        default=0.4,
        gt=0,
        le=0.5,
        description="relative error of the linear solution in the energy norm, with conjugate gradients; 0.02 for "
        "the final run",
    )
    integrator: Literal["backward_euler", "bdf2"] = Field(
        default="backward_euler",
        description="`backward_euler`, first order, damps motion; `bdf2`, second order, keeps a swing going for longer",
    )
    continuation: Continuation = Field(
        default="material_frame",
        description="rule for the signs of bends and the turns of twist: see the page on strands",
    )
    safeguards: tuple[Safeguard, ...] = Field(
        default=SAFEGUARDS, description="safeguards of `history` that are on; fewer only to study them"
    )

    @field_validator("safeguards")
    @classmethod
    def _safeguards_have_history(cls, safeguards: tuple[Safeguard, ...], info: ValidationInfo) -> tuple[Safeguard, ...]:
        continuation = info.data.get("continuation")
        if continuation != "history" and set(safeguards) != set(SAFEGUARDS):
            raise refuse(f"is {list(safeguards)}; continuation is '{continuation}', only 'history' can be without one")
        return safeguards

    @property
    def iterations(self) -> int:
        """The largest number of Newton iterations in a step."""
        return MOST_ITERATIONS if self.until_converged else self.newton


class ClothSolver(Section):
    """Solver of a time step of cloth."""

    newton: int = Field(default=5, ge=1, le=1000, description="Newton iterations per step, at most")
    tolerance: float = Field(
        default=1e-6, gt=0, le=1e-2, description="[m] converged when no vertex moves more than this"
    )
    linear_tolerance: float = Field(
        default=1e-3, gt=0, lt=1, description="residual of each linear system, as a part of its right-hand side"
    )
    linear_iterations: int = Field(default=2000, ge=1, le=100000, description="conjugate gradients per system, at most")
