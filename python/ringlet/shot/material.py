"""The material of strands."""

from __future__ import annotations

from typing import Any

from pydantic import Field, ValidationInfo, field_validator

from ringlet.data.explain import shown
from ringlet.data.settings import Section, refuse


class Material(Section):
    """Material of a lock: the values of one hair, since hairs that do not stick together move like one of them."""

    youngs_modulus: float = Field(
        default=4e9, gt=0, le=1e13, description="Young's modulus E [Pa]: hair has 2e9 to 6e9; larger is stiffer"
    )
    radius: float = Field(
        default=35e-6, gt=1e-7, le=0.1, description="radius r of one hair [m]; larger is stiffer and heavier"
    )
    density: float = Field(default=1300.0, gt=0, le=1e5, description="mass per volume [kg/m³]")
    stretch_scale: float = Field(
        default=0.01, gt=0, le=100, description="factor on the stretch stiffness, E π r²; larger stretches less"
    )
    bend_scale: float = Field(
        default=1.0,
        ge=0,
        le=1e6,
        description="factor on the bend stiffness, E π r⁴ / 4; larger holds its shape more firmly and swings less",
    )
    limit_twist: bool = Field(
        default=True, description="keep the twist stiffness below the bend stiffness; off only to study this safeguard"
    )
    twist_ratio: float = Field(
        default=0.72,
        ge=0,
        le=100,
        description="twist stiffness relative to the bend stiffness, at most 1; it is the spring constant of a coil",
    )
    damping: float = Field(
        default=0.005,
        ge=0,
        le=100,
        description="[s] damping time: each strain resists its rate by this times its stiffness; larger settles sooner",
    )
    mass_damping: float = Field(default=0.0, ge=0, le=1e4, description="[1/s] rate at which velocities decay")
    drag: float = Field(
        default=2e-5, ge=0, le=100, description="air drag per length and speed [kg/(m s)]; larger swings less"
    )
    correct_resolution: bool = Field(
        default=True, description="correct the stiffness of coils with few vertices per turn, which would be too stiff"
    )

    @field_validator("twist_ratio", mode="before")
    @classmethod
    def _limited_twist(cls, ratio: Any, info: ValidationInfo) -> Any:
        if isinstance(ratio, int | float) and ratio > 1 and info.data.get("limit_twist"):
            raise refuse(
                f"is {shown(ratio)}; must be at most 1 (or limit_twist = false, to study what the limit is for)"
            )
        return ratio
