"""Cases of the validation, and their rows."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Row:
    """One number of the validation.

    error: relative error, |got / expected − 1|
    """

    case: str
    expected: float
    got: float
    tolerance: float

    @property
    def error(self) -> float:
        return abs(self.got / self.expected - 1.0)

    @property
    def passed(self) -> bool:
        return bool(self.error <= self.tolerance)  # False for NaN

    def json(self) -> dict[str, Any]:
        """Plain values for ``ringlet validate --json``."""
        return {
            "case": self.case,
            "expected": self.expected,
            "got": self.got,
            "error": self.error,
            "tolerance": self.tolerance,
            "pass": self.passed,
        }


@dataclass(frozen=True)
class Case:
    """A known answer: ``title`` states it, ``run`` computes its rows."""

    name: str
    title: str
    run: Callable[[], Iterable[Row]]


def convergence(
    case: str,
    expected: float,
    measure: Callable[[int], float],
    resolutions: tuple[int, ...],
    tolerance: float,
    *,
    unit: str = "edges",
) -> list[Row]:
    """Rows of a quantity at increasing resolutions, and a row for its order of convergence.

    The scheme is second order: ``tolerance`` is that of the finest resolution, and coarser ones follow from it. There
    is no row for the order when the finest error is below the six digits of the expected values.
    """
    finest = resolutions[-1]
    rows = [Row(f"{case}, {n} {unit}", expected, measure(n), tolerance * (finest / n) ** 2) for n in resolutions]
    coarse, fine = rows[0].error, rows[-1].error
    if fine < 1e-6:
        return rows
    order = float(np.log(coarse / fine) / np.log(finest / resolutions[0]))
    return [*rows, Row(f"{case}, order", 2.0, order, 0.25)]
