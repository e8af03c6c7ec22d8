"""The direct solver on systems of strands in contact."""

from __future__ import annotations

import numpy as np
import pytest
from ringlet.sim.direct import open_pardiso

from ringlet import Curves, DirectSolver, Material, Strands, UserError

VERTICES = 20
METHODS = [
    "builtin",
    pytest.param("pardiso", marks=pytest.mark.skipif(not open_pardiso(), reason="ringlet[direct] is not installed")),
]


def coil(index: int) -> np.ndarray:
    turn = 2 * np.pi * np.arange(VERTICES) / 12 + index
    return np.c_[2.5e-3 * np.cos(turn) + 4e-3 * index, -5e-4 * turn, 2.5e-3 * np.sin(turn)]


def touching_coils(count: int = 6) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Triplets i, j with blocks, and the dense matrix, of coils in contact with their neighbours."""
    size = 3 * count * VERTICES
    dense = np.zeros((size, size))
    for k in range(count):
        rest = coil(k)
        strand = Strands(Curves(rest, np.array([0, VERTICES], np.int32), np.array([k])), Material())
        stretched = rest * (1.0, 1.2, 1.0)
        own = slice(3 * VERTICES * k, 3 * VERTICES * (k + 1))
        dense[own, own] = strand.energy(stretched, continuation="least_energy", hessian=True)[2]
    dense += 3e-6 * np.eye(size)  # about mass / dt²
    random = np.random.default_rng(5)
    for _ in range(count * VERTICES):
        first = random.integers(count - 1)
        edges = VERTICES * np.array([first, first + 1]) + random.integers(VERTICES - 1, size=2)
        normal = random.normal(size=3)
        s, t = random.uniform(size=2)
        push = np.zeros(size)
        for vertex, weight in zip([edges[0], edges[0] + 1, edges[1], edges[1] + 1], [1 - s, s, t - 1, -t], strict=True):
            push[3 * vertex : 3 * vertex + 3] = weight * normal / np.linalg.norm(normal)
        dense += 10 ** random.uniform(-1, 2) * np.outer(push, push)
    blocks = dense.reshape(size // 3, 3, size // 3, 3).swapaxes(1, 2)
    i, j = np.nonzero(np.triu(np.abs(blocks).max(axis=(2, 3))))
    return i, j, blocks[i, j], dense


@pytest.mark.parametrize("method", METHODS)
def test_solution_of_touching_strands_agrees_with_a_dense_solver(method):
    i, j, blocks, dense = touching_coils()
    solver = DirectSolver(i, j, len(dense) // 3, method=method)
    assert solver.method == method
    b = np.random.default_rng(2).normal(size=len(dense))
    for scale in (1.0, 3.0):  # reuses the symbolic factorisation
        assert solver.factor(scale * blocks)
        x, residual = solver.solve(b)
        assert np.linalg.norm(x - np.linalg.solve(scale * dense, b)) < 1e-9 * np.linalg.norm(x)
        assert residual < 1e-9


@pytest.mark.parametrize("method", METHODS)
def test_an_indefinite_matrix_is_reported(method):
    i, j, blocks, dense = touching_coils()
    solver = DirectSolver(i, j, len(dense) // 3, method=method)
    assert not solver.factor(-blocks)
    assert not solver.factor(np.where(np.arange(len(blocks))[:, None, None] == 5, np.nan, blocks))


@pytest.mark.skipif(open_pardiso(), reason="PARDISO is installed")
def test_a_missing_method_is_refused_with_its_remedy():
    with pytest.raises(UserError, match=r"pardiso.*pip install 'ringlet\[direct\]'"):
        DirectSolver(np.zeros(1), np.zeros(1), 1, method="pardiso")


def test_automatic_selects_an_installed_method():
    assert DirectSolver(np.zeros(1), np.zeros(1), 1).method == ("pardiso" if open_pardiso() else "builtin")
