"""Cornrows in a shot: their braids stay on the scalp as groomed, and their tails keep their words."""

import numpy as np
from braids import same, turned
from judged_shots import EXAMPLE, judged
from ringlet.data.groom import SECTION, STRAND_RADIUS
from ringlet.data.rigid import best_rotation
from ringlet.groom.scalp import Scalp
from ringlet.groom.shares import LAID

from ringlet import api
from ringlet.groom import parse_recipe, weave

RECIPE = """
ringlet = 1
seed = 5
[scalp]
file = "head.usdc"
mesh = "/child/skin"
region = "scalp"
[guides]
count = 60
[locks]
points = 300
[locks.sections]
pattern = "rows"
size = 3
gap = 0.3
strands = 3
mask = { where = "x > 3" }
[[shape]]
op = "cornrow"
width = 1
height = 0.6
pitch = 2.2
length = 7
tail = 0.8
"""


def test_cornrows_stay_on_a_nodding_head_and_their_tails_keep_their_words():
    groom = api.build_groom(parse_recipe(RECIPE, EXAMPLE / "cornrows.recipe.toml"))
    locks, middle = groom.locks, Scalp(groom.scalp, groom.region).middle
    sections = np.unique(locks.curve[SECTION])
    assert 2 <= len(sections) <= 4
    nod = api.read_shot(EXAMPLE / "nod.shot.toml")
    thickness = 0.7 * float(locks.curve[STRAND_RADIUS].max())
    motion = api.start_motion(
        nod.model_copy(update={"contact": nod.contact.model_copy(update={"radius": thickness})}), groom
    )

    def tails(points):
        """Cross-sections of the woven part of each tail."""
        strands = points.reshape(len(locks), -1, 3)
        found = []
        for section in sections:
            own = locks.curve[SECTION] == section
            along = np.linspace(0.0, 1.0, strands.shape[1]) * locks.lengths()[own].min()
            woven = (along > locks.curve[LAID][own].max() + 0.005) & (along < along[-1] - 0.025)
            found.append(weave.cross_sections(strands[own], middle)[:, woven])
        return found

    groomed, nailed = tails(locks.points), locks.point["nail"] == 1.0
    words = [weave.braid_word(places) for places in groomed]
    assert all(len(word) >= 3 for word in words) and nailed.mean() > 0.5
    for frame in judged(motion, 10):
        assert not frame.crossings
        now = [turned(a, b) for a, b in zip(tails(motion.strands.positions), groomed, strict=True)]
        assert all(same(weave.braid_word(a), word) for a, word in zip(now, words, strict=True))
    skull = groom.scalp.region(groom.region)
    corners = np.unique(groom.scalp.triangles[skull])
    head = motion.clip.at(motion.shot.frames[0] + 10)[corners]
    rigid = best_rotation(groom.scalp.points[corners], head)
    moved = (locks.points - groom.scalp.points[corners].mean(axis=0)) @ rigid + head.mean(axis=0)
    away = np.linalg.norm(motion.strands.positions - moved, axis=1)
    assert away[nailed].max() < 3e-4 < 2e-3 < away.max()  # the scalp bends a little
