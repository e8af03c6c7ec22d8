"""Hair that lies in hair moves: nothing would pass through anything either if all of it stood still."""

from pathlib import Path

import ringlet

EXAMPLE = Path(__file__).parents[2] / "examples/child"


def test_contact_leaves_the_example_a_third_of_its_motion():
    moves = beside("nod", 6)
    assert moves["with"]["moves_mm"] > moves["without"]["moves_mm"] / 3


def test_contact_beside_a_cloth_leaves_locks_a_quarter_of_their_motion():
    """All of them touch one another, and a few of them the ribbon."""
    moves = beside("ribbon", 9)
    assert moves["with"]["moves_mm"] > moves["without"]["moves_mm"] / 4
    assert moves["with"]["still"] == 0


def beside(name, frames):
    """How far locks of a shot of the example move, with contact and without."""
    contact = ringlet.read_shot(EXAMPLE / f"{name}.shot.toml").contact
    assert contact is not None
    told = str(contact.stiffness)
    off = ringlet.run_bench("liveliness", shot=name, frames=frames, stiffness=told)["off"]
    return {"with": off[told], "without": off["without"]}
