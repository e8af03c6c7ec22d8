"""Strands in a batch: independent of each other, of the number of threads and of the instruction set."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
from coils import helix
from ringlet.data.curves import Curves
from ringlet.shot import Material
from ringlet.sim import Strands

from ringlet import _core

FRAME = 1 / 24


def test_strands_of_different_lengths_move_independently():
    counts = [20, 57, 33, 100, 8, 41, 64, 12, 29, 5]
    curves = [helix(n, hand=(-1) ** k, per_turn=8 + k) + [0.1 * k, 0, 0] for k, n in enumerate(counts)]
    material = Material()
    together = Strands(Curves.from_list(curves), material, 3)
    for _ in range(5):
        together.step(together.curves.points, FRAME, gravity=(2.0, -9.81, 0.0))
    for k, curve in enumerate(curves):
        alone = Strands(Curves.from_list([curve]), material, 3)
        for _ in range(5):
            alone.step(curve, FRAME, gravity=(2.0, -9.81, 0.0))
        assert (alone.positions == together.curves.with_points(together.positions)[k]).all()


def test_motion_is_bit_identical_for_any_number_of_threads():
    curves = Curves.from_list([helix(50, hand=(-1) ** k) + [0.1 * k, 0, 0] for k in range(40)])
    before = _core.thread_count()
    results = []
    try:
        for threads in (1, 2, 5):
            _core.set_thread_count(threads)
            strands = Strands(curves, Material())
            for _ in range(5):
                strands.step(curves.points, FRAME, gravity=(3.0, -9.81, 0.0))
            results.append(strands.positions.copy())
    finally:
        _core.set_thread_count(before)
    assert (results[0] == results[1]).all() and (results[0] == results[2]).all()


PROOF = Path(__file__).parents[2] / "tools/proof"
SCRIPT = """
import sys; sys.path.insert(0, sys.argv[1])
import numpy as np
from coils import helix
from ringlet.data.curves import Curves
from ringlet.shot import Material, Solver
from ringlet.sim import Strands
curves = Curves.from_list([helix(50, hand=(-1) ** k) + [0.1 * k, 0, 0] for k in range(11)])
strands = Strands(curves, Material())
for _ in range(5):
    strands.step(curves.points, 1 / 24, gravity=(3.0, -9.81, 0.0), solver=Solver(newton=30, tolerance=1e-12))
np.save(sys.argv[2], strands.positions)
"""


def test_every_instruction_set_gives_the_same_motion(tmp_path):
    results = []
    for simd in ("baseline", "avx2", "avx512"):
        environment = {**os.environ, "RINGLET_SIMD": simd}
        out = tmp_path / f"{simd}.npy"
        subprocess.run([sys.executable, "-c", SCRIPT, PROOF, out], env=environment, check=True)
        results.append(np.load(out))
    assert np.abs(results[1] - results[0]).max() < 1e-9
    assert np.abs(results[2] - results[0]).max() < 1e-9


def test_a_non_finite_start_is_reported_and_affects_no_other_strand():
    curves = Curves.from_list([helix(30) + [0.1 * k, 0, 0] for k in range(3)])
    strands = Strands(curves, Material())
    start = curves.points.copy()
    start[45] = np.nan
    strands.place(start)
    report = strands.step(curves.points, FRAME)
    assert list(report["nan"]) == [0, 1, 0]
    assert np.isfinite(strands.positions[:30]).all() and np.isfinite(strands.positions[60:]).all()
