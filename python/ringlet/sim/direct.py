"""Direct solution of sparse systems of blocks."""

from __future__ import annotations

from functools import cache
from importlib.metadata import PackageNotFoundError, files
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.errors import UserError

Method = Literal["automatic", "builtin", "pardiso"]


class DirectSolver:
    """Solves sparse symmetric positive definite systems of one pattern by factoring them.

    i, j:   block rows and columns of the triplets, shape (k,) each; an off-diagonal one stands for its mirror image too
    rows:   of blocks in the matrix
    block:  rows of a block: 1, 3 or 4
    method: ``builtin``, ``pardiso`` (of the extra ``ringlet[direct]``), or ``automatic``: PARDISO where it is installed
    """

    def __init__(
        self, i: NDArray[np.integer], j: NDArray[np.integer], rows: int, block: int = 3, method: Method = "automatic"
    ) -> None:
        if not open_pardiso() and method == "pardiso":
            raise UserError("direct solver: method is pardiso, which is not installed: pip install 'ringlet[direct]'")
        indices = (np.ascontiguousarray(i, np.int32), np.ascontiguousarray(j, np.int32))
        self._core = _core.DirectSolver(*indices, rows, block, getattr(_core.DirectMethod, method))

    @property
    def method(self) -> str:
        """The method in use: builtin or pardiso."""
        return self._core.method.name

    @property
    def entries(self) -> int:
        """Numbers in the factor, after ``factor``."""
        return self._core.entries

    def factor(self, triplets: NDArray[np.floating]) -> bool:
        """Takes the blocks of the triplets, shape (k, block, block); says whether the matrix is positive definite."""
        return self._core.factor(np.ascontiguousarray(triplets, np.float64))

    def solve(self, b: NDArray[np.floating]) -> tuple[NDArray[np.float64], float]:
        """The solution of shape (rows · block,), and its relative residual ‖b − A x‖ / ‖b‖, measured."""
        return self._core.solve(np.ascontiguousarray(b, np.float64))


@cache
def open_pardiso() -> bool:
    """Whether PARDISO can be used: MKL as the package index has it, or as the system finds it by name."""
    try:
        libraries = [file for file in files("mkl") or () if file.name.startswith(("libmkl_rt.so", "mkl_rt."))]
    except PackageNotFoundError:
        libraries = []
    return any(_core.open_pardiso(str(library.locate())) for library in libraries) or _core.open_pardiso()
