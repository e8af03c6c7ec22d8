"""The words of a shot's locks, before a frame is simulated and after."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.groom import GROOM, Groom
from ringlet.data.mesh import Clip
from ringlet.data.motion import MotionWords, Word
from ringlet.motion import Words, advised_steps, seen_motion
from ringlet.shot.shot import Shot
from ringlet.sim.cores import Cores
from ringlet.sim.hanging import hang
from ringlet.sim.motion import check_locks
from ringlet.sim.roots import Roots
from ringlet.sim.shot_strands import ASKED, make_strands, steps_of, with_words

Array = NDArray[np.float64]

UNITS = {"bounce": "Hz", "settle": "s", "sag": "", "swing": "Hz"}
AGREES = 0.05  # deviation from what was asked that is none, relative to it
KEPT = 0.8  # part of its own time to settle that a bounce keeps at the advised steps, and that is enough


def words_of_shot(
    shot: Shot,
    groom: Groom,
    clip: Clip,
    rest: Curves | None,
    simulated: Iterable[NDArray[np.floating]] | None = None,
) -> MotionWords:
    """The words of the locks of a groom where they hang at the first frame of a shot, without contact.

    rest:      their rest shape, where that is not the groom
    simulated: positions of all locks at successive frames [m], shape (n, 3) each, to find the words there too
    """
    check_locks(shot, groom.locks)
    cores, first = Cores.of(groom), shot.frames[0]
    rest = rest and cores.reduced(rest)
    made = with_words(shot, cores.groom, cores.material())
    locks = made.locks
    stiffened = None if rest is None else rest.curve.get("stiffened")
    strands = make_strands(shot, made, rest, stiffened, cores.material())
    groomed = Roots(cores.groom).carry(clip.at(first), first)
    strands.place(groomed)
    hanging = hang(strands, groomed, shot.forces.gravity)
    steps = steps_of(shot, clip.fps)
    shown, by_itself = hanging.words(steps), hanging.words()
    seen = simulated and seen_motion(groom.locks, simulated, shot.forces.gravity, clip.fps)
    words = list[Word]()
    for group, of_all, of_simulated in _groups(groom, locks):
        for name, unit in UNITS.items():
            word = Word(group, name, unit, shown=getattr(shown, name)[of_simulated])
            if (asked := locks.curve.get(f"{ASKED}{name}")) is not None:
                word.asked = asked[of_simulated]
            if name != "sag":
                word.by_itself = getattr(by_itself, name)[of_simulated]
            if seen and name in ("bounce", "settle"):
                word.found = getattr(seen, name)[of_all]
            words.append(word)
        if seen:
            words += [Word(group, name, "", found=getattr(seen, name)[of_all]) for name in ("opens", "closes")]
    return MotionWords(words, [*_unmet(words), *_notes(shot, clip, shown, by_itself)])


def _groups(groom: Groom, simulated: Curves) -> list[tuple[str, NDArray[np.bool_], NDArray[np.bool_]]]:
    """The grooms of a head, by name, each with masks of its locks among all and among those that are simulated."""
    if not groom.grooms:
        return [("locks", np.ones(len(groom.locks), bool), np.ones(len(simulated), bool))]
    return [
        (name, groom.locks.curve[GROOM] == row, simulated.curve[GROOM] == row) for row, name in enumerate(groom.grooms)
    ]


def _unmet(words: list[Word]) -> Iterable[str]:
    """Sentences about words that some locks do not show as asked."""
    for word in words:
        if word.asked.size and (off := ~(np.abs(word.shown / word.asked - 1.0) <= AGREES)).any():
            yield (
                f"{off.sum()} of {off.size} {word.group} do not show the {word.name} that is asked: they are pinned, "
                f"bounce faster by their weight alone, or are settled sooner by the steps or the air."
            )


def _notes(shot: Shot, clip: Clip, shown: Words, by_itself: Words) -> Iterable[str]:
    """Sentences about locks without words, and about what the steps take from the bounce."""
    none = int(np.isnan(shown.bounce).sum())
    if none:
        yield f"{none} of {len(shown.bounce)} locks have no words: they are pinned beyond the root, limp, or fall over."
    if none == len(shown.bounce):
        return
    bounce, settle, own_bounce, own_settle = (
        float(np.nanmedian(values)) for values in (shown.bounce, shown.settle, by_itself.bounce, by_itself.settle)
    )
    if settle >= KEPT * own_settle and bounce >= KEPT * own_bounce:
        return
    solver = shot.solver
    yield (
        f"The steps end the bounce: by itself the median lock bounces at {own_bounce:.3g} Hz and settles in "
        f"{own_settle:.2g} s, with {solver.integrator} at {clip.fps:g} frames a second and solver.substeps = "
        f"{solver.substeps} it shows {bounce:.3g} Hz and {settle:.2g} s."
    )
    # Rates of decay add up, so that of the steps is to be what is missing.
    enough = advised_steps(own_bounce, own_settle * KEPT / (1.0 - KEPT), clip.fps)
    options = [f'solver.integrator = "{name}" and solver.substeps = {count}' for name, count in enough.items()]
    yield f"It keeps its bounce with {', or '.join(options)}." if options else "No number of substeps keeps it."
