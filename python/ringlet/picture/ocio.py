"""Colour management by OpenColorIO: the configuration that the environment variable ``OCIO`` names.

Light is computed with the primaries of Rec. 709. Pictures are shown by the default view of the default display of the
configuration, and EXR files are in its role ``scene_linear``.
"""

from __future__ import annotations

import os
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError

# Names and aliases of linear light with the primaries of Rec. 709, of usual configurations.
LINEAR = ("lin_rec709_scene", "lin_rec709", "lin_srgb", "Linear Rec.709 (sRGB)", "Utility - Linear - sRGB")


def configured() -> str:
    """The configuration of the environment; empty for none."""
    return os.environ.get("OCIO", "")


def displayed(light: NDArray[np.floating]) -> NDArray[np.float32]:
    """Linear light (height, width, 3) as the default view shows it, encoded for the display, from 0 to 1."""
    ocio, config = _config()
    source, display = _linear(config), config.getDefaultDisplay()
    view = ocio.DisplayViewTransform(src=source, display=display, view=config.getDefaultView(display))
    return np.clip(_applied(config, view, light), 0.0, 1.0)


def scene_linear(light: NDArray[np.floating]) -> NDArray[np.float32]:
    """Linear light (height, width, 3) in the role ``scene_linear`` of the configuration; as it is without one."""
    if not configured():
        return np.asarray(light, np.float32)
    ocio, config = _config()
    if not config.hasRole("scene_linear"):
        return np.asarray(light, np.float32)
    return _applied(config, ocio.ColorSpaceTransform(src=_linear(config), dst="scene_linear"), light)


def _config() -> tuple[Any, Any]:
    try:
        ocio = import_module("PyOpenColorIO")
    except ImportError:
        raise UserError(
            f"OCIO is {configured()}, but OpenColorIO is not installed; try: pip install 'ringlet[ocio]', or unset the "
            "variable"
        ) from None
    try:
        return ocio, ocio.Config.CreateFromEnv()
    except ocio.Exception as error:
        reason = next(iter(str(error).splitlines()), "it is damaged")
        raise UserError(
            f"OCIO is {configured()}: cannot be read ({reason[:120]}); name another, or unset the variable"
        ) from None


def _linear(config: Any) -> str:
    for name in LINEAR:
        if (space := config.getColorSpace(name)) is not None:
            return space.getName()
    raise UserError(
        f"OCIO is {configured()}: has no linear colour space of Rec. 709, such as {LINEAR[0]}; name another, or unset "
        "the variable"
    )


def _applied(config: Any, transform: Any, light: NDArray[np.floating]) -> NDArray[np.float32]:
    pixels = np.ascontiguousarray(light, np.float32).copy()
    config.getProcessor(transform).getDefaultCPUProcessor().applyRGB(pixels)
    return pixels
