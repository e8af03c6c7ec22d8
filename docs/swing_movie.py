"""Makes docs/images/swing.webp: the nod of the example at two settings of the solver, side by side.

python docs/swing_movie.py play 5/0.4 NOW.npz     in the checkout of either version
python docs/swing_movie.py draw "before=BEFORE.npz" "now=NOW.npz"
"""

from __future__ import annotations

import io
import sys
from pathlib import Path

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from PIL import Image

from ringlet import build_groom, read_recipe, read_shot, simulate

SHOT = Path(__file__).parents[1] / "examples" / "child" / "nod.shot.toml"
MOVIE = Path(__file__).parent / "images" / "swing.webp"
LOCKS, SEED = 500, 0  # that are drawn, of all
ACROSS = [2, 1]  # axes of the view from the side


def play(setting: str, path: Path) -> None:
    """Simulates the nod with iterations/tolerance and keeps its locks."""
    newton, tolerance = setting.split("/")
    shot = read_shot(SHOT)
    solver = shot.solver.model_copy(update={"newton": int(newton), "linear_tolerance": float(tolerance)})
    groom = build_groom(read_recipe(shot.groom))
    cache = simulate(shot.model_copy(update={"solver": solver}), groom, allow_stale=True)
    np.savez(path, points=cache.points.astype(np.float32), offsets=groom.locks.offsets)


def draw(runs: dict[str, Path]) -> None:
    """Writes the movie of the runs, one panel each."""
    read = {title: np.load(path) for title, path in runs.items()}
    points = {title: run["points"] for title, run in read.items()}
    offsets = next(iter(read.values()))["offsets"]
    chosen = np.random.default_rng(SEED).permutation(len(offsets) - 1)[:LOCKS]
    seen = np.concatenate([run[..., ACROSS].reshape(-1, 2) for run in points.values()])
    low, high = seen.min(axis=0) - 0.01, seen.max(axis=0) + 0.01
    pictures = []
    for frame in range(len(next(iter(points.values())))):
        figure = Figure(figsize=(8, 4.4), dpi=80)
        for panel, (title, run) in zip(figure.subplots(1, len(points)), points.items(), strict=True):
            lines = [run[frame, offsets[k] : offsets[k + 1]][:, ACROSS] for k in chosen]
            panel.add_collection(LineCollection(lines, colors="#3a2216", linewidths=0.5, alpha=0.8))
            panel.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal", title=title)
            panel.axis("off")
        figure.subplots_adjust(0, 0, 1, 0.93, 0.02)
        with io.BytesIO() as png:
            figure.savefig(png, format="png")
            pictures.append(Image.open(png).convert("RGB"))
    pictures[0].save(MOVIE, save_all=True, append_images=pictures[1:], duration=42, loop=0, quality=40)


if __name__ == "__main__":
    command, *rest = sys.argv[1:]
    if command == "play":
        play(rest[0], Path(rest[1]))
    else:
        draw({title: Path(path) for title, _, path in (run.partition("=") for run in rest)})
