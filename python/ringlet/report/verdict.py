"""The verdict on a simulation: whether it can be used, which frames and locks to look at, and what would help."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass
from itertools import pairwise
from numbers import Real
from typing import Any

from ringlet.report.findings import Statistics, percent, value

MOST_STRAIN = 0.05  # of an edge; hair that is longer looks like rubber
SHOWN = 3  # locks and ranges of frames in a sentence


@dataclass(frozen=True)
class Finding:
    """Something to look at in a simulation.

    what:     what is wrong, a clause
    remedy:   what would help, a clause
    frames:   the frames that show it, ascending
    locks:    the locks that show it, as far as they are known
    unusable: whether the simulation cannot be used with it
    """

    what: str
    remedy: str
    frames: list[int]
    locks: list[int]
    unusable: bool = False

    def sentence(self) -> str:
        """All of it in one sentence."""
        places = f"frame{'s' * (len(self.frames) > 1)} {ranges(self.frames)}"
        if self.locks:
            more = ", …" if len(self.locks) > SHOWN else ""
            places += f"; lock{'s' * (len(self.locks) > 1)} {', '.join(map(str, self.locks[:SHOWN]))}{more}"
        return f"{self.what} ({places}); {self.remedy}."


@dataclass(frozen=True)
class Verdict:
    """What a supervisor asks of a simulation.

    usable:   whether it can be used, after a look at the findings where there are any
    headline: the same in a sentence
    findings: what to look at, the most severe first
    """

    usable: bool
    headline: str
    findings: list[Finding]

    def lines(self) -> list[str]:
        """The headline and the findings, a sentence each."""
        return [self.headline, *(finding.sentence() for finding in self.findings)]

    def json(self) -> dict[str, Any]:
        """The same as plain values."""
        return asdict(self)


def judge(statistics: Statistics) -> Verdict:
    """The verdict on the statistics of a simulation, one dict a frame as in ``Cache.statistics``."""
    looks = (_broken, _stalled, _lagging, _inside, _stretched, _folded, _slow, _unsolved, _changed)
    found = [look(statistics) for look in looks]
    findings = [finding for finding in found if finding]
    usable = not any(finding.unusable for finding in findings)
    if not usable:
        headline = "Do not use this result."
    elif findings:
        frames = sorted({frame for finding in findings for frame in finding.frames})
        headline = f"Look at frame{'s' * (len(frames) > 1)} {ranges(frames)} before you use this result."
    else:
        headline = f"Usable: no frame of {len(statistics)} needs a look."
    return Verdict(usable, headline, findings)


def ranges(frames: Iterable[int]) -> str:
    """Ascending frames as text: 3, 5–9 and 2 ranges more."""
    numbers = list(frames)
    breaks = [k + 1 for k, (one, following) in enumerate(pairwise(numbers)) if following != one + 1]
    parts = [numbers[first:last] for first, last in pairwise([0, *breaks, len(numbers)])]
    texts = [f"{part[0]}" if len(part) == 1 else f"{part[0]}–{part[-1]}" for part in parts]
    left = len(texts) - SHOWN
    more = f" and {left} {'range' if left == 1 else 'ranges'} more" if left > 0 else ""
    return ", ".join(texts[:SHOWN]) + more


def _broken(statistics: Statistics) -> Finding | None:
    frames = _frames(statistics, lambda frame: _number(frame, "nan") > 0)
    if not frames:
        return None
    what = "Positions of strands are not finite"
    return Finding(what, "look for a body or roots that jump there, and raise solver.substeps", frames, [], True)


def _lagging(statistics: Statistics) -> Finding | None:
    late = [(entry, frame) for frame in statistics for entry in value(frame, "contact.lagging") or []]
    if not late:
        return None
    worst, at = max(late, key=lambda found: found[0]["distance"])
    names = sorted({entry["what"] for entry, _ in late})
    which = "" if len(names) == 1 else f"{worst['what']} "
    what = (
        f"{' and '.join(names)} could not arrive, {which}by {1e3 * worst['distance']:.3g} mm in frame "
        f"{at['frame']:g}, and hair may be inside where the animation shows it"
    )
    frames = _frames(statistics, lambda frame: bool(value(frame, "contact.lagging")))
    return Finding(what, "leave it more room, or raise solver.substeps", frames, list(worst["locks"]))


def _inside(statistics: Statistics) -> Finding | None:
    """Strands that cores carry; others have contact of their own."""
    deep = [(entry, frame) for frame in statistics for entry in frame.get("inside", [])]
    if not deep:
        return None
    worst = max(deep, key=lambda found: found[0]["depth"])[0]
    what = f"Strands of braids that move as their core are in {worst['what']}, by up to {1e3 * worst['depth']:.2g} mm"
    remedy = 'raise contact.own_radius, or let these braids move as strands (simulate = "strands")'
    return Finding(what, remedy, _frames(statistics, lambda frame: bool(frame.get("inside"))), list(worst["locks"]))


def _stretched(statistics: Statistics) -> Finding | None:
    frames = [frame for frame in statistics if _number(frame, "max_stretch") > MOST_STRAIN]
    if not frames:
        return None
    worst = max(_number(frame, "max_stretch") for frame in frames)
    locks = list(dict.fromkeys(frame["worst_lock"] for frame in frames if "worst_lock" in frame))
    remedy = "raise solver.newton, or solver.substeps where the head moves fast"
    return Finding(f"Hair is stretched by up to {percent(worst)}", remedy, _numbers(frames), locks)


def _folded(statistics: Statistics) -> Finding | None:
    frames = [frame for frame in statistics if _number(frame, "folds") > 0]
    if not frames:
        return None
    worst = max(frames, key=lambda frame: _number(frame, "folds"))
    what = f"Braids fold, at {worst['folds']:g} points in frame {worst['frame']:g}"
    remedy = 'raise solver.substeps, or let those that move as their core move as strands (simulate = "strands")'
    return Finding(what, remedy, _numbers(frames), list(worst.get("folded_locks", [])))


def _stalled(statistics: Statistics) -> Finding | None:
    """Locks that forces act on, and for which the solver has found no step."""
    frames = [frame for frame in statistics if _number(frame, "stalled") > 0]
    if not frames:
        return None
    count = sum(_number(frame, "stalled") for frame in frames)
    locks = list(dict.fromkeys(lock for frame in frames for lock in frame.get("stalled_locks", [])))
    what = f"The solver found no step {count:g} times, and left in place what had to move"
    return Finding(what, "raise solver.substeps", _numbers(frames), locks)


def _slow(statistics: Statistics) -> Finding | None:
    """Frames that miss more of their motion than the shot tolerates."""
    missing = [
        (_number(frame, "contact.motion_missing"), frame)
        for frame in statistics
        if _number(frame, "contact.motion_missing") > _number(frame, "contact.motion_tolerated", math.inf)
    ]
    if not missing:
        return None
    worst, at = max(missing, key=lambda found: found[0])
    what = (
        f"Hair misses an estimated {1e3 * worst:.2g} mm of its motion in frame {at['frame']:g}, and keeps "
        f"{100 * _number(at, 'contact.motion_kept'):.0f} %"
    )
    remedy = "try solver.newton = 8 and solver.linear_tolerance = 0.1; ringlet converge says what is enough"
    return Finding(what, remedy, _numbers([frame for _, frame in missing]), [])


def _unsolved(statistics: Statistics) -> Finding | None:
    """Without contact; with contact the motion that is kept says more."""
    frames = [frame for frame in statistics if "contact" not in frame and _number(frame, "unconverged") > 0]
    if not frames:
        return None
    locks = list(dict.fromkeys(lock for frame in frames for lock in frame.get("unconverged_locks", [])))
    return Finding("Strands were not at rest in their step", "raise solver.newton", _numbers(frames), locks)


def _changed(statistics: Statistics) -> Finding | None:
    meaning = {"flips": "flipped over", "winding_changes": "lost or won a turn", "too_straight": "pulled straight"}
    counts = {key: sum(_number(frame, key) for frame in statistics) for key in meaning}
    if not any(counts.values()):
        return None
    what = ", ".join(f"{meaning[key]} {count:g}" for key, count in counts.items() if count)
    frames = _frames(statistics, lambda frame: any(_number(frame, key) > 0 for key in meaning))
    remedy = "look for what pulls at them there, and raise solver.substeps"
    return Finding(f"Curls did not hold their shape: {what}", remedy, frames, [])


def _number(frame: dict[str, Any], key: str, missing: float = 0.0) -> float:
    found = value(frame, key)
    return float(found) if isinstance(found, Real) and math.isfinite(found) else missing


def _numbers(frames: list[dict[str, Any]]) -> list[int]:
    return [int(frame["frame"]) for frame in frames]


def _frames(statistics: Statistics, shows: Callable[[dict[str, Any]], bool]) -> list[int]:
    return _numbers([frame for frame in statistics if shows(frame)])
