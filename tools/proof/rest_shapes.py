"""Compares a hairstyle in contact with the rest shapes none, lofted and equilibrium. Prints JSON after some minutes.

python tools/proof/rest_shapes.py STYLE [--locks 100] [--modes MODE …] [--pictures FOLDER] [--head FILE --region NAME]
python tools/proof/rest_shapes.py STYLE --locks 30 --springs 0.1 0.5 0.72

1. Drift: the head stands still for 10 s with equilibrium and for 3 s with the other rest shapes.
2. Bounce: the head drops by 5 cm in 0.1 s. The dominant frequency and the amplitude of each tip are divided by those
   of the sagged shape without a rest shape, and by those of the groomed shape without gravity.
3. Weightlessness: gravity is 0 for 0.5 s; locks on the head that are bent too far against gravity rise.

With ``--springs`` only the bounce is measured, in equilibrium with each of these values of ``rest.spring``.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from hairstyles import FPS, HEAD, MODES, SAG_TIME, STYLES, Array, Style, make_style
from ringlet.data.groom import Groom
from ringlet.rest.update import to_curves

import ringlet
from ringlet.rest import solve_rest_shape


def compared(name: str, style: Style, chosen: Sequence[str], seconds: float, picture: Path | None) -> dict[str, Any]:
    """What rest modes do to a style: ``modes``, and with all ``swing`` in equilibrium relative to shapes without it.

    A mode has the drift, the distance of the rest shape from the groom, and both of vertices that touch the head.
    """
    groomed, ends, swings = np.asarray(style.groom.locks.points, np.float64), {}, {}
    on_head, weightless, modes = style.on_head(), {}, {}
    swinging = set(chosen) == set(MODES)
    for mode in chosen:
        shot, began = style.shot(mode), time.process_time()
        made = None if mode == "none" else solve_rest_shape(shot, style.groom, obstacles=[style.head(np.zeros(1), FPS)])
        took = time.process_time() - began
        rest = made and to_curves(made, shot)
        for points in style.at_rest(shot, rest, seconds if mode == "equilibrium" else min(seconds, SAG_TIME)):
            ends[mode] = points.copy()
        drift = np.linalg.norm(ends[mode] - groomed, axis=1)
        if swinging and mode != "lofted":
            swings[mode] = style.bounce(shot, rest, ends[mode])
        found = {"mean_mm": 1e3 * drift.mean()}
        found |= {f"{part}_um": 1e6 * np.percentile(drift, part) for part in (99, 100)}
        if rest is not None:
            away = 1e3 * np.linalg.norm(rest.points - groomed, axis=1)
            found |= {"rest_mm": away.mean(), "cpu_s": took}
            if made.stiffened is not None:
                found["stiffened"] = int((made.stiffened > 1).sum())
            if on_head.any():
                weightless[f"{mode}, weightless"] = end = style.weightless(mode, rest)
                rise = 1e3 * np.linalg.norm(end - groomed, axis=1)[on_head].mean()
                found["on_head"] = {"rest_mm": away[on_head].mean(), "rise_mm": rise}
        modes[mode] = found
    swing = {}
    if swinging:
        swings["weightless"] = style.bounce(style.shot("none", 0.0), None, groomed)
    for plain in ("none", "weightless") if swinging else ():
        ratios = (mine / theirs for mine, theirs in zip(swings["equilibrium"], swings[plain], strict=True))
        swing[plain] = dict(zip(("frequency", "amplitude"), (float(np.median(ratio)) for ratio in ratios), strict=True))
    if picture is not None:
        draw(name, style.groom, {"groomed": groomed, **ends}, picture)
        if weightless:
            draw(f"{name} weightless", style.groom, {"groomed": groomed, **weightless}, picture)
    return {"touching": on_head.mean(), "modes": modes, "swing": swing}


def springs(style: Style, values: list[float], seconds: float) -> dict[str, Any]:
    """The bounce of tips in equilibrium, relative to the groomed shape without gravity, for each `spring`.

    ``frequency`` has the 10th, 50th and 90th percentile, ``amplitude`` is the median, ``stiffening`` the mean.
    """
    groomed, found = np.asarray(style.groom.locks.points, np.float64), {}
    plain_frequency, plain_amplitude = style.bounce(style.shot("none", 0.0), None, groomed)
    for spring in values:
        shot = style.shot("equilibrium", spring=spring)
        made = solve_rest_shape(shot, style.groom, obstacles=[style.head(np.zeros(1), FPS)])
        rest = to_curves(made, shot)
        *_, begin = style.at_rest(shot, rest, seconds)
        frequency, amplitude = style.bounce(shot, rest, begin.copy())
        found[f"{spring:g}"] = {
            "frequency": {f"{part}": np.percentile(frequency / plain_frequency, part) for part in (10, 50, 90)},
            "amplitude": np.median(amplitude / plain_amplitude),
            "stiffening": made.stiffened.mean(),
        }
    return {"springs": found}


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
    """Prints the comparison of a style, or its springs with ``--springs``."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("style", choices=STYLES)
    parser.add_argument("--locks", type=int, default=100, help="number of locks")
    parser.add_argument("--modes", nargs="+", choices=MODES, default=MODES, help="rest modes; the swing needs all")
    parser.add_argument("--seconds", type=float, default=10.0, help="duration of the drift")
    parser.add_argument("--pictures", type=Path, help="folder for a picture of each style")
    parser.add_argument("--head", type=Path, default=HEAD, help="mesh of the head")
    parser.add_argument("--region", default="scalp", help="region of the head with hair")
    parser.add_argument("--springs", type=float, nargs="+", metavar="SPRING", help="values of rest.spring")
    options = parser.parse_args()
    style = make_style(options.style, options.locks, options.head, options.region)
    if options.springs:
        found = springs(style, options.springs, options.seconds)
    else:
        found = compared(options.style, style, options.modes, options.seconds, options.pictures)
    print(json.dumps({"style": options.style, "locks": options.locks, "seconds": options.seconds, **found}, indent=1))


if __name__ == "__main__":
    main()
