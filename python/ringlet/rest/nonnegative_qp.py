"""The nonnegative quadratic program, by block principal pivoting (Júdice & Pires 1994)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array, diags_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

Array = NDArray[np.float64]

ROUNDS = 200
PATIENCE = 3  # rounds in which no fewer unknowns are infeasible before they are exchanged one by one
ROUNDING = 1e-9


def solve_nonnegative_qp(matrix: csr_array, gradient: Array, free: NDArray[np.bool_]) -> Array:
    """The x that minimises ½ xᵀ A x + bᵀ x, with x ≥ 0 but for what is free; shape (n,).

    matrix:   A, symmetric and positive definite, sparse, shape (n, n)
    gradient: b, shape (n,)

    Each unknown is either passive, and solved for, or zero. Unknowns that come out negative, or whose increase from
    zero would lower the objective, are exchanged, all at once, until there are none. Where that cycles only the last of
    them is. Components that the matrix does not couple proceed on their own.
    """
    scale = 1.0 / np.sqrt(matrix.diagonal())
    scaled = diags_array(scale)
    a, b = (scaled @ matrix @ scaled).tocsr(), scale * gradient
    count, component = connected_components(a, directed=False)
    tolerance = ROUNDING * np.maximum(_largest(np.abs(b), component, count), 1e-300)[component]
    passive, x = free.copy(), np.zeros(len(b))
    fewest, patience = np.full(count, len(b) + 1), np.full(count, PATIENCE)
    for _ in range(ROUNDS):
        x[:] = 0.0
        inside = np.flatnonzero(passive)
        if inside.size:
            x[inside] = _solved(a[inside][:, inside], -b[inside])
        infeasible = ~free & np.where(passive, x < -tolerance, a @ x + b < -tolerance)
        if not infeasible.any():
            break
        number = np.bincount(component[infeasible], minlength=count)
        patience = np.where(number < fewest, PATIENCE, patience - 1)
        fewest = np.minimum(fewest, number)
        last = np.full(count, -1)
        last[component[infeasible]] = np.flatnonzero(infeasible)  # of each component, the last is kept
        passive ^= infeasible & ((patience >= 0)[component] | (np.arange(len(b)) == last[component]))
    return scale * np.where(free, x, np.maximum(x, 0.0))


def _solved(matrix: csr_array, right: Array) -> Array:
    """The solution of A x = b; where A is symmetric and positive definite, rows need not be exchanged."""
    factor = splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return factor.solve(right)


def _largest(values: Array, component: NDArray[np.int32], count: int) -> Array:
    """The largest value of each component."""
    largest = np.zeros(count)
    np.maximum.at(largest, component, values)
    return largest
