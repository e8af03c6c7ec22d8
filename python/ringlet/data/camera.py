"""A camera: where it is, what it looks at, and its lens."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, degrees

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Camera:
    """A perspective camera with a thin lens.

    origin:       position [m], shape (3,)
    axes:         right, up and backward directions, the rows of a (3, 3) array
    distance:     from the camera to the centre of the subject [m]
    slopes:       half the width and half the height of the picture, at unit distance
    shift:        slopes of the direction to the centre of the picture, against the optical axis
    focal_length: of the lens [m]
    f_stop:       focal length over the diameter of the aperture; 0 for a pinhole, which has everything in focus
    focus:        distance of the plane in focus [m]; None where it is not chosen
    """

    origin: NDArray[np.float64]
    axes: NDArray[np.float64]
    distance: float
    slopes: tuple[float, float]
    shift: tuple[float, float] = (0.0, 0.0)
    focal_length: float = 0.085
    f_stop: float = 0.0
    focus: float | None = None

    @property
    def target(self) -> NDArray[np.float64]:
        """Point on the optical axis at the subject's distance [m], shape (3,)."""
        return self.origin - self.distance * self.axes[2]

    @property
    def fov(self) -> float:
        """Horizontal field of view [degrees]."""
        return 2.0 * degrees(atan(self.slopes[0]))

    @property
    def aspect(self) -> float:
        """Width of the picture over its height."""
        return self.slopes[0] / self.slopes[1]

    @property
    def lens_radius(self) -> float:
        """Radius of the aperture [m]; 0 for a pinhole."""
        return 0.5 * self.focal_length / self.f_stop if self.f_stop else 0.0

    def depths(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """Distances of points (n, 3) along the optical axis [m], shape (n,)."""
        return (self.origin - points) @ self.axes[2]

    def project(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """Projects points (n, 3) to the picture: (0, 0) top left to (1, 1) bottom right; shape (n, 2)."""
        local = (points - self.origin) @ self.axes.T
        slopes = local[:, :2] / -local[:, 2:] - self.shift
        return 0.5 + 0.5 * slopes / self.slopes * (1.0, -1.0)
