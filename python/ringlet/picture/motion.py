"""Motion blur: poses between those at which the shutter opens and closes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ringlet.data.camera import Camera
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.picture.bodies import PosedBody

# The fractions of the shutter time at which passes see the scene are multiples of the golden ratio, modulo 1. Those of
# the even and of the odd passes then both cover the whole time, whatever their number.
GOLDEN = 0.6180339887498949


@dataclass(frozen=True)
class Pose:
    """What a camera sees at one time: posed bodies, hairs [m], and a camera of the stage, or None for another.

    grooms: names of the grooms that hairs are of, where there are several
    """

    bodies: Sequence[PosedBody]
    hairs: Curves
    camera: Camera | None = None
    grooms: Sequence[str] = ()

    def towards(self, other: Pose, fraction: float) -> Pose:
        """Linear interpolation towards a later pose. Raises UserError where the number of points changes."""
        bodies = []
        for body, later in zip(self.bodies, other.bodies, strict=False):
            points = _between(body.points, later.points, fraction, body.mesh.name)
            bodies.append(PosedBody(body.mesh, points, body.opacity))
        hairs = self.hairs.with_points(_between(self.hairs.points, other.hairs.points, fraction, "hairs"))
        camera = self.camera
        if camera is not None and other.camera is not None:
            camera = _turned(camera, other.camera, fraction)
        return Pose(bodies, hairs, camera, self.grooms)


def fraction_of_pass(number: int) -> float:
    """Fraction of the shutter time at which a pass sees the scene."""
    return (0.5 + GOLDEN * number) % 1.0


def _between(start: NDArray, end: NDArray, fraction: float, what: str) -> NDArray:
    if start.shape != end.shape:
        raise UserError(f"{what}: has {len(start)} points at one frame, {len(end)} at the next; leave out the shutter")
    return start + start.dtype.type(fraction) * (end - start)


def _turned(start: Camera, end: Camera, fraction: float) -> Camera:
    """Camera between two others; its axes are the rotation nearest to their mean."""
    left, _, right = np.linalg.svd((1.0 - fraction) * start.axes + fraction * end.axes)
    origin = (1.0 - fraction) * start.origin + fraction * end.origin
    return replace(start, origin=origin, axes=left @ right)
