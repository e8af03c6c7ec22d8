"""The hair material of the path tracer: absorption of each hair, or along it, and the optics of the fibre."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.pigment import (
    AZIMUTHAL_ROUGHNESS,
    DEFAULT_COLOR,
    HAIR_COLORS,
    MELANIN,
    ROUGHNESS,
    TILT,
    HairColor,
    absorption_of,
    curve_reflectance,
    of_fiber,
)

STATIONS = 32  # least number of colours along a hair whose colour varies, where it has as many segments


def fiber_bsdf(mi: Any, hairs: Curves, color: HairColor | None) -> dict[str, Any]:
    """Material of hairs that are one shape, with a guard segment at its end.

    color: of all hairs; None for that of their attributes, or the default where they have none
    """
    if color is None and MELANIN not in hairs.curve and MELANIN not in hairs.point:
        color = HAIR_COLORS[DEFAULT_COLOR]
    reflectance = hair_reflectances(hairs, color)
    along = of_fiber(hairs, ROUGHNESS, color and color.roughness)
    around = of_fiber(hairs, AZIMUTHAL_ROUGHNESS, color and color.azimuthal_roughness)
    return {
        "type": "hair",
        "sigma_a": _texture(mi, absorption_of(reflectance, around), hairs.counts - 1, len(reflectance) != len(hairs)),
        "longitudinal_roughness": along,
        "azimuthal_roughness": around,
        "scale_tilt": of_fiber(hairs, TILT),
    }


def hair_reflectances(hairs: Curves, color: HairColor | None) -> NDArray[np.float64]:
    """Reflectance of a mass of each hair (linear r, g, b), shape (hairs, 3), or of each point if one varies along it.

    color: as in ``fiber_bsdf``
    """
    own = None if color is not None else curve_reflectance(hairs, "picture: hairs")
    return (color or HAIR_COLORS[DEFAULT_COLOR]).reflectances(hairs.ids) if own is None else own


def _texture(mi: Any, absorption: NDArray[np.float64], segments: NDArray[np.integer], along: bool) -> dict[str, Any]:
    """Texture of absorption with one texel for ``stride`` segments, in the order of the hairs.

    The second texture coordinate of curves runs over all segments of a shape. A texel never spans two hairs, since the
    stride divides their numbers of segments.

    absorption: a row for each hair, or for each point where ``along``
    segments:   of each hair, shape (hairs,)
    """
    stride = _stride(int(np.gcd.reduce(segments)), along)
    texels = segments // stride
    if along:
        first = np.concatenate([[0], np.cumsum(segments + 1)[:-1]])
        within = np.arange(texels.sum()) - np.repeat(np.cumsum(texels) - texels, texels)
        middle = np.repeat(first, texels) + within * stride + stride // 2
        rows = 0.5 * (absorption[middle] + absorption[middle + stride % 2])
    else:
        rows = np.repeat(absorption, texels, axis=0)
    rows = np.concatenate([rows, rows[-1:]])  # of the guard segment
    total = int(segments.sum()) + 1
    data = np.repeat(rows[:, None].astype(np.float32), 2, axis=1)  # a texture has at least two columns
    return {
        "type": "bitmap",
        "data": mi.TensorXf(data),
        "raw": True,
        "filter_type": "nearest",
        "wrap_mode": "clamp",
        "to_uv": mi.ScalarTransform3f().scale([1.0, total / (stride * len(rows))]),
    }


def _stride(common: int, along: bool) -> int:
    """Segments of a texel, a divisor of the common divisor of all numbers of segments."""
    if not along:
        return common
    divisors = (stride for stride in range(common, 0, -1) if common % stride == 0)
    return next((stride for stride in divisors if common // stride >= STATIONS), 1)
