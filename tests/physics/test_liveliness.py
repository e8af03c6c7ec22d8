"""Hair that lies in hair moves: nothing would pass through anything either if all of it stood still."""

from pathlib import Path

import ringlet

EXAMPLE = Path(__file__).parents[2] / "examples/child"


def test_locks_of_the_example_move_a_third_of_what_they_do_without_contact_at_least():
    contact = ringlet.read_shot(EXAMPLE / "nod.shot.toml").contact
    assert contact is not None
    stiffness = contact.stiffness
    moves = ringlet.run_bench("liveliness", frames=6, stiffness=stiffness)["off"]
    assert moves[str(stiffness)]["moves_mm"] > moves["without"]["moves_mm"] / 3
