"""The least of a quadratic function of forces that only push."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array, diags_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

Array = NDArray[np.float64]

ROUNDS = 200
PATIENCE = 3  # rounds in which no fewer forces are wrong before they are put right one by one
ROUNDING = 1e-9


def solve_nonnegative_qp(matrix: csr_array, slope: Array, free: NDArray[np.bool_]) -> Array:
    """The x at which ½ xᵀ A x + bᵀ x is least, none of it negative but what is free; shape (n,).

    matrix: A, symmetric and positive definite, sparse, shape (n, n)
    slope:  b, shape (n,)

    Each force either acts or does not; those that would pull, or that would take energy away if they acted, change
    over, all at once, until there is none. Where that goes round in a circle only the last of them does. Parts that the
    matrix does not couple are on their own. Block principal pivoting: Júdice & Pires 1994.
    """
    scale = 1.0 / np.sqrt(matrix.diagonal())
    scaled = diags_array(scale)
    a, b = (scaled @ matrix @ scaled).tocsr(), scale * slope
    parts, part = connected_components(a, directed=False)
    enough = ROUNDING * np.maximum(_most(np.abs(b), part, parts), 1e-300)[part]
    acts, x = free.copy(), np.zeros(len(b))
    fewest, patience = np.full(parts, len(b) + 1), np.full(parts, PATIENCE)
    for _ in range(ROUNDS):
        x[:] = 0.0
        inside = np.flatnonzero(acts)
        if inside.size:
            x[inside] = _solved(a[inside][:, inside], -b[inside])
        wrong = ~free & np.where(acts, x < -enough, a @ x + b < -enough)
        if not wrong.any():
            break
        count = np.bincount(part[wrong], minlength=parts)
        fewer = count < fewest
        patience = np.where(fewer, PATIENCE, patience - 1)
        fewest = np.minimum(fewest, count)
        last = np.full(parts, -1)
        last[part[wrong]] = np.flatnonzero(wrong)  # of each part, the last is kept
        acts ^= wrong & ((patience >= 0)[part] | (np.arange(len(b)) == last[part]))
    return scale * np.where(free, x, np.maximum(x, 0.0))


def _solved(matrix: csr_array, right: Array) -> Array:
    """The solution of A x = b; where A is symmetric and positive definite, rows need not be exchanged."""
    factor = splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return factor.solve(right)


def _most(values: Array, part: NDArray[np.int32], parts: int) -> Array:
    """The largest of the values of each part."""
    most = np.zeros(parts)
    np.maximum.at(most, part, values)
    return most
