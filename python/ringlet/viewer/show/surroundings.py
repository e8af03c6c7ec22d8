"""Surroundings of an HDRI as the live picture draws them: even light, and lamps where they are brighter.

The even light is that of all directions up to the median luminance. What is brighter is divided into at most four
groups of directions (k-means). Each becomes a round lamp of the direction, irradiance and spread of its group.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.viewer.protocol import Lamp

LAMPS = 4
ROWS = 64  # of the picture that is divided
ROUNDS = 12  # of k-means
FAINTEST = 0.01  # part of all light, below which a lamp is left out
NARROWEST, WIDEST = np.pi / ROWS, 1.8  # diameter of a lamp over its distance
APART = np.cos(np.radians(35.0))  # between the first directions of two groups
FAR = 100.0  # distance of lamps: their light is the same everywhere
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])

Colors = NDArray[np.float64]


def lamps_and_sky(radiance: NDArray[np.floating]) -> tuple[list[Lamp], tuple[float, float, float]]:
    """Lamps, and the radiance of the even light (linear r, g, b).

    radiance: in latitude and longitude, as of ``read_surroundings``, shape (height, width, 3)
    """
    colors, directions, angles = _texels(radiance)
    luminance = colors @ LUMINANCE
    even = np.minimum(1.0, _median(luminance, angles) / np.maximum(luminance, 1e-9))[:, None]
    power = (colors - even * colors) * angles[:, None]
    sky = (even * colors * angles[:, None]).sum(axis=0) / (4.0 * np.pi)
    least = FAINTEST * (luminance * angles).sum()
    weights = power @ LUMINANCE
    groups = _groups(directions, weights, least)
    chosen = [groups == group for group in range(LAMPS)]
    lamps = [_lamp(directions[one], power[one], angles[one]) for one in chosen if weights[one].sum() > least]
    return lamps, (float(sky[0]), float(sky[1]), float(sky[2]))


def _texels(radiance: NDArray[np.floating]) -> tuple[Colors, NDArray[np.float64], NDArray[np.float64]]:
    """Mean colors, directions and solid angles [sr] of the texels of a coarser picture, one a row."""
    height, width = (min(size, most) for size, most in zip(radiance.shape[:2], (ROWS, 2 * ROWS), strict=True))
    polar = np.pi * (np.arange(radiance.shape[0]) + 0.5) / radiance.shape[0]
    weighted = np.sin(polar)[:, None, None] * radiance.astype(np.float64)
    rows, columns = (
        np.arange(count) * size // count for count, size in zip((height, width), radiance.shape, strict=False)
    )
    sums = np.add.reduceat(np.add.reduceat(weighted, rows, axis=0), columns, axis=1)
    weights = np.add.reduceat(np.sin(polar), rows)[:, None] * np.diff([*columns, radiance.shape[1]])
    theta = np.pi * (np.arange(height) + 0.5) / height
    phi = 2.0 * np.pi * (0.5 - (np.arange(width) + 0.5) / width)  # azimuth from +Z to +X, which is on the left
    across = np.sin(theta)[:, None]
    up = np.broadcast_to(np.cos(theta)[:, None], (height, width))
    directions = np.stack([across * np.sin(phi), up, across * np.cos(phi)], axis=2)
    angles = weights / weights.sum() * 4.0 * np.pi
    return (sums / weights[:, :, None]).reshape(-1, 3), directions.reshape(-1, 3), angles.ravel()


def _median(values: NDArray[np.float64], weights: NDArray[np.float64]) -> float:
    order = np.argsort(values, kind="stable")
    total = np.cumsum(weights[order])
    return float(values[order[np.searchsorted(total, 0.5 * total[-1])]])


def _groups(directions: NDArray[np.float64], weights: NDArray[np.float64], least: float) -> NDArray[np.intp]:
    """Group of each direction. Another group begins where light above ``least`` is far from the others."""
    centres = directions[[int(np.argmax(weights))]]
    while len(centres) < LAMPS:
        far = np.where((directions @ centres.T).max(axis=1) < APART, weights, 0.0)
        if far.sum() <= least:
            break
        centres = np.vstack([centres, directions[int(np.argmax(far))]])
    groups = np.argmax(directions @ centres.T, axis=1)
    for _ in range(ROUNDS):
        for group in range(len(centres)):
            mean = weights[groups == group] @ directions[groups == group]
            if (length := np.linalg.norm(mean)) > 0.0:
                centres[group] = mean / length
        groups = np.argmax(directions @ centres.T, axis=1)
    return groups


def _lamp(directions: NDArray[np.float64], power: Colors, angles: NDArray[np.float64]) -> Lamp:
    """The lamp of a group. power: radiance times solid angle of each direction; angles: solid angles [sr]"""
    weights = power @ LUMINANCE
    mean = weights @ directions
    towards = mean / np.linalg.norm(mean)
    strength = np.maximum(directions @ towards, 0.0) @ power
    bright = weights**2 / angles  # weighted by radiance, so that a sky around the sun does not widen it
    length = float(np.linalg.norm(bright @ directions) / bright.sum())
    angle = np.arccos(np.clip(2.0 * length - 1.0, -1.0, 1.0))  # the mean of a disk is (1 + cos angle) / 2 long
    return Lamp(
        azimuth=float(np.degrees(np.arctan2(towards[0], towards[2]))),
        elevation=float(np.degrees(np.arcsin(np.clip(towards[1], -1.0, 1.0)))),
        size=float(np.clip(2.0 * np.tan(min(angle, 1.5)), NARROWEST, WIDEST)),
        strength=(float(strength[0]), float(strength[1]), float(strength[2])),
        distance=FAR,
    )
