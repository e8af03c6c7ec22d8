"""Statistics of a frame: the solver's reports of its substeps, summed up. Those of the result are in ``written.py``."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

TOLERATED = 0.05  # of a frame's motion may be missing


@dataclass
class StepReports:
    """The solver's reports of the steps of one frame.

    strands: per step an array of a value per strand, by quantity
    scene:   per step a value, by quantity; empty without contact
    cloths:  per step the same of each cloth
    """

    strands: list[dict[str, NDArray[np.float64]]] = field(default_factory=list)
    scene: list[dict[str, float]] = field(default_factory=list)
    cloths: list[list[dict[str, float]]] = field(default_factory=list)


def frame_statistics(
    reports: StepReports,
    locks: NDArray[np.integer],
    cloths: list[str],
    penetrating: int,
    lagging: list[dict[str, Any]],
    vertices: int,
    accuracy: float,
) -> dict[str, Any]:
    """Statistics of a frame, by name: of strands, of contact and of each cloth, where there are any.

    locks:   their ids, shape (count,)
    cloths:  their names
    penetrating: the number of vertices with initial penetration that are still inside a body
    lagging: what did not arrive in the frame (see ``lag.py``)
    vertices: the number of vertices of the scene that move
    accuracy: motion that a frame may miss [m]
    """
    return {
        **_of_strands(reports.strands, locks),
        **(_of_contact(reports.scene, penetrating, lagging, vertices, accuracy) if reports.scene else {}),
        **({"cloth": _of_cloths(reports.cloths, cloths)} if cloths else {}),
    }


def _of_strands(reports: list[dict[str, NDArray[np.float64]]], locks: NDArray[np.integer]) -> dict[str, Any]:
    """Over all strands and substeps: sums of events, the worst values, energies at the end."""
    last = reports[-1]

    def locks_with(name: str) -> list[int]:
        return [int(lock) for lock in locks[np.any([report[name] > 0 for report in reports], axis=0)]]

    def total(name: str) -> int:
        return int(sum(report[name].sum() for report in reports))

    def worst(name: str) -> float:
        return float(max(report[name].max() for report in reports))

    return {
        "newton": float(np.mean([report["newton"].mean() for report in reports])),
        "newton_max": int(worst("newton")),
        "unconverged": total("unconverged"),
        "unconverged_locks": locks_with("unconverged"),
        "stalled": total("stalled"),
        "stalled_locks": locks_with("stalled"),
        "line_search_cuts": total("cuts"),
        "residual": worst("residual"),
        "energy": {name: float(last[name].sum()) for name in ("stretch", "bend", "twist", "gravity", "kinetic")},
        "flips": total("flips"),
        "winding_changes": total("winding_changes"),
        "too_straight": total("too_straight"),
        "clamped": total("clamped"),
        "nan": total("nan"),
    }


def _of_cloths(reports: list[list[dict[str, float]]], names: list[str]) -> dict[str, Any]:
    """Of each cloth, by name: its worst stretch over the substeps, and its energies at the end."""
    return {
        name: {
            "max_stretch": max(report[k]["max_stretch"] for report in reports),
            "energy": {term: reports[-1][k][term] for term in ("stretch", "bend", "gravity", "kinetic")},
            "nan": int(sum(report[k]["nan"] for report in reports)),
        }
        for k, name in enumerate(names)
    }


def _motion(reports: list[dict[str, float]], vertices: int, accuracy: float) -> dict[str, float | None]:
    """What a frame's iterations have made of its motion, estimated from what is left of the last direction.

    It is that of what is solved; strands that cores carry keep the same part of theirs, within 0.01 in
    tests/python/test_written.py. Distances are root mean squares over the vertices [m].

    motion_kept:      the part that was made; None where nothing has moved or is missing
    motion_missing:   what is missing
    motion_tolerated: what may be missing: the accuracy, or a part of a long motion
    """
    moved, left = (sum(report[name] for report in reports) for name in ("moved", "left"))
    missing, steps = max(left, 0.0), len(reports)
    kept = moved / (moved + missing) if moved + missing > 0.0 else None
    motion = math.sqrt(steps * moved / vertices)
    # What is missing is a part of the motion, but for what has not moved at all.
    lacking = motion * missing / moved if moved > 0.0 else math.sqrt(steps * missing / vertices)
    return {
        "motion_kept": kept,
        "motion_missing": lacking,
        "motion_tolerated": max(accuracy, TOLERATED * (motion + lacking)),
    }


def _of_contact(
    reports: list[dict[str, float]],
    penetrating: int,
    lagging: list[dict[str, Any]],
    vertices: int,
    accuracy: float,
) -> dict[str, Any]:
    """Over all substeps of a scene. It is solved as one, so its iterations replace those of the strands."""

    def total(name: str) -> float:
        return sum(report[name] for report in reports)

    closest = min(report["closest"] for report in reports)
    times = [name for name in reports[0] if name.startswith("time_")]
    return {
        "newton": float(np.mean([report["newton"] for report in reports])),
        "newton_max": int(max(report["newton"] for report in reports)),
        "unconverged": int(total("unconverged")),
        "unconverged_locks": [],
        "stalled": int(total("stalled")),
        "line_search_cuts": int(total("cuts")),
        "residual": max(report["residual"] for report in reports),
        "contact": {
            "candidates": int(reports[-1]["candidates"]),
            "contacts": int(reports[-1]["contacts"]),
            "closest": closest if np.isfinite(closest) else None,
            "violations": int(total("violations")),
            "zone_vertices": int(total("zone_vertices")),
            "excused": penetrating,
            "linear_iterations": int(total("linear_iterations")),
            **_motion(reports, vertices, accuracy),
            "lag": reports[-1]["lag"],
            **({"lagging": lagging} if lagging else {}),
            **{f"{name}_ms".removeprefix("time_"): 1e3 * total(name) for name in times},
        },
    }
