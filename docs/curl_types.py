"""Measures the curl of each type and draws it over what is published: shrinkage and curvature (curl_types.md).

.venv/bin/python docs/curl_types.py writes docs/curl_types.json, what the types have; the figure is drawn from that file
when the documents are built. docs/curl_types.toml has what is published.
"""

from __future__ import annotations

import json
import tomllib
from pathlib import Path

import numpy as np
from lock_pictures import TYPES, hanging
from matplotlib.figure import Figure
from numpy.typing import NDArray
from ringlet.data.files import replacing

from ringlet import Curves
from ringlet.groom import PRESETS, parse_recipe, read_recipe

HERE = Path(__file__).parent
PLACES = (10, 50, 90)  # percentiles of the locks or hairs of a type
SPACING = 4e-4  # of the places at which curvature is measured [m]
RED, BLUE, GREY = "#8c3b2a", "#2a5b8c", "#9a9a9a"


def shrinkage(hairs: Curves) -> NDArray[np.float64]:
    """By how much each hair is shorter from root to tip than along it, as a fraction, shape (hairs,)."""
    points = [np.asarray(hairs[k], np.float64) for k in range(len(hairs))]
    return 1.0 - np.array([np.linalg.norm(p[-1] - p[0]) for p in points]) / hairs.lengths()


def curvature(hairs: Curves) -> NDArray[np.float64]:
    """Mean curvature of the outer three quarters of each hair [1/mm], shape (hairs,)."""
    found = []
    for k, length in enumerate(hairs.lengths()):
        points = np.asarray(hairs[k], np.float64)
        run = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
        at = np.arange(0.25 * length, length, SPACING)
        places = np.stack([np.interp(at, run, points[:, axis]) for axis in range(3)], axis=1)
        speed = np.gradient(places, axis=0)
        turn = np.linalg.norm(np.cross(speed, np.gradient(speed, axis=0)), axis=1)
        found.append(1e-3 * float(np.mean((turn / np.linalg.norm(speed, axis=1) ** 3)[2:-2])))
    return np.array(found)


def lock_alone(kind: str) -> Curves:
    """Locks of a preset, without hairs around them."""
    return hanging(parse_recipe(f'ringlet = 2\nscalp.file = "sheet"\n[curl]\npreset = "{kind}"'), 1)


def statistics(hairs: Curves) -> dict[str, list[float]]:
    """Percentiles of shrinkage and curvature [1/mm]."""
    measures = {"shrinkage": shrinkage(hairs), "curvature": curvature(hairs)}
    return {name: [round(float(x), 3) for x in np.percentile(values, PLACES)] for name, values in measures.items()}


def measured() -> dict[str, dict[str, dict[str, list[float]]]]:
    """Statistics of the locks of each preset, and of the hairs of each recipe in examples/types."""
    return {
        kind: {
            "preset": statistics(lock_alone(kind)),
            "recipe": statistics(hanging(read_recipe(TYPES / f"{kind}.recipe.toml"), 12)),
        }
        for kind in PRESETS
    }


def figure() -> Figure:
    """Shrinkage and curvature of each type over the published ranges."""
    types = json.loads((HERE / "curl_types.json").read_text())
    published = tomllib.loads((HERE / "curl_types.toml").read_text())
    drawn = Figure(figsize=(9, 3.6), layout="constrained")
    left, right = drawn.subplots(1, 2)
    for axes, name in ((left, "shrinkage"), (right, "curvature")):
        for shift, which, color in ((-0.15, "preset", RED), (0.15, "recipe", BLUE)):
            low, middle, high = np.array([types[kind][which][name] for kind in types]).T
            x = np.arange(len(types)) + shift
            axes.errorbar(x, middle, (middle - low, high - middle), fmt="o", ms=3, lw=1, color=color, label=which)
        axes.set_xticks(range(len(types)), list(types))
        axes.grid(axis="y", alpha=0.3)
    for kind, (low, high) in published["shrinkage"]["range"].items():
        left.bar(list(types).index(kind), high - low, 0.8, low, color=GREY, alpha=0.3)
    left.set_ylabel("shrinkage", fontsize=9)
    for name, (low, _, _, _, high) in published["curvature"]["people"].items():
        first, last = published["curvature"]["over"][name]
        at = [list(types).index(kind) for kind in (first, last)]
        right.bar(np.mean(at), high - low, at[1] - at[0] + 0.8, low, color=GREY, alpha=0.3)
        right.text(np.mean(at), high, name, ha="center", va="bottom", fontsize=7, color="#555555")
    right.set_ylabel("curvature [1/mm]", fontsize=9)
    left.legend(fontsize=8, frameon=False, loc="upper left")
    return drawn


if __name__ == "__main__":
    with replacing(HERE / "curl_types.json") as aside:
        aside.write_text(json.dumps(measured(), indent=1) + "\n")
