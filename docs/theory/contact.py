"""The contact barrier and friction."""

from __future__ import annotations

import numpy as np
from ringlet.validate import friction as coulomb
from ringlet.validate import push

from theory.answer import Answer, Panel


def barrier() -> Answer:
    """A strand that lies on the ground and is pressed down ever harder."""
    presses = np.array(push.PRESSES)
    gaps = [push.pressed(press)[0] for press in push.PRESSES]
    between = np.geomspace(presses[-1], presses[0], 300)
    return Answer(
        [
            Panel(
                "force / k r",
                "gap / r",
                {"by formula": (between, push.gap_under(between))},
                {"by formula": (presses, gaps)},
                log=True,
            )
        ],
        [
            (f"gap / r under {press:g} k r", exact, gap)
            for press, exact, gap in zip(push.PRESSES, push.gap_under(presses).tolist(), gaps, strict=True)
        ],
    )


def friction() -> Answer:
    """A strand on a slope, and one round a drum that turns."""
    rows, exact, got = [], {}, {}
    for mu in (0.2, 0.5):
        slopes, name = mu + np.array([0.1, 0.25, 0.5]), f"μ = {mu}"
        between = np.linspace(0.0, 1.0, 101)
        angle = np.arctan(between)
        pull = coulomb.GRAVITY * (np.sin(angle) - mu * np.cos(angle))
        found = [coulomb.acceleration(mu, float(slope)) for slope in slopes]
        stuck = coulomb.acceleration(mu, 0.5 * mu)
        exact[name] = between, np.maximum(pull, 0.0)
        got[name] = [0.5 * mu, *slopes], [stuck, *found]
        for slope, one in zip(slopes, found, strict=True):
            rows.append(
                (f"{name}, tan α = {slope:.3g}: acceleration [m/s²]", float(np.interp(slope, between, pull)), one)
            )
    drums = {mu: coulomb.tension_ratio(mu) for mu in (0.1, 0.2, 0.3, 0.4, 0.5)}
    wound = np.linspace(0.0, 1.8, 50)
    rows += [
        (f"μ = {mu}: tensions before and behind the drum", float(np.exp(mu * turn)), ratio)
        for mu, (ratio, turn) in drums.items()
    ]
    turns = [mu * turn for mu, (_, turn) in drums.items()]
    return Answer(
        [
            Panel("tan α", "acceleration [m/s²]", exact, got),
            Panel(
                "μ φ",
                "ratio of tensions",
                {"exp μφ": (wound, np.exp(wound))},
                {"exp μφ": (turns, [ratio for ratio, _ in drums.values()])},
            ),
        ],
        rows,
    )
