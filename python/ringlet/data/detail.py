"""Levels of detail of hairs: fewer and wider hairs, which cover as much as all of them.

Far from the camera a share of the elements, each larger by the inverse of the share, stands for all (Cook, Halstead,
Planck and Ryu, "Stochastic simplification of aggregate detail", 2007).
"""

from __future__ import annotations

from dataclasses import dataclass

from ringlet.data.camera import Camera

LEAST_SHARE = 0.001  # of the hairs
HAIR_PIXELS = 0.5  # width of hairs on the screen up to which they are thinned out and widened


@dataclass(frozen=True)
class Level:
    """A level of detail.

    share:  part of the hairs
    points: part of the points of a hair
    """

    share: float
    points: float


# LOD0, LOD1, …. Points are thinned as long as the curl stays: half of the usual 8 points a turn.
LEVELS = (Level(1.0, 1.0), Level(1 / 3, 2 / 3), Level(0.1, 0.5), Level(0.05, 0.5))


def screen_share(width: float, depth: float, camera: Camera, pixels: int) -> float:
    """Share of the hairs that a camera needs, whose widths reach ``HAIR_PIXELS`` with the inverse factor.

    width:  of a hair [m]
    depth:  of the nearest hair along the optical axis [m]
    pixels: width of the picture
    """
    if depth <= 0.0:
        return 1.0
    on_screen = width / (2.0 * camera.slopes[0] * depth) * pixels
    return min(1.0, max(LEAST_SHARE, on_screen / HAIR_PIXELS))
