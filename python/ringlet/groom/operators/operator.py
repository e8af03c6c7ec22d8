"""What every operator of the stack is: settings with a formula."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet.curves import Curves
from ringlet.groom.random import Random
from ringlet.groom.scalp import Scalp
from ringlet.groom.settings import Section, Varied

UP = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True)
class Context:
    """What an operator may use besides the curves and its own settings.

    seed:        of the recipe
    scalp:       the surface that the curves grow on
    purpose:     a name of the operator that is its own in the stack; random numbers hang on it
    lock_points: points of a groom guide
    """

    seed: int
    scalp: Scalp
    purpose: str
    lock_points: int = 64

    def random(self, setting: str = "") -> Random:
        """Random numbers for one setting of this operator."""
        return Random(self.seed, f"{self.purpose}/{setting}")

    def values(self, name: str, setting: Varied, curves: Curves) -> NDArray[np.float64]:
        """A varied setting for each curve, shape (count,)."""
        return setting.per_curve(self.random(name), curves.ids, curves.roots)


class Operator(Section):
    """Takes curves, returns new ones; a pure function of curves, settings and context."""

    def apply(self, curves: Curves, context: Context) -> Curves:
        """The curves after this operator."""
        raise NotImplementedError


def grid(curves: Curves) -> NDArray[np.floating]:
    """Points of curves that all have the same count, shape (count, points, 3): what the shape operators work on."""
    return curves.points.reshape(len(curves), -1, 3)


def packed(curves: Curves) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Points and offsets as the core takes them."""
    return np.ascontiguousarray(curves.points, np.float64), np.ascontiguousarray(curves.offsets, np.int32)


def arc_lengths(points: NDArray) -> NDArray[np.floating]:
    """Length from the root to every point [m], shape (count, points), for points (count, points, 3)."""
    edges = np.linalg.norm(np.diff(points, axis=1), axis=2)
    return np.concatenate([np.zeros((len(points), 1)), np.cumsum(edges, axis=1)], axis=1)


def unit(vectors: NDArray) -> NDArray[np.float64]:
    """Vectors of length 1 along the last axis; zero stays zero."""
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)


def with_grid(curves: Curves, points: NDArray) -> Curves:
    """The same curves with other points, shape (count, points, 3)."""
    return curves.with_points(np.ascontiguousarray(points.reshape(-1, 3)))
