"""The material of strands."""

from __future__ import annotations

from pydantic import Field, ValidationInfo, field_validator

from ringlet.data.settings import Section, refuse


class Material(Section):
    """Material of a lock: the values of one hair, since hairs that do not stick together move like one of them."""

    youngs_modulus: float = Field(default=4e9, gt=0, le=1e13, description="E [Pa]; hair: 2e9 to 6e9")
    radius: float = Field(default=35e-6, gt=1e-7, le=0.1, description="r of one hair [m]")
    density: float = Field(default=1300.0, gt=0, le=1e5, description="[kg/m³]")
    stretch_scale: float = Field(
        default=0.01, gt=0, le=100, description="scales the resistance to stretch, E π r²; hair is hard to stretch"
    )
    bend_scale: float = Field(default=1.0, ge=0, le=1e6, description="scales the resistance to bend, E π r⁴ / 4")
    limit_twist: bool = Field(
        default=True, description="twist never exceeds bend; off only to study what this safeguard is for"
    )
    twist_ratio: float = Field(
        default=0.72,
        ge=0,
        le=100,
        description="twist stiffness as a part of bend stiffness, at most 1: the spring constant of a coil",
    )
    damping: float = Field(
        default=0.005,
        ge=0,
        le=100,
        description="[s] every strain resists its own rate with this time times its stiffness",
    )
    mass_damping: float = Field(default=0.0, ge=0, le=1e4, description="[1/s] rate at which velocities decay")
    drag: float = Field(default=2e-5, ge=0, le=100, description="air drag per length and speed [kg/(m s)]")
    correct_resolution: bool = Field(
        default=True, description="make coils of few vertices a turn as soft as smooth ones"
    )

    @field_validator("twist_ratio")
    @classmethod
    def _limited_twist(cls, ratio: float, info: ValidationInfo) -> float:
        if ratio > 1 and info.data.get("limit_twist"):
            raise refuse(f"is {ratio}; must be at most 1 (or limit_twist = false, to study what the limit is for)")
        return ratio
