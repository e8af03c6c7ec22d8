"""Plots and tables of the theory pages, made from runs: what an energy is to give by formula beside what it gives."""

from __future__ import annotations

from pathlib import Path

from theory import cloth, contact, strand
from theory.answer import Answer, draw, tell
from theory.locks import write_locks

ENERGIES = {
    "stretch": strand.stretch,
    "bend": strand.bend,
    "twist": strand.twist,
    "membrane": cloth.membrane,
    "hinge": cloth.hinge,
    "barrier": contact.barrier,
    "friction": contact.friction,
    "damping": strand.damping,
    "hanging_coil": strand.hanging_coil,
    "outside": strand.outside,
}


def write_theory(folder: Path) -> None:
    """Writes ``theory_NAME.svg`` and ``theory_NAME.md`` of every energy, and the table of locks."""
    write_locks(folder / "theory_locks.md")
    for name, run in ENERGIES.items():
        answer: Answer = run()
        draw(answer, folder / f"theory_{name}.svg")
        tell(answer, folder / f"theory_{name}.md")
