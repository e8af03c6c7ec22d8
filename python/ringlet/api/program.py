"""Known answers and benchmarks."""

from __future__ import annotations

import importlib.util
import inspect
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet import validate
from ringlet.api.progress import Progress
from ringlet.data.settings import check_name
from ringlet.data.share import share
from ringlet.shot.solver import Solver
from ringlet.validate import Row, nest


def run_validation(cases: Sequence[str] | None = None, *, progress: Progress | None = None) -> list[Row]:
    """Compares the simulator with known answers: all cases, or the named ones."""
    chosen = list(validate.CASES) if cases is None else list(cases)
    for name in chosen:
        check_name(name, validate.CASES, "validate", "case")
    rows = []
    for index, name in enumerate(chosen):
        rows += validate.run_case(name)
        if progress:
            progress("known answers", index + 1, len(chosen))
    return rows


def run_bench(name: str, **params: Any) -> dict[str, Any]:
    """Runs the benchmark of that name with its parameters; returns what it measured."""
    folder = share("bench")
    files = {file.stem: file for file in sorted(folder.glob("*.py"))}
    check_name(name, files, "bench", "benchmark")
    spec = importlib.util.spec_from_file_location(f"ringlet_bench_{name}", files[name])
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.path.insert(0, str(folder))  # as for a script: benchmarks may share what is in this folder
    try:
        spec.loader.exec_module(module)
    finally:
        sys.path.remove(str(folder))
    taken = inspect.signature(module.run).parameters
    for key in params:
        check_name(key, taken, f"bench {name}", "parameter")
    return module.run(**params)


def swing_nest(rings: int, solver: Solver | None = None, friction: float = 0.0) -> NDArray[np.float64]:
    """Swings a nest of coils in contact for 8 frames; returns the displacement of each tip [m], (frames, coils, 3).

    rings:  of coils about the one in the middle: 1, 3, 5 and 8 are 7, 37, 91 and 217 coils
    solver: of every step; by default one that converges, the reference for others
    """
    return nest.tips(nest.locks(nest.hexagon(rings), nest.WIDTH), solver or nest.CONVERGED, friction)
