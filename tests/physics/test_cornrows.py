"""Cornrows in a shot: their braids stay on the scalp as groomed, and their tails keep their words."""

import numpy as np
from braids import played, start
from ringlet.data.rigid import best_rotation


def test_cornrows_stay_on_a_nodding_head_and_their_tails_keep_their_words():
    motion, groom = start("cornrows", "x > 3")
    locks = groom.locks
    pinned = locks.point["pin"] == 1.0
    states = list(played(motion, groom, 10))
    assert 2 <= len(states[0].radius) <= 4 and pinned.mean() > 0.5
    assert all(state.crossings == 0 and state.changed == 0 for state in states)
    assert max(state.radius.max() for state in states) < 1.15
    corners = np.unique(groom.scalp.triangles[groom.scalp.region(groom.region)])
    head = motion.clip.at(motion.shot.frames[0] + 10)[corners]
    rigid = best_rotation(groom.scalp.points[corners], head)
    moved = (locks.points - groom.scalp.points[corners].mean(axis=0)) @ rigid + head.mean(axis=0)
    away = np.linalg.norm(motion.strands.positions - moved, axis=1)
    assert away[pinned].max() < 3e-4 < 2e-3 < away.max()  # the scalp bends a little
