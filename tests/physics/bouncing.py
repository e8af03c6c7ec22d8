"""The demo's shot with some of its locks: how far they open and close, and which tips leave their neighbours."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from ringlet.api.demo import with_rest_shape
from ringlet.data.motion import Word
from ringlet.shot import Shot
from scipy.spatial import cKDTree

import ringlet

EXAMPLE = Path(__file__).parents[2] / "examples" / "child"
WHIP = 0.02  # m that the step of a tip in a frame differs from the mean of its eight neighbours'


@dataclass
class Clip:
    """What came out of a clip; arrays have one value a lock. ``points`` are those of the locks, by frame."""

    words: dict[str, Word]
    whips: int
    points: NDArray[np.float32]


def shot_and_groom(folder: Path, locks: int) -> tuple[Shot, ringlet.Groom]:
    """The demo's shot, with its rest shape made in ``folder``, and about as many of its locks."""
    recipe = ringlet.read_recipe(EXAMPLE / "ringlets.recipe.toml")
    groom = ringlet.build_groom(recipe.model_copy(update={"locks": recipe.locks.model_copy(update={"count": locks})}))
    shot = with_rest_shape(ringlet.read_shot(EXAMPLE / "ringlets.shot.toml"), folder / "ringlets.rest.usdc")
    ringlet.write_loft(ringlet.loft(shot, groom), shot, shot.rest.file)
    return shot, groom


def clip(folder: Path, shot: Shot, groom: ringlet.Groom) -> Clip:
    """Simulates the shot."""
    cache = ringlet.simulate(shot, groom, allow_stale=True)  # the rest shape counts on contact
    groom_file, cache_file = folder / "groom.usdc", folder / "cache.usdc"
    ringlet.write_groom(groom, groom_file)
    ringlet.write_cache(cache, groom_file, cache_file)
    words = ringlet.motion_words(shot, groom, cache=cache_file, allow_stale=True).words
    tips = groom.locks.offsets[1:] - 1
    _, near = cKDTree(groom.locks.points[tips]).query(groom.locks.points[tips], k=9)
    steps = np.diff(cache.points[:, tips], axis=0)
    apart = np.linalg.norm(steps - steps[:, near[:, 1:]].mean(axis=2), axis=-1)
    return Clip({word.name: word for word in words}, int(np.count_nonzero(apart > WHIP)), cache.points)
