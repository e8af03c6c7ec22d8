"""Rows of the tests of advice: what live hair refuses."""

from __future__ import annotations

import math
from typing import Any
from unittest.mock import Mock

import numpy as np
from remedies import RECIPE, SHOT, Act, Advice
from ringlet.viewer.play.live_hair import LiveHair
from ringlet.viewer.play.mover import LiveScene
from ringlet.viewer.show.display_groom import DisplayGroom

import ringlet


def live(**settings: Any) -> ringlet.Live:
    return ringlet.Live(ringlet.build_groom(RECIPE), **settings)


def given(name: str, value: Any) -> Act:
    return lambda: setattr(live(), name, value)


def touched(**values: Any) -> Act:
    return lambda: ringlet.Touch("pat", **{"at": (0.0, 0.0, 0.0), **values})


def scaled(factor: float) -> Act:
    return given("head", np.diag([factor, factor, factor, 1.0]))


def clip_played(shot: str | None) -> None:
    """The clip of a shot, or of none, in a review whose hair moves live."""
    hair = LiveHair(Mock(), Mock(), Mock(), lambda: False)
    hair.start(LiveScene(ringlet.build_groom(RECIPE), ringlet.read_shot(shot) if shot else None, []))
    try:
        hair.move_head("clip")
    finally:
        hair.stop(10.0)


def scene(*, hairs: bool) -> LiveScene:
    groom = ringlet.build_groom(RECIPE)
    return LiveScene.of(DisplayGroom(groom, groom.hairs if hairs else None, False), None, [])


ROWS = [
    Advice(
        "live: {} is {}; must be three finite numbers",
        given("gravity", (0.0, math.nan, 0.0)),
        given("gravity", (0.0, -9.81, 0.0)),
    ),
    Advice("head is not a 4 × 4 matrix of finite numbers", given("head", np.zeros((3, 3))), given("head", np.eye(4))),
    Advice("must be rigid and act on columns", scaled(2.0), scaled(1.0)),
    Advice("live: fps is {}; must be positive", lambda: live(fps=0.0), lambda: live(fps=24.0)),
    Advice("live: contact is {}; must be at least 0", given("contact", -1.0), given("contact", 0.0)),
    Advice("no shot whose clip could play; open one", lambda: clip_played(None), lambda: clip_played(SHOT)),
    Advice("live: a hand is at {}; must be three finite numbers", touched(at=(0.0, math.inf, 0.0)), touched()),
    Advice("live: radius of a hand is {}; must be positive", touched(radius=-1.0), touched(radius=0.02)),
    Advice("there are no locks to move; open a recipe", lambda: scene(hairs=False), lambda: scene(hairs=True)),
]
