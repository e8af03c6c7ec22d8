"""The words of a shot's locks, before a frame is simulated and after."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.groom import GROOM, Groom
from ringlet.data.mesh import Clip
from ringlet.data.motion import MotionWords, Word
from ringlet.motion import HangingLocks, Words, advised_steps, seen_motion
from ringlet.shot.shot import Shot
from ringlet.sim.cores import Cores
from ringlet.sim.hanging import hang
from ringlet.sim.motion import check_locks
from ringlet.sim.roots import Roots
from ringlet.sim.shot_strands import ASKED, WANTED, make_strands, steps_of, with_words

Array = NDArray[np.float64]

UNITS = {"bounce": "Hz", "settle": "s", "sag": "", "swing": "Hz"}
SUCH_AS = 3  # locks that a sentence names
AGREES = 0.05  # deviation from what was asked that is none, relative to it
NEAR = 0.15  # deviation from it in a simulation, where contact and swings disturb what is found
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
    words, unmet, came_out, ids = list[Word](), list[str](), list[str](), locks.ids
    made_to_stand = np.zeros(len(locks), bool) if stiffened is None else np.asarray(stiffened) > 1.0
    for group, of_all, of_simulated in _groups(groom, locks):
        for name, unit in UNITS.items():
            word = Word(group, name, unit, shown=getattr(shown, name)[of_simulated])
            if (asked := locks.curve.get(f"{ASKED}{name}")) is not None:
                word.asked = asked[of_simulated]
                falls = made_to_stand | _falls_when_softer(hanging, asked / getattr(shown, name))
                unmet += _unmet(word, falls[of_simulated] & (unit == "Hz"), ids[of_simulated])
            if name != "sag":
                word.by_itself = getattr(by_itself, name)[of_simulated]
            if seen and name in ("bounce", "settle"):
                word.found = getattr(seen, name)[of_all]
                if asked is not None:
                    came_out += _came_out(word, asked[cores.simulated][of_all])
            words.append(word)
        if seen:
            words += [Word(group, name, "", found=getattr(seen, name)[of_all]) for name in ("opens", "closes")]
    return MotionWords(words, [*came_out, *unmet, *_notes(shot, clip, shown, by_itself)])


def describe_lock(shot: Shot, groom: Groom, row: int) -> str:
    """The words of one lock as the steps of a shot show it without contact, and how stiff that makes it.

    With a rest shape it hangs as groomed, with the stiffness that it has before it is stiffened to stand.
    """
    made = with_words(shot, replace(groom, locks=groom.locks.take(np.array([row]))))
    strands, groomed = make_strands(shot, made), np.array(made.locks.points, np.float64)
    strands.place(groomed)
    hanging = hang(strands, groomed, shot.forces.gravity, settle=shot.rest.mode == "none")
    words = hanging.words(steps_of(shot, groom.space.fps))
    stiffer = shot.strands.bend_scale * made.locks.curve.get(WANTED["bend"], np.ones(1))[0]
    if np.isnan(words.bounce[0]):
        return "no bounce: it is pinned beyond its root, limp, or falls over"
    return (
        f"bounce {words.bounce[0]:.3g} Hz, settles in {words.settle[0]:.2g} s, swing {words.swing[0]:.3g} Hz, sag "
        f"{100.0 * words.sag[0]:.2g} %, {stiffer:.2g} times as stiff as hair"
    )


def _groups(groom: Groom, simulated: Curves) -> list[tuple[str, NDArray[np.bool_], NDArray[np.bool_]]]:
    """The grooms of a head, by name, each with masks of its locks among all and among those that are simulated."""
    if not groom.grooms:
        return [("locks", np.ones(len(groom.locks), bool), np.ones(len(simulated), bool))]
    return [
        (name, groom.locks.curve[GROOM] == row, simulated.curve[GROOM] == row) for row, name in enumerate(groom.grooms)
    ]


def _falls_when_softer(hanging: HangingLocks, slower: Array) -> NDArray[np.bool_]:
    """Locks that would not stay in place if they were so much softer that frequencies are that much slower."""
    softer = np.clip(np.nan_to_num(slower, nan=1.0), 1e-3, 1.0) ** 2
    return np.isnan(hanging.modes.bounce(softer).elastic)


def _unmet(word: Word, falls: NDArray[np.bool_], ids: NDArray[np.int64]) -> Iterable[str]:
    """Sentences about locks that do not show a word as asked.

    falls: whether each would fall over if it were so soft, shape (count,)
    """
    off = ~(np.abs(word.shown / word.asked - 1.0) <= AGREES)
    fall = off & falls & (word.shown > word.asked)
    if fall.any():
        median, most = np.percentile(word.shown[fall], [50.0, 90.0])
        yield (
            f"{fall.sum()} of {off.size} {word.group} cannot stand at the {word.name} that is asked, such as lock "
            f"{', '.join(str(lock) for lock in ids[fall][:SUCH_AS])}: as stiff as they must be to stand, they show "
            f"{median:.3g} {word.unit}. Ask for {most:.2g} {word.unit}, at which nine in ten of them stand, or groom "
            "wider or shorter coils: twice the width, or a quarter of the length, stands at half the bounce."
        )
    if (others := off & ~fall).any():
        yield (
            f"{others.sum()} of {off.size} {word.group} do not show the {word.name} that is asked: they are pinned, "
            "bounce faster by their weight alone, hang out until they are straight, or are settled sooner by the steps "
            "or the air."
        )


def _came_out(word: Word, asked: Array) -> Iterable[str]:
    """A sentence about what a simulation showed of a word that was asked of each lock."""
    known = ~np.isnan(word.found)
    if known.any():
        near = np.abs(word.found / asked - 1.0) <= NEAR
        yield (
            f"In the simulation {near.sum()} of {near.size} {word.group} show the {word.name} that is asked within "
            f"{100.0 * NEAR:.0f} %; the median is {np.median(word.found[known]):.3g} {word.unit}."
        )
    elif word.name == "settle":
        yield (
            f"The simulation does not show how soon {word.group} settle: their roots move until its end. Let the shot "
            f"run on for half a second, or as long as they are to ring."
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
