"""Random recipes within the bounds of the schema."""

from __future__ import annotations

import math
from typing import Any

from numpy.random import Generator

import ringlet

MOST = {"count": 40, "points": 60, "shape_points": 30, "per_lock": 6, "levels": 4, "strands": 4, "density": 3}
LARGEST = {"m": 0.3, "deg": 180.0}  # of settings, by unit
OF_SECTIONS = {"Braid", "Twist", "Cornrow", "Knot", "Loc"}  # operators on the strands of sections
ONE_OF = {"count", "spacing", "curls", "pitch", "curls_per_cm", "density", "cover"}  # exclude one another
NAMES = {"curve": "tail", "line": "tail", "mesh": "round"}
HELPERS = {
    "curves": {"tail": {"points": [[0, 8, -8], [0, 6, -11], [0, -4, -12]]}},
    "meshes": {"round": {"middle": [0, 0, 0], "width": 30, "height": 30, "depth": 30}},
}


class Settings:
    """Random values of settings within the bounds of a schema."""

    def __init__(self, random: Generator, kind: str) -> None:
        self.random, self.schema = random, ringlet.schema()[kind]

    def table(self, name: str, share: float = 0.3, **given: Any) -> dict[str, Any]:
        """A table with a share of its settings."""
        made = {
            key: value
            for key, node in self.schema["$defs"][name]["properties"].items()
            if key not in given and key not in ONE_OF and self.random.random() < share
            if (value := self.value(key, node)) is not None
        }
        return made | given

    def value(self, key: str, node: dict[str, Any]) -> Any:
        """A value of one setting; None for one that refers to what is not there."""
        choices = [
            one for one in node.get("anyOf", [node]) if one.get("type") not in ("null", "string") or "enum" in one
        ]
        if key in NAMES:
            return NAMES[key]
        if not choices or key in ("map", "region", "lock", "seed", "preset", "where", "file", "prim"):
            return None
        one = choices[self.random.integers(len(choices))]
        if "$ref" in one:
            number = next((other for other in choices if "maximum" in other), None)
            return self.varied(key, number, node) if number and one["$ref"].rpartition("/")[2] != "Mask" else None
        if "enum" in one:
            return one["enum"][self.random.integers(len(one["enum"]))]
        if one.get("type") == "boolean":
            return bool(self.random.integers(2))
        return self.number(key, one, node) if one.get("type") in ("integer", "number") else None

    def number(self, key: str, bounds: dict[str, Any], node: dict[str, Any]) -> float | int:
        """A number within its bounds, of any size, and a bound itself now and then."""
        unit = node.get("unit", "")
        least = bounds.get("minimum", bounds.get("exclusiveMinimum", 0.0))
        most = min(bounds.get("maximum", 1.0), MOST.get(key, math.inf), LARGEST.get(unit, math.inf))
        if bounds["type"] == "integer":
            return int(self.random.integers(least, most + 1))
        if "minimum" in bounds and self.random.random() < 0.1:
            return self.in_text(least, unit)
        smallest = max(least, 1e-3 * most) if least >= 0.0 else least
        found = (
            self.random.uniform(least, most) if least < 0.0 else smallest * (most / smallest) ** self.random.random()
        )
        return self.in_text(found, unit)

    def in_text(self, value: float, unit: str) -> Any:
        """A length in metres as text, another number as it is."""
        return f"{1e3 * value:.9g} mm" if unit == "m" else float(f"{value:.9g}")

    def varied(self, key: str, bounds: dict[str, Any], node: dict[str, Any]) -> dict[str, Any]:
        """A value with chance."""
        return {"value": self.number(key, bounds, node), "vary": round(self.random.random(), 3)}

    @property
    def operators(self) -> list[str]:
        """Names of the definitions of all operators."""
        found = self.schema["properties"]["shape"]["items"]["discriminator"]["mapping"]
        return [place.rpartition("/")[2] for place in found.values()]

    def recipe(self, operators: int = 3) -> dict[str, Any]:
        """A recipe of a few locks, with random operators."""
        names = self.operators
        some = [names[self.random.integers(len(names))] for _ in range(self.random.integers(operators + 1))]
        ops = {name: self.schema["$defs"][name]["properties"]["op"]["const"] for name in names}
        locks = self.table(
            "Locks", 0.2, count=int(self.random.integers(1, 25)), points=int(self.random.integers(8, 60))
        )
        if OF_SECTIONS & set(some):
            size, strands = f"{self.random.uniform(25, 60):.3f} mm", int(self.random.integers(2, 4))
            locks |= {"sections": {"pattern": "grid", "size": size, "strands": strands}}
        return {
            "ringlet": 2,
            "seed": int(self.random.integers(100)),
            "scalp": {"region": "scalp"},
            **HELPERS,
            "guides": self.table("Grown", 0.2, count=int(self.random.integers(1, 20)), length=self.length()),
            "locks": locks,
            "shape": [self.table(name, op=ops[name]) for name in some],
            **(
                {"curl": self.table("Curl", 0.3, curls=self.random.uniform(0.0, locks["points"] / 8))}
                if self.random.random() < 0.5
                else {}
            ),
            "hairs": self.table("HairSettings", 0.2, per_lock=int(self.random.integers(1, 6))),
        }

    def length(self) -> str:
        """A length of hair."""
        return f"{10.0 ** self.random.uniform(0.5, 2.3):.4g} mm"
