"""What was in the way when a simulation began (``Cache.start``), in sentences and as a table."""

from __future__ import annotations

from typing import Any


def start_warnings(start: dict[str, Any]) -> list[str]:
    """What the artist should mend, a sentence each."""
    said = []
    for found in start.get("inside", []):
        worst = found["worst"][0]
        said.append(
            f"{found['vertices']} vertices of {found['locks']} locks start inside {found['mesh']}, up to "
            f"{1e3 * found['depth']:.2g} mm deep (lock {worst['lock']}, vertex {worst['vertex']}); "
            "they are let out gently."
        )
    for found in start.get("piercing", []):
        what = f"{found['locks']} locks" if "locks" in found else f"Cloth '{found['what']}'"
        through = "itself" if found["what"] == found["cloth"] else f"cloth '{found['cloth']}'"
        said.append(f"{what} start through {through}, in {found['places']} places, and stay so; begin with them apart.")
    return said


def start_table(start: dict[str, Any]) -> tuple[list[str], list[list[str]]]:
    """Columns and rows: what is inside what, and how many places of locks are nearer to others than they keep."""
    found = [(f"inside {inside['mesh']}", inside["vertices"], inside) for inside in start["inside"]]
    found += [
        (f"through cloth {hit['cloth']}", hit["places"], hit) for hit in start.get("piercing", []) if "locks" in hit
    ]
    found.append(("nearer to another lock than they keep", start["overlapping"]["places"], start["overlapping"]))
    rows = [[what, str(count), str(told["locks"]), _depth(told), _places(told["worst"])] for what, count, told in found]
    return ["Locks", "places", "of locks", "depth, mm", "the worst (lock:vertex)"], rows


def _depth(told: dict[str, Any]) -> str:
    return f"{1e3 * told['depth']:.3g}" if "depth" in told else "–"


def _places(worst: list[dict[str, Any]]) -> str:
    return ", ".join(f"{place['lock']}:{place['vertex']}" for place in worst) or "–"
