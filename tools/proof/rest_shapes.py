"""Compares hairstyles in contact with the rest shapes none, lofted and equilibrium. A style takes over a minute.

python tools/proof/rest_shapes.py [STYLE …] [--locks 100] [--pictures FOLDER] [--head FILE --region NAME]
python tools/proof/rest_shapes.py [STYLE …] --locks 30 --springs 0.1 0.5 0.72

1. Drift: the head stands still for 10 s with equilibrium and for 3 s with the other rest shapes.
2. Bounce: the head drops by 5 cm in 0.1 s. The dominant frequency and the amplitude of each tip are divided by those
   of the sagged shape without a rest shape, and by those of the groomed shape without gravity.
3. Weightlessness: gravity is 0 for 0.5 s; locks on the head that are bent too far against gravity rise.

With ``--springs`` only the bounce is measured, in equilibrium with each of these values of ``rest.spring``.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np
from hairstyles import FPS, HEAD, MODES, SAG_TIME, STYLES, Array, Style, make_style
from ringlet.data.groom import Groom
from ringlet.rest.update import to_curves

import ringlet
from ringlet.rest import solve_rest_shape


def table(name: str, style: Style, seconds: float, picture: Path | None) -> None:
    """Prints the rows of a style, one for each rest mode."""
    groomed, ends, swings = np.asarray(style.groom.locks.points, np.float64), {}, {}
    on_head, weightless = style.on_head(), {}
    for mode in MODES:
        shot, began = style.shot(mode), time.process_time()
        made = None if mode == "none" else solve_rest_shape(shot, style.groom, obstacles=[style.head(np.zeros(1), FPS)])
        took = time.process_time() - began
        rest = made and to_curves(made, shot)
        for points in style.at_rest(shot, rest, seconds if mode == "equilibrium" else min(seconds, SAG_TIME)):
            ends[mode] = points.copy()
        drift = np.linalg.norm(ends[mode] - groomed, axis=1)
        if mode != "lofted":
            swings[mode] = style.bounce(shot, rest, ends[mode])
        if rest is not None and on_head.any():
            weightless[f"{mode}, weightless"] = style.weightless(mode, rest)
            offset = 1e3 * np.linalg.norm(rest.points - groomed, axis=1)[on_head].mean()
            print(
                f"{name}, {mode}: {on_head.mean():.2%} touch the head, rest shape {offset:.3g} mm from groom",
                flush=True,
            )
        stiffened = 0 if made is None or made.stiffened is None else int((made.stiffened > 1).sum())
        away = 0.0 if rest is None else np.linalg.norm(rest.points - groomed, axis=1).mean()
        columns = [1e3 * drift.mean(), *(1e6 * np.percentile(drift, [99, 100])), 1e3 * away, took]
        print(f"| {name} | {mode} |", *(f"{value:.3g} |" for value in columns), f"{stiffened} |", flush=True)
    swings["weightless"] = style.bounce(style.shot("none", 0.0), None, groomed)
    for plain in ("none", "weightless"):
        ratios = (mine / theirs for mine, theirs in zip(swings["equilibrium"], swings[plain], strict=True))
        frequency, amplitude = (float(np.median(ratio)) for ratio in ratios)
        print(
            f"{name}, bounce relative to {plain}: frequency x {frequency:.2f}, amplitude x {amplitude:.2f}", flush=True
        )
    for mode, points in weightless.items():
        rise = 1e3 * np.linalg.norm(points - groomed, axis=1)[on_head].mean()
        print(f"{name}, {mode}: vertices on the head move by {rise:.3g} mm", flush=True)
    if picture is not None:
        draw(name, style.groom, {"groomed": groomed, **ends}, picture)
        if weightless:
            draw(f"{name} weightless", style.groom, {"groomed": groomed, **weightless}, picture)


def springs(name: str, style: Style, values: list[float], seconds: float) -> None:
    """Prints the bounce of tips in equilibrium, relative to the groomed shape without gravity, for each `spring`.

    A cell holds the 10th, 50th and 90th percentile of the frequency, the median amplitude and the mean stiffening.
    """
    groomed, cells = np.asarray(style.groom.locks.points, np.float64), []
    plain_frequency, plain_amplitude = style.bounce(style.shot("none", 0.0), None, groomed)
    for spring in values:
        shot = style.shot("equilibrium", spring=spring)
        made = solve_rest_shape(shot, style.groom, obstacles=[style.head(np.zeros(1), FPS)])
        rest = to_curves(made, shot)
        *_, begin = style.at_rest(shot, rest, seconds)
        frequency, amplitude = style.bounce(shot, rest, begin.copy())
        frequencies = ", ".join(f"{ratio:.2f}" for ratio in np.percentile(frequency / plain_frequency, [10, 50, 90]))
        cells.append(f"{frequencies}; {np.median(amplitude / plain_amplitude):.2f}; {made.stiffened.mean():.3g}")
    print(f"| {name} |", *(f"{cell} |" for cell in cells), flush=True)


def draw(name: str, groom: Groom, shapes: dict[str, Array], folder: Path) -> None:
    """Draws the groom and its shapes on one page."""
    from ringlet import picture

    hairs = ringlet.build_hairs(groom)
    drawn = {
        label: hairs.curves.with_points(hairs.deformed(points, groom.scalp.points)) for label, points in shapes.items()
    }
    head = [picture.PosedBody(groom.scalp, groom.scalp.points)]
    folder.mkdir(parents=True, exist_ok=True)
    picture.compare(drawn, head, folder / f"rest_{name.replace(' ', '_')}.png", title="")


def main() -> None:
    """Prints a row for each rest mode of each style, or a row for each style with ``--springs``."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("styles", nargs="*", default=list(STYLES), help=", ".join(STYLES))
    parser.add_argument("--locks", type=int, default=100, help="number of locks of a style")
    parser.add_argument("--seconds", type=float, default=10.0, help="duration of the drift")
    parser.add_argument("--pictures", type=Path, help="folder for a picture of each style")
    parser.add_argument("--head", type=Path, default=HEAD, help="mesh of the head")
    parser.add_argument("--region", default="scalp", help="region of the head with hair")
    parser.add_argument("--springs", type=float, nargs="+", metavar="SPRING", help="values of rest.spring")
    options = parser.parse_args()
    if options.springs:
        print("| style |", *(f"spring = {spring} |" for spring in options.springs))
    else:
        columns = "drift, mean [mm] | 99 % [µm] | largest [µm] | rest from groom, mean [mm] | CPU [s] | stiffer"
        print(f"| style | rest | {columns} |")
    for name in options.styles or STYLES:
        style = make_style(name, options.locks, options.head, options.region)
        if options.springs:
            springs(name, style, options.springs, options.seconds)
        else:
            table(name, style, options.seconds, options.pictures)


if __name__ == "__main__":
    main()
