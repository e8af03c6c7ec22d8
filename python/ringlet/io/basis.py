"""Evaluation of cubic curves as polylines: Bézier, B-spline and Catmull-Rom, nonperiodic or pinned."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import offsets_from_counts
from ringlet.data.errors import UserError

STEPS = 6  # points per segment of a cubic curve

# One row per power of t, one column per control point, after the reference of UsdGeomBasisCurves.
_BASES = {
    "bezier": np.array([[1, 0, 0, 0], [-3, 3, 0, 0], [3, -6, 3, 0], [-1, 3, -3, 1]], float),
    "bspline": np.array([[1, 4, 1, 0], [-3, 0, 3, 0], [3, -6, 3, 0], [-1, 3, -3, 1]]) / 6.0,
    "catmullRom": np.array([[0, 2, 0, 0], [-1, 0, 1, 0], [2, -5, 4, -1], [-1, 3, -3, 1]]) / 2.0,
}


class Sampling:
    """Interpolation from the control points of curves to the points of polylines.

    kind:   ``linear`` or ``cubic``
    basis:  ``bezier``, ``bspline`` or ``catmullRom``, of cubic curves
    wrap:   ``nonperiodic`` or ``pinned``
    counts: control points of each curve, shape (count,)

    Raises UserError for periodic curves, an unknown basis, and point counts that do not fit the basis.
    """

    def __init__(self, kind: str, basis: str, wrap: str, counts: NDArray, where: str) -> None:
        if wrap == "periodic":
            raise UserError(
                f"{where}: wrap is periodic; must be nonperiodic or pinned, since hairs have a root and a tip"
            )
        self.offsets_in = offsets_from_counts(counts)
        pinned = wrap == "pinned" and basis != "bezier"
        self.identity = kind == "linear" or (pinned and basis == "catmullRom")
        self.pinned = pinned and not self.identity
        if self.identity:
            self.segments, self.offsets = counts - 1, self.offsets_in
            return

        if basis not in _BASES:
            raise UserError(f"{where}: basis is {basis}; must be bezier, bspline or catmullRom: convert the curves")
        stride, least = (3, 4) if basis == "bezier" else (1, 2 if pinned else 4)
        if (bad := np.flatnonzero((counts < least) | ((counts - 1) % stride != 0))).size:
            rule = "4, 7, 10 …" if stride == 3 else f"at least {least}"
            raise UserError(
                f"{where}: curve {bad[0]} has {counts[bad[0]]} points; {wrap} {basis} curves must have {rule}"
            )
        controls = counts + 2 if self.pinned else counts  # a phantom point at each end
        self.segments = (controls - 4) // stride + 1
        self.offsets = offsets_from_counts(self.segments * STEPS + 1)

        # For each sample: its segment, the first control point of the segment, and t within it (1 at a curve's end).
        curve = np.repeat(np.arange(len(counts)), np.diff(self.offsets))
        along = np.arange(self.offsets[-1]) - self.offsets[curve]
        segment = np.minimum(along // STEPS, self.segments[curve] - 1)
        self.t = (along - segment * STEPS) / STEPS
        self.curve, self.segment = curve, segment
        self.first = offsets_from_counts(controls)[curve] + segment * stride
        powers = self.t[:, None] ** np.arange(4)
        self.weights = powers @ _BASES[basis]

    def vertex(self, values: NDArray) -> NDArray:
        """Interpolates values on vertices, shape (n, …), to the points."""
        if self.identity:
            return values
        controls = self._with_phantoms(values) if self.pinned else values
        rows = controls[self.first[:, None] + np.arange(4)].astype(np.float64)
        return np.einsum("sk,sk...->s...", self.weights, rows)

    def varying(self, values: NDArray) -> NDArray:
        """Interpolates values on the ends of segments linearly to the points."""
        if self.identity:
            return values
        start = offsets_from_counts(self.segments + 1)[self.curve] + self.segment
        t = self.t.reshape(-1, *[1] * (values.ndim - 1))
        return (1.0 - t) * values[start] + t * values[start + 1]

    def _with_phantoms(self, values: NDArray) -> NDArray:
        """Adds a phantom point at both ends of every curve, so that pinned curves reach their ends."""
        first, last = self.offsets_in[:-1], self.offsets_in[1:] - 1
        before = 2.0 * values[first] - values[first + 1]
        after = 2.0 * values[last] - values[last - 1]
        places = np.concatenate([first, np.arange(len(values)), last + 1])
        order = np.argsort(places + np.repeat([-0.5, 0.0, -0.75], [len(first), len(values), len(last)]), kind="stable")
        return np.concatenate([before, values, after])[order]
