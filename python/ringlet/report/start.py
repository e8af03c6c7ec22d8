"""Initial penetrations of a simulation (``Cache.start``) in sentences and as a table."""

from __future__ import annotations

from typing import Any


def start_warnings(start: dict[str, Any]) -> list[str]:
    """Warnings about initial penetrations, one sentence each."""
    warnings = []
    for found in start.get("inside", []):
        worst = found["worst"][0]
        warnings.append(
            f"{found['vertices']} vertices of {found['locks']} locks start inside {found['mesh']}, up to "
            f"{1e3 * found['depth']:.2g} mm deep (lock {worst['lock']}, vertex {worst['vertex']}); "
            "they are let out gently."
        )
    for found in start.get("piercing", []):
        subject = f"{found['locks']} locks" if "locks" in found else f"Cloth '{found['what']}'"
        obstacle = "itself" if found["what"] == found["cloth"] else f"cloth '{found['cloth']}'"
        warnings.append(
            f"{subject} start through {obstacle}, in {found['places']} places, and stay so; begin with them apart."
        )
    if pairs := start.get("overlapping", {}).get("coincident", []):
        one, other = pairs[0]
        warnings.append(
            f"Locks {one} and {other}{f' and {len(pairs) - 1} pairs more' if len(pairs) > 1 else ''} coincide where "
            "they start and pass through each other there; move them apart, or delete one."
        )
    return warnings


def start_table(start: dict[str, Any]) -> tuple[list[str], list[list[str]]]:
    """Columns and rows of a table of initial penetrations, and of initial overlaps between locks."""
    found = [(f"inside {inside['mesh']}", inside["vertices"], inside) for inside in start["inside"]]
    found += [
        (f"through cloth {hit['cloth']}", hit["places"], hit) for hit in start.get("piercing", []) if "locks" in hit
    ]
    found.append(("nearer to another lock than they keep", start["overlapping"]["places"], start["overlapping"]))
    rows = [[what, str(count), str(one["locks"]), _depth(one), _places(one["worst"])] for what, count, one in found]
    return ["Locks", "places", "of locks", "depth, mm", "the worst (lock:vertex)"], rows


def _depth(entry: dict[str, Any]) -> str:
    return f"{1e3 * entry['depth']:.3g}" if "depth" in entry else "–"


def _places(worst: list[dict[str, Any]]) -> str:
    return ", ".join(f"{place['lock']}:{place['vertex']}" for place in worst) or "–"
