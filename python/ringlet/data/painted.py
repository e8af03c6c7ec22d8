"""Painted values: on the locks, on the scalp as primvars, or as textures over it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh
from ringlet.data.quantities import Quantity, Varied
from ringlet.data.random import Random
from ringlet.data.settings import did_you_mean


def per_lock(
    settings: BaseModel, name: str, random: Random, curves: Curves, scalp: Mesh, what: str
) -> NDArray[np.float64]:
    """A varied setting for each curve, shape (count,): its value in the region of the root, varied by chance and by
    noise, times its map. The values of single locks count as they are.

    What chance makes of the value stays within the bounds of the setting. A map may saturate a part of a whole (up to
    1), and raises UserError where it takes another value beyond its bounds, at the peak of its ramp.

    name: the setting of ``settings``
    what: its name for messages
    """
    setting: Varied = getattr(settings, name)
    bounds = Quantity.of(settings, name)
    peak = setting.peak if bounds.product else 1.0
    value = np.full(len(curves), setting.value)
    for name, there in setting.region.items():
        value[in_region(name, curves, scalp, f"{what}.region")] = there
    chance = setting.factors(random, curves.ids, curves.roots) if setting.by_chance else 1.0
    if setting.map is None:
        value = bounds.clipped(value * chance, peak)
    else:
        painting = painted(setting.map, curves, scalp, f"{what}.map")
        with np.errstate(over="ignore"):
            bad = np.flatnonzero(bounds.exceeded(value * painting * peak))
        if bad.size and not bounds.is_part:
            raise UserError(
                f"{what} is {value[bad[0]] * painting[bad[0]] * peak:.6g}{bounds.suffix} on lock {curves.ids[bad[0]]}, "
                f"by its map '{setting.map}'; must be at most {bounds.most:.6g}{bounds.suffix}, paint it again"
            )
        value = bounds.clipped(value * chance * painting, peak)
    for lock, own in setting.lock.items():
        value[curves.ids == lock] = own
    return value


def painted(name: str, curves: Curves, scalp: Mesh, what: str) -> NDArray[np.float64]:
    """The values painted under a name: on each curve itself, or on the scalp at its root; shape (count,)."""
    own = {key for key, values in curves.curve.items() if values.ndim == 1 and values.dtype.kind == "f"}
    if name in own:
        values = np.asarray(curves.curve[name], np.float64)
    elif name in scalp.textures:
        values = _from_texture(name, curves, scalp, what, scalp.textures[name].at)
    elif name in scalp.gradients:
        corners = scalp.points[scalp.triangles[curves.curve["root_triangle"]]]
        values = scalp.gradients[name](np.einsum("kc,kcx->kx", curves.curve["root_barycentric"], corners))
    elif name in scalp.maps:
        corners = scalp.maps[name][curves.curve["root_triangle"]]
        within = np.maximum(curves.curve["root_barycentric"], 0.0)  # rounding leaves roots on edges just outside
        values = np.einsum("kc,kc->k", corners, within)
    else:
        known = sorted(own | scalp.textures.keys() | scalp.gradients.keys() | scalp.maps.keys())
        remedy = (
            did_you_mean(name, known)
            if known
            else "; paint a primvar of floats, name a picture in [maps], or add [gradients]"
        )
        raise UserError(f"{what} is '{name}', which neither the locks nor {scalp.name} have{remedy}")
    if (bad := np.flatnonzero(~(np.isfinite(values) & (values >= 0.0)))).size:
        raise UserError(
            f"{what} '{name}' is {values[bad[0]]:g} on lock {curves.ids[bad[0]]}; must be at least 0 and finite, "
            "paint it again"
        )
    return values


def painted_directions(name: str, curves: Curves, scalp: Mesh, what: str) -> NDArray[np.float64]:
    """The directions painted on the scalp under a name, at the root of each curve; shape (count, 3)."""
    if name in scalp.textures and scalp.textures[name].colored:
        return _from_texture(name, curves, scalp, what, scalp.textures[name].directions_at)
    if name not in scalp.vectors:
        remedy = did_you_mean(name, scalp.vectors) if scalp.vectors else "; paint a primvar of vectors"
        raise UserError(f"{what} is '{name}', which {scalp.name} has no directions for{remedy}")
    corners = scalp.vectors[name][curves.curve["root_triangle"]]
    directions = np.einsum("kcx,kc->kx", corners, curves.curve["root_barycentric"])
    if (bad := np.flatnonzero(~np.isfinite(directions).all(axis=1))).size:
        raise UserError(f"{what} '{name}' is not finite at the root of lock {curves.ids[bad[0]]}; paint it again")
    return directions


def in_region(name: str, curves: Curves, scalp: Mesh, what: str) -> NDArray[np.bool_]:
    """The curves with their root in a named region of the scalp, as a mask of shape (count,)."""
    return np.isin(curves.curve["root_triangle"], region(name, scalp, what))


def region(name: str, scalp: Mesh, what: str) -> NDArray[np.int32]:
    """The triangles of a named region; ``what`` names the setting in the message."""
    try:
        return np.ascontiguousarray(scalp.region(name), np.int32)
    except KeyError as error:
        raise UserError(f"{what}: {error.args[0]}") from None


def _from_texture(
    name: str,
    curves: Curves,
    scalp: Mesh,
    what: str,
    read: Callable[[NDArray[np.integer], NDArray[np.integer]], NDArray[np.float64]],
) -> NDArray[np.float64]:
    """A texture at the roots, linear between its pixels; beyond its edges it repeats.

    read: gives the values of pixels by row and column, numbers or vectors
    """
    if scalp.uv is None:
        raise UserError(f"{what} is '{name}', a picture, but {scalp.name} has no texture coordinates; unwrap it")
    picture = scalp.textures[name]
    rows, columns = picture.shape
    uv = np.einsum("kcx,kc->kx", scalp.uv[curves.curve["root_triangle"]], curves.curve["root_barycentric"])
    if (bad := np.flatnonzero(~np.isfinite(uv).all(axis=1))).size:
        raise UserError(
            f"{what} is '{name}', a picture, but {scalp.name} has texture coordinates that are no numbers at the root "
            f"of lock {curves.ids[bad[0]]}; unwrap it again"
        )
    at = np.stack([(1.0 - uv[:, 1]) * rows, uv[:, 0] * columns], axis=1) - 0.5  # the first row is the upper one
    low = np.floor(at)
    (t, s), (i, j) = (at - low).T, np.mod(low, (rows, columns)).astype(np.int64).T
    near = read(np.stack([i, i, i + 1, i + 1]), np.stack([j, j + 1, j, j + 1]))
    t, s = (one.reshape(-1, *[1] * (near.ndim - 2)) for one in (t, s))
    return (1.0 - t) * ((1.0 - s) * near[0] + s * near[1]) + t * ((1.0 - s) * near[2] + s * near[3])
