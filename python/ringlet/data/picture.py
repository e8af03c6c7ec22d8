"""Settings of a picture: its size and quality, its camera, its light and its background."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, fields
from importlib.util import find_spec
from math import isfinite
from typing import Any, ClassVar, Self

from ringlet.data import limits
from ringlet.data.errors import UserError
from ringlet.data.explain import did_you_mean

CHOICES = {
    "background": ("studio", "transparent"),
    "denoiser": ("oidn", "none"),
    "engine": ("scalar", "llvm"),
}


@dataclass(frozen=True, kw_only=True)
class PictureSettings:
    """How a picture is taken. Raises UserError for a value out of its bounds.

    width, height: size [pixels]; the height is that of the camera's proportions by default, or of 9 : 10
    samples:       light paths per pixel
    seconds:       time limit of the rendering, after the three passes that the denoiser needs; None for none
    color:         a hair colour; by default the hairs' own, or dark brown where they have none
    bounces:       largest number of bounces of a light path; dark hair ends most paths early, light hair needs 32
    view:          three_quarter, front, side or back; or azimuth and elevation of the camera [degrees], also as text.
                   By default three_quarter, and from outside of the head for a lock
    camera:        path of a camera in the stage, in place of the view
    look_at:       id of a lock to look at, in place of the head
    distance:      of the camera from the centre of what it looks at [m]; by default all of it is seen
    focal_length:  for a sensor of 36 mm × 24 mm [mm]; 85 by default
    f_stop:        focal length over the diameter of the aperture; 0 has everything in focus. By default that of the
                   camera in the stage, or else 0
    focus:         distance of the plane in focus [m]; by default that of the camera, or of the nearest in the middle
    light:         a light rig, or an HDRI: studio, window, sun, or an .exr or .hdr file
    light_layers:  renders each light alone, into layers of an EXR, which add up to the picture
    light_turn:    turns the light about the vertical [degrees], counter-clockwise from above
    background:    studio or transparent; an EXR has no backdrop
    shutter:       angle of the shutter [degrees], for motion blur: 180 is open for half a frame from the frame on
    denoiser:      oidn, which is Intel Open Image Denoise and the default where it is installed, or none
    engine:        scalar, or llvm, which compiles for each scene, needs more memory and a library of LLVM
    """

    # The least and the most of each number.
    bounds: ClassVar[dict[str, tuple[float, float]]] = {
        "width": (1, limits.PIXELS),
        "height": (1, limits.PIXELS),
        "samples": (1, limits.SAMPLES),
        "seconds": (0, limits.SECONDS),
        "bounces": (1, limits.BOUNCES),
        "look_at": (-limits.ID, limits.ID),
        "distance": (1e-3, 1e3),
        "focal_length": (1, 2000),
        "f_stop": (0, 1000),
        "focus": (1e-3, 1e6),
        "light_turn": (-360, 360),
        "shutter": (0, 360),
    }

    width: int = 900
    height: int | None = None
    samples: int = 40
    seconds: float | None = None
    color: str | None = None
    bounces: int = 64
    view: str | tuple[float, float] | None = None
    camera: str | None = None
    look_at: int | None = None
    distance: float | None = None
    focal_length: float | None = None
    f_stop: float | None = None
    focus: float | None = None
    light: str = "studio"
    light_turn: float = 0.0
    light_layers: bool = False
    background: str = "studio"
    shutter: float = 0.0
    denoiser: str = "oidn" if find_spec("pyoidn") else "none"
    engine: str = "scalar"

    @classmethod
    def of(cls, settings: dict[str, Any]) -> Self:
        """Settings from keywords; raises UserError for an unknown one."""
        known = [field.name for field in fields(cls)]
        for name in settings:
            if name not in known:
                raise UserError(f"picture: {name}{did_you_mean(name, known)}")
        return cls(**settings)

    def __post_init__(self) -> None:
        for name, (least, most) in self.bounds.items():
            value = getattr(self, name)
            if value is not None and not (isfinite(value) and least <= value <= most):
                raise UserError(f"picture: {name} is {value}; must be at least {least:g} and at most {most:g}")
        for name, choices in CHOICES.items():
            if (value := getattr(self, name)) not in choices:
                raise UserError(f"picture: {name} is '{value}'; choose one of {', '.join(choices)}")
        if self.camera is not None:
            for name in ("view", "look_at", "distance", "focal_length"):
                if getattr(self, name) is not None:
                    raise UserError(
                        f"picture: {name} is given with camera {self.camera}, which has its own; leave one out"
                    )

    def refuse_lights(self, what: str) -> None:
        """Raises UserError for layers of lights where there are no layers."""
        if self.light_layers:
            raise UserError(f"picture: {what} has no layers of lights; leave light_layers out, or write an .exr")

    def refuse_all_but(self, taken: Collection[str], what: str) -> None:
        """Raises UserError for a setting that differs from its default and is not one of those taken."""
        for field in fields(self):
            if field.name not in taken and getattr(self, field.name) != field.default:
                name = field.name.replace("_", "-")
                raise UserError(f"picture: --{name} has no effect on {what}; leave it out")
