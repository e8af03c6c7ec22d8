"""The demo begins with its groom."""

from pathlib import Path

import numpy as np
from ringlet.api.demo import balanced

import ringlet
from ringlet import loft, read_shot, simulate, write_loft

EXAMPLE = Path(__file__).parents[2] / "examples" / "child"
LOCKS = 40


def test_the_hair_of_the_demo_hangs_as_groomed_when_the_clip_begins(tmp_path):
    """Within 2 mm, before any cloth comes to it; the groom as its own rest shape sags by centimetres."""
    recipe = ringlet.read_recipe(EXAMPLE / "ribbon.recipe.toml")
    few = recipe.model_copy(update={"locks": recipe.locks.model_copy(update={"count": LOCKS})})
    groom = ringlet.build_groom(few)
    shot = balanced(read_shot(EXAMPLE / "ribbon.shot.toml"), tmp_path / "ribbon.rest.usdc")
    shot = shot.model_copy(update={"cloth": []})
    write_loft(loft(shot, groom), shot, shot.rest.file)
    moved = simulate(shot, groom, frames=(shot.frames[0], 1)).points[-1] - groom.locks.points
    assert np.linalg.norm(moved, axis=1).max() < 2e-3
