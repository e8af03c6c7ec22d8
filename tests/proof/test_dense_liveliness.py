"""All 1 050 locks of the example keep moving in contact; tests/physics/test_liveliness.py has few of them."""

from pathlib import Path

import ringlet

EXAMPLE = Path(__file__).parents[2] / "examples/child"


def test_contact_leaves_the_example_half_of_its_motion():
    moves = motion("nod", 6)
    assert moves["with"]["moves_mm"] > moves["without"]["moves_mm"] / 2


def test_contact_beside_a_cloth_leaves_locks_a_quarter_of_their_motion():
    """All locks touch each other, and a few touch the ribbon."""
    moves = motion("ribbon", 9)
    assert moves["with"]["moves_mm"] > moves["without"]["moves_mm"] / 4
    assert moves["with"]["still"] == 0


def motion(name, frames):
    """Motion of the locks of a shot of the example, with and without contact."""
    contact = ringlet.read_shot(EXAMPLE / f"{name}.shot.toml").contact
    assert contact is not None
    stiffness = str(contact.stiffness)
    off = ringlet.run_bench("liveliness", shot=name, frames=frames, stiffness=stiffness)["off"]
    return {"with": off[stiffness], "without": off["without"]}
