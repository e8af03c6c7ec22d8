"""Summaries of simulation statistics in sentences."""

from __future__ import annotations

import math
from collections.abc import Sequence
from statistics import median
from typing import Any

Statistics = Sequence[dict[str, Any]]
PHASES = ("pairs", "assemble", "solve", "search", "filter")  # phases of a step with contact


def series(statistics: Statistics, key: str) -> list[float] | None:
    """One number per frame, NaN for a frame without it; None when all frames lack it.

    key: name, or a path into nested dicts such as ``energy.bend``
    """
    entries = [value(frame, key) for frame in statistics]
    values = [float(v) if isinstance(v, int | float) else math.nan for v in entries]
    return values if any(math.isfinite(v) for v in values) else None


def value(frame: dict[str, Any], key: str) -> Any:
    """Entry of a frame's statistics, None when missing; ``key`` as in ``series``."""
    found: Any = frame
    for part in key.split("."):
        found = found.get(part) if isinstance(found, dict) else None
    return found


def percent(part: float) -> str:
    """A part of 1 in per cent, with two digits or, from 100 % on, whole."""
    return f"{100.0 * part:.2g} %" if 100.0 * part < 99.5 else f"{100.0 * part:.0f} %"


def total(statistics: Statistics, key: str) -> int | None:
    """Sum of a count over all frames; None when no frame has it."""
    values = series(statistics, key)
    return None if values is None else int(sum(v for v in values if math.isfinite(v)))


def frame_number(statistics: Statistics, index: int) -> str:
    """Number of a frame as text."""
    return f"{statistics[index].get('frame', index + 1):g}"


def worst_frame(statistics: Statistics) -> int | None:
    """Index of the frame to inspect first: with NaN, else with unsolved strands, else with the largest stretch.

    A value that is equal in all frames does not select one, as when contact never converges.
    """
    first = None
    for key in ("nan", "unconverged", "max_stretch", "newton_max", "newton"):
        values = series(statistics, key) or []
        finite = [v for v in values if math.isfinite(v)]  # there is no step at the first frame of a shot
        if finite and (highest := max(finite)) > 0:
            if len(set(finite)) > 1:
                return values.index(highest)
            first = values.index(highest)
    return first


def summary(statistics: Statistics) -> list[str]:
    """What a simulation did, in a few sentences; ``judge`` says whether it can be used."""
    if not statistics:
        return []
    sentences = []
    has_contact = any("contact" in frame for frame in statistics)
    unconverged = total(statistics, "unconverged")
    if unconverged and has_contact:
        sentences.append(
            f"{_times(unconverged)} the scene ran out of Newton iterations before all of it was at rest in its step."
        )
        if missing := [v for v in series(statistics, "contact.motion_missing") or [] if math.isfinite(v)]:
            sentences.append(
                f"Its hair misses an estimated {1e3 * max(missing):.2g} mm of its motion in the worst frame, "
                f"{1e3 * median(missing):.2g} mm in the median; more iterations (solver.newton) keep more."
            )
    elif unconverged:
        sentences.append(
            f"{_times(unconverged)} a strand ran out of Newton iterations before it was at rest in its step."
        )
    elif unconverged == 0:
        sentences.append(f"Every strand was solved in each of the {len(statistics)} frames.")
    stretch = series(statistics, "max_stretch")
    if stretch:
        highest = max(v for v in stretch if math.isfinite(v))
        at = frame_number(statistics, stretch.index(highest))
        sentences.append(f"No edge was ever longer than {percent(highest)} over its rest length (frame {at}).")
    cloths = dict.fromkeys(name for frame in statistics for name in frame.get("cloth") or {})
    for name in cloths:
        highest = max(v for v in series(statistics, f"cloth.{name}.max_stretch") or [0.0] if math.isfinite(v))
        sentences.append(f"Cloth '{name}' was stretched or squeezed by at most {percent(highest)}.")
    if has_contact:
        violations = f"{total(statistics, 'contact.violations') or 0:,} times a pair was kept from meeting".replace(
            ",", "\u202f"
        )
        sentences.append(
            f"Nothing passed through anything: {violations}."
            if not (elsewhere := _elsewhere(statistics))
            else f"{violations[0].upper()}{violations[1:]}; {elsewhere}."
        )
    curl = {key: total(statistics, key) for key in ("flips", "winding_changes", "too_straight")}
    if any(curl.values()):
        meaning = {"flips": "curls flipped", "winding_changes": "lost or won a turn", "too_straight": "pulled straight"}
        changes = [f"{meaning[key]}: {count}" for key, count in curl.items() if count]
        sentences.append(f"The curl did not always hold its shape ({', '.join(changes)}).")
    elif curl["flips"] == 0:
        sentences.append("No curl flipped over or changed its number of turns.")
    return sentences


def _elsewhere(statistics: Statistics) -> str:
    """What contact says nothing of, a clause; empty where there is nothing."""
    if any(value(frame, "contact.lagging") for frame in statistics):
        return "what lagged is elsewhere in its animation, where hair may be inside it"
    return (
        "strands of braids that move as their core are inside bodies"
        if any(frame.get("inside") for frame in statistics)
        else ""
    )


def explain_worst(statistics: Statistics) -> str | None:
    """One sentence about the frame of ``worst_frame``; None without one."""
    index = worst_frame(statistics)
    if index is None:
        return None
    frame = statistics[index]
    phrases = {
        "nan": lambda v: f"{v:g} broken strands" if v else None,
        "unconverged": lambda v: f"{v:g} strands unsolved" if v and "contact" not in frame else None,
        "max_stretch": lambda v: f"edges up to {percent(v)} too long",
        "newton": lambda v: f"{v:.3g} Newton iterations for a strand on average",
        "newton_max": lambda v: f"{v:g} at most",
        "line_search_cuts": lambda v: f"steps cut short {v:g} times" if v else None,
        "flips": lambda v: f"{v:g} flips" if v else None,
        "winding_changes": lambda v: f"{v:g} changes of winding" if v else None,
    }
    candidates = [phrases[key](frame[key]) for key in phrases if isinstance(frame.get(key), int | float)]
    reasons = [phrase for phrase in candidates if phrase]
    return f"Frame {frame_number(statistics, index)} is the hardest: {', '.join(reasons)}." if reasons else None


def explain_slowest(statistics: Statistics) -> str | None:
    """One sentence about the slowest frame, with its time and its unusual costs; None for fewer than 3 times."""
    times = series(statistics, "wall_ms")
    if times is None or len(times) < 3:
        return None
    index = max(range(len(times)), key=lambda k: times[k] if math.isfinite(times[k]) else -math.inf)
    usual = median(time for time in times if math.isfinite(time))
    more = []
    for key, (name, factor, digits) in _COSTS.items():
        values = [v for v in series(statistics, key) or [] if math.isfinite(v)]
        cost = value(statistics[index], key)
        if values and isinstance(cost, int | float) and cost > 1.2 * median(values):
            actual, usually = (f"{factor * number:.{digits}f}" for number in (cost, median(values)))
            more += [f"{name} {actual} instead of {usually}"] if actual != usually else []
    sentence = (
        f"Frame {frame_number(statistics, index)} took longest, {1e-3 * times[index]:.2f} s; "
        f"half of the frames took {1e-3 * usual:.2f} s or less"
    )
    return f"{sentence}: {', '.join(more)}." if more else f"{sentence}."


# Costs of a frame: label, factor and digits.
_COSTS = {
    "newton": ("Newton iterations", 1.0, 1),
    "line_search_cuts": ("steps cut short", 1.0, 0),
    "contact.candidates": ("pairs looked at", 1.0, 0),
    "contact.contacts": ("contacts", 1.0, 0),
    "contact.linear_iterations": ("iterations of conjugate gradients", 1.0, 0),
    **{f"contact.{name}_ms": (f"seconds of {name}", 1e-3, 2) for name in PHASES},
}


def _times(count: int) -> str:
    return "Once" if count == 1 else f"{count} times"
