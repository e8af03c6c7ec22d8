"""Cloth in a shot: its material, and what pins it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Self

import numpy as np
from pydantic import Field, ValidationInfo, field_validator, model_validator

from ringlet.data import limits
from ringlet.data.settings import Section, refuse

Frame = Annotated[float, Field(ge=-limits.FRAME, le=limits.FRAME)]
Scale = Annotated[float, Field(gt=0.01, le=100)]


class ClothMaterial(Section):
    """Material of cloth."""

    density: float = Field(default=0.15, gt=0, le=1e4, description="mass per area [kg/m²]; shirts 0.1, denim 0.4")
    stretch_warp: float = Field(
        default=1000.0,
        gt=0,
        le=1e8,
        description="resistance to stretch along the warp: force per width and strain [N/m]",
    )
    stretch_weft: float = Field(default=1000.0, gt=0, le=1e8, description="resistance to stretch along the weft [N/m]")
    shear: float = Field(default=300.0, ge=0, le=1e8, description="resistance to shear between warp and weft [N/m]")
    bend: float = Field(
        default=1e-5, ge=0, le=1e4, description="resistance to bend: moment per width and curvature [N m]"
    )
    damping: float = Field(
        default=0.005,
        ge=0,
        le=100,
        description="[s] damping time: each strain resists its rate by this times its stiffness; larger settles sooner",
    )
    mass_damping: float = Field(default=0.0, ge=0, le=1e4, description="[1/s] rate at which velocities decay")
    drag: float = Field(default=0.05, ge=0, le=1e3, description="air drag per area and speed [kg/(m² s)]")
    thickness: float = Field(default=1e-3, gt=0, le=0.1, description="[m] distance at which contact begins")
    friction: float = Field(default=0.3, ge=0, le=10, description="Coulomb's μ of a lock on it")


class Pin(Section):
    """Prescribed vertices of a cloth: all of it, or those that fulfil every condition here."""

    to: str | None = Field(
        default=None,
        description="the collider that they go along with, by its name; by default the cloth's own animation",
    )
    subset: str | None = Field(default=None, description="a GeomSubset of faces: only the vertices of these")
    map: str | None = Field(
        default=None, description="a primvar of floats: only where it is above 0; `stiffness` is multiplied by it"
    )
    within: float | None = Field(
        default=None, ge=0, le=10, description="[m] only those that begin no farther than this from the surface of `to`"
    )
    stiffness: float | None = Field(
        default=None,
        gt=0,
        le=1e6,
        description="[N/m] of a spring from each to its place; without it they are held there",
    )

    @field_validator("within")
    @classmethod
    def _has_target(cls, within: float | None, info: ValidationInfo) -> float | None:
        if within is not None and info.data.get("to") is None:
            raise refuse(f"is {within}, but there is no `to`; name the collider that this is the distance from")
        return within


class ShotCloth(Section):
    """A cloth that locks, colliders, other cloths and itself touch: the same step moves it with the locks."""

    name: str = Field(
        default="",
        pattern="^([A-Za-z_][A-Za-z0-9_]*)?$",
        description="name for pins and friction; by default the last part of its prim's path",
    )
    file: Path | None = Field(
        default=None, description="USD file; by default that of the head. A relative name counts from the shot"
    )
    mesh: str | None = Field(
        default=None,
        description="path of its prim: the mesh there, or the only one below it; without it the only one in `file`",
    )
    material: ClothMaterial = Field(default=ClothMaterial(), description="material of the cloth")
    pin: tuple[Pin, ...] = Field(
        default=(), description="vertices whose motion is prescribed; later entries override earlier ones"
    )
    shrink: Scale | tuple[tuple[Frame, Scale], ...] = Field(
        default=1.0,
        description="size of the rest shape relative to the mesh: below 1 elastic draws together. Or a list of "
        "`[frame, scale]`, linear in between",
    )

    @field_validator("shrink")
    @classmethod
    def _ascending_frames(
        cls, shrink: float | tuple[tuple[float, float], ...]
    ) -> float | tuple[tuple[float, float], ...]:
        if isinstance(shrink, tuple):
            frames = [frame for frame, _ in shrink]
            if not frames or frames != sorted(set(frames)):
                raise refuse(f"has the frames {frames}; give at least one, each later than the one before")
        return shrink

    @model_validator(mode="after")
    def _has_mesh(self) -> Self:
        if self.file is None and self.mesh is None:
            raise refuse("names no mesh; give `mesh`, a prim in the file of the head, or `file`")
        return self

    def scale(self, frame: float) -> float:
        """The scale of the rest shape at a frame, relative to the mesh."""
        if not isinstance(self.shrink, tuple):
            return self.shrink
        frames, scales = zip(*self.shrink, strict=True)
        return float(np.interp(frame, frames, scales))

    @property
    def least_scale(self) -> float:
        """The smallest scale of the rest shape, relative to the mesh."""
        return min(scale for _, scale in self.shrink) if isinstance(self.shrink, tuple) else self.shrink
