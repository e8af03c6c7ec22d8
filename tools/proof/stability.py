"""Releases strands from shapes far from rest and prints the tables of docs/stability.md in Markdown.

python tools/proof/stability.py
"""

from __future__ import annotations

import argparse

from releases import release, scenes


def cells(result, k):
    """Columns of a scene: steps until it returned, or its final distance; excursion; gain."""
    end = f"{result.back[k]}" if result.back[k] > 0 else f"**{100 * result.away[k]:.2g} cm away**"
    gain = f"{100 * result.gain[k]:.2g} %" if result.gain[k] > 1e-5 else "–"
    return end, f"{100 * result.excursion[k]:.2g} cm", gain


def main():
    """Prints a table for each model: return, excursion and energy gain for each setting."""
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args()
    settings = [(5, 24), (1, 24), (5, 12)]
    models = [(name, "backward_euler") for name in ("material_frame", "least_energy", "history")]
    for continuation, integrator in [*models, ("material_frame", "bdf2")]:
        title = f"`{continuation}`" if integrator == "backward_euler" else f"`{continuation}` with `{integrator}`"
        print(f"\n## {title}\n")
        columns = [f"{n} × 1/{fps} s | excursion | gain" for n, fps in settings]
        print("| scene |", " | ".join(columns), "|\n|---|" + "---|" * (3 * len(columns)))
        results = [release(continuation, n, fps, 1500, integrator) for n, fps in settings]
        for k, (name, _, _) in enumerate(scenes()):
            print(f"| {name} |", " | ".join(cell for result in results for cell in cells(result, k)), "|")


if __name__ == "__main__":
    main()
