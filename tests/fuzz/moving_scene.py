"""A shot of random hair on a ball that moves."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import small_example
from numpy.random import Generator
from pxr import Gf, Usd, UsdGeom
from ringlet.data.toml import to_toml

import ringlet
from ringlet import Groom


def moving_scene(
    random: Generator, folder: Path, *, rate: int = 24, steps: int = 24, slides: bool = False
) -> tuple[Any, Groom]:
    """A shot of a few locks on a ball that moves, with or without contact, and its groom.

    slides: the ball does not turn, and nothing touches
    """
    small_example.write_head(folder / "head.usda")
    stage = Usd.Stage.Open(str(folder / "head.usda"))
    stage.SetTimeCodesPerSecond(rate)
    root = UsdGeom.Xformable(stage.GetPrimAtPath("/ball"))
    root.ClearXformOpOrder()
    root.GetPrim().RemoveProperty("xformOp:rotateY")
    move, turn = root.AddTranslateOp(), root.AddRotateXYZOp()
    speed, spin = random.uniform(-30, 30, 3), (not slides) * random.uniform(-200, 200, 3)  # [cm/s], [degrees/s]
    seconds = 0.25
    for at in range(round(rate * seconds) + 1):
        t = at / rate
        move.Set(Gf.Vec3d(*(speed * t)), 1 + at)
        turn.Set(Gf.Vec3f(*(spin * t).tolist()), 1 + at)
    stage.SetEndTimeCode(1 + round(rate * seconds))
    stage.Save()
    recipe = {
        "ringlet": 2,
        "scalp": {"file": "head.usda", "region": "scalp"},
        "guides": {
            "count": int(random.integers(1, 5)),
            "length": f"{random.uniform(5, 80):.3f} mm",
            "lift": round(random.random(), 3),
        },
        "locks": {"points": int(random.integers(6, 24))},
        **(
            {"curl": {"curls": round(random.uniform(0.2, 0.7), 3), "width": f"{random.uniform(1, 10):.3f} mm"}}
            if random.random() < 0.5
            else {}
        ),
    }
    shot = {
        "ringlet": 2,
        "groom": "r.recipe.toml",
        "frames": [1, 1 + round(rate * seconds)],
        "preroll": 0,
        "solver": {"newton": int(random.integers(1, 8)), "substeps": max(1, steps // rate)},
        "strands": {"bend_scale": 10.0 ** random.uniform(-1, 1), "damping": float(random.choice([0.0, 0.004]))},
        **({"contact": {"radius": 10.0 ** random.uniform(-4, -2.7)}} if random.random() < 0.6 and not slides else {}),
    }
    (folder / "r.recipe.toml").write_text(to_toml(recipe))
    (folder / "s.shot.toml").write_text(to_toml(shot))
    return ringlet.read_shot(folder / "s.shot.toml"), ringlet.load_groom(folder / "r.recipe.toml")
