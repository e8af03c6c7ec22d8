"""How a lock of each type moves by the default material, and by published figures that differ from it.

python docs/theory/locks.py FILE.md writes the table alone, in some seconds.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from ringlet.data.files import replacing
from ringlet.motion import Words
from ringlet.shot.material import Material
from ringlet.sim.hanging import hang
from ringlet.sim.strands import Strands
from ringlet.validate.bounce import COILS, GRAVITY, LOCKS, lock
from ringlet.validate.rods import strand

STRAIGHT = (0.1, 0.2, 0.25)  # lengths [m]
DEFAULT = Material()
TWIST = 2 * 0.89 / 3.89  # GJ / EI of round hair with the moduli of Robbins [GPa]
SOFTER, HEAVIER = 2.5, 1.3  # wet hair, by Young's modulus and by the water that it takes up
TWISTED = DEFAULT.model_copy(update={"twist_ratio": TWIST})
WET = DEFAULT.model_copy(
    update={"youngs_modulus": DEFAULT.youngs_modulus / SOFTER, "density": DEFAULT.density * HEAVIER}
)


def words(kind: str, material: Material) -> Words:
    """The words of a lock of a type that hangs alone, as with infinitely short steps."""
    curves = lock(kind)
    points = np.asarray(curves.points, np.float64)
    return hang(Strands(curves, material, 3), points, (0.0, -GRAVITY, 0.0)).words()


def straight_swing(length: float) -> float:
    """How often a straight lock of a length [m] swings [Hz]."""
    along = np.linspace(0.0, length, 60)
    points = np.c_[0.0 * along, -along, 0.0 * along]
    return float(hang(strand(points, DEFAULT, 3), points, (0.0, -GRAVITY, 0.0)).words().swing[0])


def write_locks(path: Path) -> None:
    """A row a type: its size, its words, the loss factor of its bounce, and its bounce by the other figures."""
    lines = [
        "| type | long [cm] | wide/ pitch [mm] | bounce [Hz] | settle [s] | loss factor | swing [Hz] "
        f"| bounce, twist {TWIST:.2f} | bounce, wet | longer, wet |",
        "|---" * 10 + "|",
        *(
            f"| straight | {100 * length:.0f} | – | – | – | – | {straight_swing(length):.1f} | – | – | – |"
            for length in STRAIGHT
        ),
    ]
    for kind, (length, _) in LOCKS.items():
        dry, twisted, wet = (words(kind, material) for material in (DEFAULT, TWISTED, WET))
        loss = 2.0 * np.log(20.0) / (dry.settle[0] * 2.0 * np.pi * dry.bounce[0])
        longer = (1.0 + wet.sag[0]) / (1.0 + dry.sag[0]) - 1.0
        wide, _, pitch, _, _ = COILS[kind]
        lines.append(
            f"| {kind} | {100 * length:.0f} | {wide}/{pitch} | {dry.bounce[0]:.1f} | {dry.settle[0]:.2f} | {loss:.2f} "
            f"| {dry.swing[0]:.1f} | {twisted.bounce[0]:.1f} | {wet.bounce[0]:.1f} | {100.0 * longer:.0f} % |"
        )
    with replacing(path) as aside:
        aside.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    write_locks(Path(sys.argv[1]))
