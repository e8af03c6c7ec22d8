"""Hair in contact keeps moving; a solver that stops all hair would also avoid intersections.

These are 150 locks; tests/proof/test_dense_liveliness.py has all of the example.
"""

from pathlib import Path

import ringlet

EXAMPLE = Path(__file__).parents[2] / "examples/child"


def test_contact_leaves_the_example_its_motion():
    moves = motion("nod", 6)
    assert moves["with"]["moves_mm"] > 0.95 * moves["without"]["moves_mm"]


def test_contact_beside_a_cloth_leaves_locks_most_of_their_motion():
    """Locks touch each other, and a few touch the ribbon."""
    moves = motion("ribbon", 9)
    assert moves["with"]["moves_mm"] > 0.8 * moves["without"]["moves_mm"]
    assert moves["with"]["still"] == 0


def motion(name, frames):
    """Motion of the locks of a shot of the example, with and without contact."""
    contact = ringlet.read_shot(EXAMPLE / f"{name}.shot.toml").contact
    assert contact is not None
    stiffness = str(contact.stiffness)
    off = ringlet.run_bench("liveliness", shot=name, frames=frames, locks=150, stiffness=stiffness)["off"]
    return {"with": off[stiffness], "without": off["without"]}
