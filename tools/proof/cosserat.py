"""Runs the experiments of cosseratbench, with Ringlet or others, and prints the table of docs/cosserat_bench.md.

python tools/proof/cosserat.py RESULTS SOLVER...        runs them, by the solvers' names; without any: prints the table

Results are kept one file each in the folder RESULTS, so that solvers may be run in environments of their own, where
their versions agree. Seconds are those of the processor, which other work on the machine does not lengthen.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

from cosseratbench import experiment, registry  # pyright: ignore[reportMissingImports]

# Experiment, what its parameters are apart from their defaults, and the elements per rod apart from its own.
CASES: tuple[tuple[str, dict[str, float], int | None], ...] = (
    ("cantilever", {}, None),
    ("cantilever", {}, 40),
    ("catenary", {}, None),
    ("catenary", {"youngs_modulus": 1e5}, None),
    ("pendulum", {}, None),
    ("capstan", {"overhang": 0.8}, None),
    ("capstan", {"overhang": 0.95}, None),
    ("capstan", {"overhang": 1.1}, None),
    ("crossing", {}, None),
    ("crossing", {}, 50),
    ("twist", {}, None),
    ("pile", {}, None),
)
OBSERVED = {"max_penetration", "max_rod_overlap"}  # in addition to the metrics of each experiment, where not 0


class Timed:
    """A solver that measures the processor time of its last run [s]."""

    def __init__(self, solver: Any) -> None:
        self._solver, self.seconds = solver, 0.0

    def __getattr__(self, name: str) -> Any:
        return getattr(self._solver, name)

    def run(self, *scenario: Any, **settings: Any) -> Any:
        begin = time.process_time()
        try:
            return self._solver.run(*scenario, **settings)
        finally:
            self.seconds = time.process_time() - begin


def label(name: str, values: dict[str, float], elements: int | None) -> str:
    """The name of a case in the table."""
    changes = [f"{key.replace('_', ' ')} {value:g}" for key, value in values.items()]
    return ", ".join([name, *changes, *([f"{elements} elements"] if elements else [])])


def measured(name: str, values: dict[str, float], elements: int | None, solver: str) -> dict[str, Any]:
    """A row of the table."""
    timed = Timed(registry.load_solver(solver))
    row = {"case": label(name, values, elements), "solver": solver, "version": timed.backend_version}
    try:
        result = experiment.run(registry.load_experiment(name), timed, values=values, n_elements=elements)
    except Exception as error:  # an adapter that fails is a row as well
        return {**row, "outcome": f"{type(error).__name__}: {error}"}
    observed = {key: value for key, value in result.observations.items() if key in OBSERVED and value > 0.0}
    return {
        **row,
        "outcome": result.failure or ("needs " + ", ".join(result.missing) if result.missing else result.outcome),
        "seconds": timed.seconds,
        "metrics": {key: value for key, value in {**result.metrics, **observed}.items() if value == value},  # not NaN
    }


def table(rows: list[dict[str, Any]]) -> None:
    """Prints the rows by case, in Markdown."""
    print("| experiment | solver | result | CPU s |\n|---|---|---|---|")
    order = [label(*case) for case in CASES]
    for row in sorted(rows, key=lambda row: (order.index(row["case"]), row["solver"] != "ringlet", row["solver"])):
        numbers = [f"{key} {value:.2g}" for key, value in row.get("metrics", {}).items()]
        cells = "; ".join(numbers).replace("_", " ") if numbers else row["outcome"]
        seconds = f"{row['seconds']:.3g}" if "seconds" in row else ""
        print(f"| {row['case']} | {row['solver']} {row['version']} | {cells} | {seconds} |")


def main() -> None:
    """Runs the cases that have no result yet, or prints the table of those that have."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("results", type=Path)
    parser.add_argument("solver", nargs="*")
    arguments = parser.parse_args()
    arguments.results.mkdir(parents=True, exist_ok=True)
    for case in CASES:
        for solver in arguments.solver:
            file = arguments.results / f"{label(*case)} {solver}.json"
            if not file.exists():
                file.write_text(json.dumps(measured(*case, solver), indent=1))
    if not arguments.solver:
        table([json.loads(file.read_text()) for file in arguments.results.glob("*.json")])


if __name__ == "__main__":
    main()
