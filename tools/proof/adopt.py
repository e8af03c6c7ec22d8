"""How well finished hair is adopted: grooms whose recipes are known, and files. Prints JSON.

Usage: python tools/proof/adopt.py [--locks N] [FILE …]
"""

from __future__ import annotations

import argparse
import json
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from ringlet.adoption import fit_coils
from ringlet.data.painted import per_lock
from ringlet.data.random import Random, soft_threshold
from ringlet.groom.operators.operator import grid, resampled

import ringlet
from ringlet.groom import Recipe

TYPES = Path(__file__).parents[2] / "examples/types"
KNOWN = ("3A", "3B", "3C", "4A", "4B")
POINTS = 160  # of a lock that is fitted


def known(name: str, locks: int) -> dict[str, Any]:
    """A recipe of the examples with fewer locks: errors of each lock's width and pitch, median and 95 %."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "known.recipe.toml")
        path.write_text(
            f'ringlet = 2\nextends = "{TYPES / name}.recipe.toml"\n[locks]\ncount = {locks}\n'
            "[hairs]\ndensity = false\nper_lock = 8\n"
        )
        recipe = ringlet.read_recipe(path)
        groom = ringlet.build_groom(recipe)
        ringlet.write_groom(groom, Path(folder, "groom.usdc"))
        ringlet.write_hairs(Path(folder, "groom.usdc"), Path(folder, "all.usdc"))
        ringlet.convert(Path(folder, "all.usdc"), Path(folder, "hair.hair"), only="hairs", unit=1.0)
        done = ringlet.adopt(Path(folder, "hair.hair"), Path(folder, "a.recipe.toml"), head=recipe.scalp_file)
        coils = fit_coils(grid(resampled(groom.locks, POINTS)))
        value = {name: _values(recipe, groom, name) for name in ("width", "pitch", "right_handed")}
        right = soft_threshold(value["right_handed"], Random(recipe.seed, "curl/hand").uniform(groom.locks.ids)) > 0.5
        coiled = coils.width > 0.0
        errors = {
            setting: np.abs(found / value[setting] - 1.0)[coiled]
            for found, setting in ((coils.width, "width"), (coils.pitch, "pitch"))
        }
        return {
            **_found(done),
            "made": len(groom.locks),
            "hand": float(((coils.hand > 0.0) == right)[coiled].mean()),
            **{
                name: {"median": float(np.median(error)), "95": float(np.quantile(error, 0.95))}
                for name, error in errors.items()
            },
        }


def _values(recipe: Recipe, groom: ringlet.Groom, name: str) -> np.ndarray:
    """Values of a setting of the curl for each lock, with the mean of its ramp, shape (locks,)."""
    assert recipe.curl is not None
    setting = getattr(recipe.curl, name)
    ramp = setting.along(np.linspace(0.0, 1.0, POINTS)).mean() if hasattr(setting, "ramp") else 1.0
    return ramp * per_lock(recipe.curl, name, Random(recipe.seed, f"curl/{name}"), groom.locks, groom.scalp, name)


def measured(path: Path) -> dict[str, Any]:
    """A file of hair."""
    with tempfile.TemporaryDirectory() as folder:
        return _found(ringlet.adopt(path, Path(folder, "a.recipe.toml")))


def _found(done: dict[str, Any]) -> dict[str, Any]:
    """Hairs, locks, and the distances from the given hair [mm]."""
    distances = {name: 1e3 * done["error"][name] for name in ("median", "95")}
    return {"hairs": done["hairs"], "locks": done["locks"], "distance_mm": distances}


def main() -> None:
    """Prints what was found for each recipe and file."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--locks", type=int, default=100)
    parser.add_argument("files", nargs="*", type=Path)
    options = parser.parse_args()
    rows = {f"types/{name}": known(name, options.locks) for name in KNOWN}
    rows |= {path.name: measured(path) for path in options.files}
    print(json.dumps({"hair": rows}, indent=1))


if __name__ == "__main__":
    main()
