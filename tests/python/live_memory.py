"""How much more memory live hair has at the end of many steps, with all that a session does to it."""

import resource
from pathlib import Path

from ringlet.viewer.play.mover import Hand, LiveScene, Mover, step_message

import ringlet

PAGE_SIZE = resource.getpagesize()
EVERY = 240  # steps after which a motion begins, and the groom changes
SAMPLES = 20  # of memory in each half of the steps, whose least counts


def growth(groom: ringlet.Groom, other: ringlet.Groom, steps: int) -> float:
    """Growth of resident memory from the first half of the steps to the second, after a tenth of them [bytes]."""
    mover, hand = Mover(LiveScene(groom, None, []), print), Hand()
    seen = list[int]()
    for step in range(steps):
        if step % EVERY == 0:
            hand.motions.put("nod" if step // EVERY % 2 else "turn")
            hand.side = "left" if step // EVERY % 3 else ""
            mover.change(LiveScene(other if step // EVERY % 2 else groom, None, []))
        mover.step(hand, mover.live.dt)
        step_message(1, step, mover, "")
        if step >= steps // 10 and step % max(1, steps // (2 * SAMPLES)) == 0:
            seen.append(PAGE_SIZE * int(Path("/proc/self/statm").read_text().split()[1]))
    middle = len(seen) // 2
    return min(seen[middle:]) - min(seen[:middle])
