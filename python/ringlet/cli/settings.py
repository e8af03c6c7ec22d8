"""Options of all commands that take pictures: the settings of ``ringlet.PictureSettings``."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from typing import Annotated, Any

import typer

import ringlet


def setting(name: str, kind: Any, help: str, metavar: str | None = None, unit: float = 1.0) -> inspect.Parameter:
    """An option for a setting, within its bounds.

    unit: a value of 1 of the option, in the unit of the setting
    """
    default = getattr(ringlet.PictureSettings, name)
    bounds: dict[str, Any] = {}
    if name in ringlet.PictureSettings.bounds:
        least, most = (bound / unit for bound in ringlet.PictureSettings.bounds[name])
        bounds = {"min": int(least), "max": int(most)} if kind is int else {"min": least, "max": most}
    option = typer.Option(
        f"--{name.replace('_', '-')}", metavar=metavar, help=help, show_default=default is not None, **bounds
    )
    annotation = Annotated[kind if default is not None else kind | None, option]
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=annotation)


CENTIMETRE = 0.01  # [m]
SETTINGS = [
    setting("width", int, "Pixels across."),
    setting("height", int, "Pixels down; by default ten ninths of the width, or in the camera's proportions."),
    setting("samples", int, "Light paths per pixel: more is cleaner and slower."),
    setting("seconds", float, "Time limit: no samples are added after that long."),
    setting("color", str, "black, dark_brown, brown, auburn, ginger, blond, gray or white; by default the hair's own."),
    setting("bounces", int, "Largest number of bounces of light; light hair needs 32."),
    setting("view", str, "three_quarter, front, side, back, or two angles such as 90,4.", "VIEW"),
    setting("camera", str, "A camera of the stage, with its lens and its focus, in place of the view.", "PRIM"),
    setting("look_at", int, "Close-up of a lock, by its id, from outside of the head or from the view.", "LOCK"),
    setting("distance", float, "From the camera to what it looks at; all of it is seen by default.", "CM", CENTIMETRE),
    setting("focal_length", float, "Of the lens, for a sensor of 36 mm; 85 by default.", "MM"),
    setting("f_stop", float, "Depth of field: focal length over aperture, such as 2.8; 0 has all in focus."),
    setting("focus", float, "Distance in focus; by default the nearest in the middle.", "CM", CENTIMETRE),
    setting("light", str, "studio, window, sun, or an HDRI: an .exr or .hdr file.", "LIGHT"),
    setting("light_turn", float, "Turns the light about the vertical, counter-clockwise from above.", "DEGREES"),
    setting("light_layers", bool, "Each light in layers of its own, in an EXR; takes as many pictures.", None),
    setting("background", str, "studio or transparent."),
    setting("shutter", float, "Motion blur: 180 has the shutter open for half a frame.", "DEGREES"),
    setting("denoiser", str, "oidn (Intel Open Image Denoise, the default where it is installed) or none."),
    setting("engine", str, "scalar, or llvm: compiled, by a library of LLVM 17 or newer."),
]
UNITS = {"distance": CENTIMETRE, "focus": CENTIMETRE}


def with_settings(**defaults: Any) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Gives a command the options of all settings; it takes their values as the argument ``settings``.

    defaults: of the command, where they are not those of a still
    """
    options = [p.replace(default=defaults.get(p.name, p.default)) for p in SETTINGS]

    def decorate(command: Callable[..., None]) -> Callable[..., None]:
        signature = inspect.signature(command, eval_str=True)
        own = [parameter for parameter in signature.parameters.values() if parameter.name != "settings"]

        @functools.wraps(command)
        def called(**values: Any) -> None:
            settings = {option.name: values.pop(option.name) for option in options}
            for name, unit in UNITS.items():
                settings[name] = None if settings[name] is None else unit * settings[name]
            command(**values, settings=settings)

        keyword = [parameter.replace(kind=inspect.Parameter.KEYWORD_ONLY) for parameter in own]
        called.__signature__ = signature.replace(parameters=[*keyword, *options])  # pyright: ignore
        called.__annotations__ = {parameter.name: parameter.annotation for parameter in [*own, *options]}
        return called

    return decorate
