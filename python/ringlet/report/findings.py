"""What the numbers of a simulation say, in sentences."""

from __future__ import annotations

import math
from collections.abc import Sequence
from statistics import median
from typing import Any

Statistics = Sequence[dict[str, Any]]
PHASES = ("pairs", "assemble", "solve", "search", "filter")  # of a step with contact


def series(statistics: Statistics, key: str) -> list[float] | None:
    """One number per frame, NaN where a frame lacks it; None when all do. ``energy.bend`` looks inside a dict."""
    found = [value(frame, key) for frame in statistics]
    values = [float(v) if isinstance(v, int | float) else math.nan for v in found]
    return values if any(math.isfinite(v) for v in values) else None


def value(frame: dict[str, Any], key: str) -> Any:
    """What a frame's statistics say, None where they do not; ``energy.bend`` looks inside a dict."""
    found: Any = frame
    for part in key.split("."):
        found = found.get(part) if isinstance(found, dict) else None
    return found


def total(statistics: Statistics, key: str) -> int | None:
    """A count summed over all frames; None when no frame has it."""
    values = series(statistics, key)
    return None if values is None else int(sum(v for v in values if math.isfinite(v)))


def frame_number(statistics: Statistics, index: int) -> str:
    """The number of a frame as text."""
    return f"{statistics[index].get('frame', index + 1):g}"


def worst_frame(statistics: Statistics) -> int | None:
    """The frame to look at first: one with broken numbers, else unsolved strands, else the most stretch.

    What is the same in all frames, as where contact never converges, tells none of them from the others.
    """
    first = None
    for key in ("nan", "unconverged", "max_stretch", "newton_max", "newton"):
        values = series(statistics, key)
        if values and (highest := max(v for v in values if math.isfinite(v))) > 0:
            if len(set(values)) > 1:
                return values.index(highest)
            first = 0
    return first


def verdict(statistics: Statistics) -> list[str]:
    """The outcome in a few sentences, the gravest first."""
    if not statistics:
        return []
    said = []
    if broken := total(statistics, "nan"):
        said.append(f"{_strands(broken)} ended in numbers that are not finite: do not use this result.")
    touching = any("contact" in frame for frame in statistics)
    late = total(statistics, "unconverged")
    if late and touching:
        said.append(f"{_times(late)} the scene ran out of Newton iterations before all of it was at rest in its step.")
    elif late:
        said.append(f"{_times(late)} a strand ran out of Newton iterations before it was at rest in its step.")
    elif late == 0:
        said.append(f"Every strand was solved in each of the {len(statistics)} frames.")
    stretch = series(statistics, "max_stretch")
    if stretch:
        highest = max(v for v in stretch if math.isfinite(v))
        at = frame_number(statistics, stretch.index(highest))
        said.append(f"No edge was ever longer than {100 * highest:.2g} % over its rest length (frame {at}).")
    cloths = dict.fromkeys(name for frame in statistics for name in frame.get("cloth") or {})
    for name in cloths:
        highest = max(v for v in series(statistics, f"cloth.{name}.max_stretch") or [0.0] if math.isfinite(v))
        said.append(f"Cloth '{name}' was stretched or squeezed by at most {100 * highest:.2g} %.")
    if touching:
        kept = total(statistics, "contact.violations") or 0
        said.append(
            f"Nothing passed through anything: {kept:,} times a pair was kept from meeting.".replace(",", "\u202f")
        )
    if any(part < 1.0 for part in series(statistics, "contact.fraction") or []):
        said.append(
            "In some frames bodies left no way out between them: there everything stopped before the frame's end."
        )
    curl = {key: total(statistics, key) for key in ("flips", "winding_changes", "too_straight")}
    if any(curl.values()):
        meaning = {"flips": "curls flipped", "winding_changes": "lost or won a turn", "too_straight": "pulled straight"}
        parts = [f"{meaning[key]}: {count}" for key, count in curl.items() if count]
        said.append(f"The curl did not always hold its shape ({', '.join(parts)}).")
    elif curl["flips"] == 0:
        said.append("No curl flipped over or changed its number of turns.")
    return said


def explain_worst(statistics: Statistics) -> str | None:
    """Why the worst frame is the worst, in one sentence."""
    index = worst_frame(statistics)
    if index is None:
        return None
    frame = statistics[index]
    phrases = {
        "nan": lambda v: f"{v:g} broken strands" if v else None,
        "unconverged": lambda v: f"{v:g} strands unsolved" if v and "contact" not in frame else None,
        "max_stretch": lambda v: f"edges up to {100 * v:.2g} % too long",
        "newton": lambda v: f"{v:.3g} Newton iterations for a strand on average",
        "newton_max": lambda v: f"{v:g} at most",
        "line_search_cuts": lambda v: f"steps cut short {v:g} times" if v else None,
        "flips": lambda v: f"{v:g} flips" if v else None,
        "winding_changes": lambda v: f"{v:g} changes of winding" if v else None,
    }
    known = [phrases[key](frame[key]) for key in phrases if isinstance(frame.get(key), int | float)]
    told = [phrase for phrase in known if phrase]
    return f"Frame {frame_number(statistics, index)} is the hardest: {', '.join(told)}." if told else None


def explain_slowest(statistics: Statistics) -> str | None:
    """Which frame took longest, how long next to the others, and what there was more of; None without times."""
    times = series(statistics, "wall_ms")
    if times is None or len(times) < 3:
        return None
    index = max(range(len(times)), key=lambda k: times[k] if math.isfinite(times[k]) else -math.inf)
    usual = median(time for time in times if math.isfinite(time))
    more = []
    for key, (name, factor, digits) in _COSTS.items():
        values = [v for v in series(statistics, key) or [] if math.isfinite(v)]
        here = value(statistics[index], key)
        if values and isinstance(here, int | float) and here > 1.2 * median(values):
            told, usually = (f"{factor * number:.{digits}f}" for number in (here, median(values)))
            more += [f"{name} {told} instead of {usually}"] if told != usually else []
    said = (
        f"Frame {frame_number(statistics, index)} took longest, {1e-3 * times[index]:.2f} s; "
        f"half of the frames took {1e-3 * usual:.2f} s or less"
    )
    return f"{said}: {', '.join(more)}." if more else f"{said}."


# What a frame's time goes into, as it is told, its factor and its digits.
_COSTS = {
    "newton": ("Newton iterations", 1.0, 1),
    "line_search_cuts": ("steps cut short", 1.0, 0),
    "contact.candidates": ("pairs looked at", 1.0, 0),
    "contact.contacts": ("contacts", 1.0, 0),
    "contact.linear_iterations": ("iterations of conjugate gradients", 1.0, 0),
    **{f"contact.{name}_ms": (f"seconds of {name}", 1e-3, 2) for name in PHASES},
}


def _strands(count: int) -> str:
    return "One strand" if count == 1 else f"{count} strands"


def _times(count: int) -> str:
    return "Once" if count == 1 else f"{count} times"
