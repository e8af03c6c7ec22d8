"""Braids, twists and tails of cornrows on the example's nodding head: the word of each, and how far strands leave it.

Usage: python tools/proof/braids.py [FRAMES]. Prints JSON; ``radius`` is relative to the groom's.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from judged_shots import EXAMPLE, judged
from numpy.typing import NDArray
from ringlet.api.grooms import build_groom
from ringlet.api.shots import read_shot, start_motion
from ringlet.data.groom import SECTION, STRAND_RADIUS
from ringlet.groom.scalp import Scalp
from ringlet.groom.shares import LAID

from ringlet import Curves
from ringlet.groom import parse_recipe, weave

WOVEN = "start = 1.2\ntail = 0.8\n"
SHAPES = {
    "braids": ("size = 4.5\nstrands = 3", 110, 'op = "braid"\nwidth = 1.2\n' + WOVEN),
    "twists": ("size = 4.5\nstrands = 2", 110, 'op = "twist"\nwidth = 1\n' + WOVEN),
    "cornrows": (
        'pattern = "rows"\nsize = 3\ngap = 0.3\nstrands = 3',
        300,
        'op = "cornrow"\nwidth = 1\nheight = 0.6\npitch = 2.2\nlength = 7\ntail = 0.8',
    ),
}
RECIPE = """
ringlet = 2
seed = 7
[scalp]
file = "head.usdc"
mesh = "/child/skin"
region = "scalp"
[guides]
count = 110
length = 9
lift = 0.35
gravity_bend = 1.6
[locks]
points = {points}
[locks.sections]
{sections}
mask = {{ where = "{where}" }}
[[shape]]
{shape}
"""
START, END = 0.2, 0.905  # parts of a braid at its root and beyond its tie, where it is not woven
AFTER_ROW, BEFORE_TIP = 0.005, 0.025  # likewise of the tail of a cornrow [m]


@dataclass(frozen=True)
class Held:
    """State of all braids after a frame.

    crossings:   pairs that passed through one another, counted by ipctk
    changed:     braids with another word
    radius:      half the width of each braid where it is widest, strands included, over that in the groom
    max_stretch: largest strain of an edge
    """

    crossings: int
    changed: int
    radius: NDArray[np.float64]
    max_stretch: float


def start(style: str, where: str = "1"):
    """Motion of the nod with braids in the sections that the mask has, and their groom."""
    sections, points, shape = SHAPES[style]
    recipe = RECIPE.format(sections=sections, points=points, shape=shape, where=where)
    groom = build_groom(parse_recipe(recipe, EXAMPLE / "braids.recipe.toml"))
    return start_motion(read_shot(EXAMPLE / "nod.shot.toml"), groom), groom


def played(motion, groom, frames: int) -> Iterator[Held]:
    """Plays frames of a motion, each judged."""
    section, middle = groom.locks.curve[SECTION], Scalp(groom.scalp, groom.region).middle
    sections = [np.flatnonzero(section == one) for one in np.unique(section)]
    parts = [woven(groom.locks, rows) for rows in sections]
    thick = [float(groom.locks.curve[STRAND_RADIUS][rows[0]]) for rows in sections]

    def braids(points: NDArray) -> list[NDArray]:
        strands = points.reshape(len(groom.locks), -1, 3)
        return [
            weave.cross_sections(strands[rows], middle)[:, part] for rows, part in zip(sections, parts, strict=True)
        ]

    groomed = braids(groom.locks.points)
    words = [weave.braid_word(places) for places in groomed]
    for frame in judged(motion, frames):
        now = [turned(a, b) for a, b in zip(braids(motion.strands.positions), groomed, strict=True)]
        yield Held(
            crossings=frame.crossings or 0,
            changed=sum(not same(weave.braid_word(a), word) for a, word in zip(now, words, strict=True)),
            radius=np.array(
                [_radius(a, strand) / _radius(b, strand) for a, b, strand in zip(now, groomed, thick, strict=True)]
            ),
            max_stretch=frame.statistics["max_stretch"],
        )


def woven(locks: Curves, rows: NDArray[np.integer]) -> NDArray[np.bool_]:
    """The points of the strands of a section that are judged: the braid, or the tail of a cornrow; shape (points,)."""
    u = np.linspace(0.0, 1.0, int(locks.counts[rows[0]]))
    if LAID not in locks.curve:
        return (u > START) & (u < END)
    along = u * locks.lengths()[rows].min()
    return (along > locks.curve[LAID][rows].max() + AFTER_ROW) & (along < along[-1] - BEFORE_TIP)


def turned(places: NDArray, to: NDArray) -> NDArray[np.float64]:
    """Cross-sections (strands, points, 2) turned so that they fit others best: a braid may twist as a whole."""
    across = np.sum(places[..., 0] * to[..., 1] - places[..., 1] * to[..., 0], axis=0)
    angle = np.arctan2(across, np.sum(places * to, axis=(0, 2)))
    cosine, sine = np.cos(angle), np.sin(angle)
    x, z = places[..., 0], places[..., 1]
    return np.stack([cosine * x - sine * z, sine * x + cosine * z], axis=-1)


def same(a: list[tuple[int, int]], b: list[tuple[int, int]]) -> bool:
    """Whether two words agree, but for the crossing at each end, which may be on either side of the cut."""
    shifts = [(i, j) for i in (0, 1) for j in (0, 1) if i * j == 0]
    return any(
        abs(len(a[i:]) - len(b[j:])) <= 1 and all(p == q for p, q in zip(a[i:][:-1], b[j:], strict=False))
        for i, j in shifts
    )


def _radius(places: NDArray, strand: float) -> float:
    return float(np.linalg.norm(places, axis=2).max()) + strand


if __name__ == "__main__":
    frames = int(sys.argv[1]) if len(sys.argv) > 1 else 48
    found = {}
    for style in SHAPES:
        states = list(played(*start(style), frames))
        radius = np.array([state.radius for state in states])
        found[style] = {
            "count": radius.shape[1],
            "frames": len(states),
            "crossings": sum(state.crossings for state in states),
            "changed": max(state.changed for state in states),
            "radius": {"median": float(np.median(radius)), "most": float(radius.max())},
            "wide": float(np.mean(radius > 1.2)),
            "max_stretch": float(max(state.max_stretch for state in states)),
        }
    print(json.dumps({"styles": found}, indent=1))
