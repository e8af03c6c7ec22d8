"""Hairs for the path tracer: round fibres along B-splines through the given points."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.groom import GROOM
from ringlet.data.pigment import AZIMUTHAL_ROUGHNESS, ROUGHNESS, TILT, fiber_rows

# Diameter of hairs without a width: that of a curly human hair [m].
DEFAULT_WIDTH = 70e-6

# Most points of a shape: a texture coordinate is one single-precision number over all of its segments.
MOST_POINTS = 2**22

FIBER_LEVELS = 4  # of a roughness, or of the tilt, that varies from hair to hair


def spline_controls(points: NDArray[np.floating]) -> NDArray[np.float64]:
    """Control points of uniform cubic B-splines that interpolate the given points.

    A B-spline runs inside its control polygon: with the points as controls, a curl of 12 points a turn would shrink by
    (1 - cos 30°)/3 = 4.5 %. At knot i the curve passes (cᵢ₋₁ + 4cᵢ + cᵢ₊₁)/6, with control points c. This is a
    tridiagonal system, closed by straight ends (c₋₁ = 2c₀ - c₁); all curves are eliminated at once.

    points: shape (curves, n, 3), n ≥ 2; returns shape (curves, n + 2, 3)
    """
    count, n, _ = points.shape
    values = np.asarray(points, np.float64).transpose(1, 0, 2).reshape(n, -1)
    inner = values.copy()
    share = np.zeros(n)
    for k in range(1, n - 1):
        share[k] = 1.0 / (4.0 - share[k - 1])
        inner[k] = share[k] * (6.0 * values[k] - inner[k - 1])
    for k in range(n - 2, 0, -1):
        inner[k] -= share[k] * inner[k + 1]
    controls = np.concatenate([2 * inner[:1] - inner[1:2], inner, 2 * inner[-1:] - inner[-2:-1]])
    return np.ascontiguousarray(controls.reshape(n + 2, count, -1).transpose(1, 0, 2))


def hair_widths(hairs: Curves) -> NDArray[np.floating]:
    """Diameter of hairs at each point [m], shape (n,)."""
    return hairs.point.get("width", np.full(len(hairs.points), DEFAULT_WIDTH))


def fibres(hairs: Curves, origin: NDArray[np.float64]) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """Control points relative to an origin, with radii (x, y, z, r) [m], shape (n, 4), and offsets (count + 1,)."""
    offsets = offsets_from_counts(hairs.counts + 2)
    controls = np.empty((offsets[-1], 4), np.float32)
    widths = hair_widths(hairs)
    for n in np.unique(hairs.counts):  # usually a single value
        chosen = np.flatnonzero(hairs.counts == n)
        rows = hairs.offsets[chosen, None] + np.arange(n)
        targets = offsets[chosen, None] + np.arange(n + 2)
        controls[targets, :3] = spline_controls(hairs.points[rows] - origin)
        controls[targets, 3] = 0.5 * np.pad(widths[rows], ((0, 0), (1, 1)), mode="edge")
    return controls, offsets


def split(hairs: Curves) -> list[Curves]:
    """Divides hairs into those of the shapes of a scene: one material each, and places that single precision resolves.

    Hairs keep their order within a shape.
    """
    kinds = _fiber_kinds(hairs)
    alike = [hairs.take(np.flatnonzero(kinds == kind)) for kind in np.unique(kinds)] if kinds.any() else [hairs]
    return [part for some in alike for part in _short(some)]


def _short(hairs: Curves) -> list[Curves]:
    """Parts of at most about MOST_POINTS points, each of one groom."""
    shapes = (hairs.offsets[1:] - 1) // MOST_POINTS
    groom = hairs.curve.get(GROOM, np.zeros(len(hairs), np.int32))
    borders = np.flatnonzero((np.diff(shapes) != 0) | (np.diff(groom) != 0)) + 1
    return [hairs.take(chosen) for chosen in np.split(np.arange(len(hairs)), borders)] if len(borders) else [hairs]


def _fiber_kinds(hairs: Curves) -> NDArray[np.int64]:
    """The kind of fiber of each hair: a level of each attribute that varies, as many hairs in each; 0 where none does.

    A material of Mitsuba has one roughness and one tilt.
    """
    kinds = np.zeros(len(hairs), np.int64)
    for name in (ROUGHNESS, AZIMUTHAL_ROUGHNESS, TILT):
        values = fiber_rows(hairs, name)
        if len(values) and np.ptp(values) > 0.0:
            borders = np.quantile(values, np.arange(1, FIBER_LEVELS) / FIBER_LEVELS)
            kinds = FIBER_LEVELS * kinds + np.searchsorted(borders, values, side="right")
    return kinds


def load_fibres(mi: Any, controls: NDArray[np.float32], offsets: NDArray[np.int32], bsdf: dict[str, Any]) -> Any:
    """Loads fibres as a Mitsuba shape.

    Mitsuba reads curves from text files only, and text is slow and loses precision. The file therefore defines only
    the number of points of each curve; the points are set as an array afterwards.

    A guard curve, too thin to be hit, ends the list. Mitsuba finds a segment by a single-precision number over all
    segments. At the tip of the last of a million curves that number would round up to a segment that does not exist.
    """
    guard = np.repeat(controls[-1:], 4, axis=0)
    guard[:, 1] += np.arange(4) * controls[-1, 3]
    guard[:, 3] *= 1e-5
    controls, offsets = np.concatenate([controls, guard]), np.append(offsets, offsets[-1] + 4)
    row, rows_before = b"0 0 0 1\n", np.diff(offsets)
    layout = b"\n".join(row * int(n) for n in rows_before)
    with tempfile.TemporaryDirectory(prefix="ringlet-") as folder:
        file = Path(folder) / "hairs.txt"
        file.write_bytes(layout)
        shape = mi.load_dict({"type": "bsplinecurve", "filename": str(file), "bsdf": bsdf})
    parameters = mi.traverse(shape)
    parameters["control_points"] = type(parameters["control_points"])(controls.ravel())
    parameters.update()
    return shape
