"""Tries that look for silent wrong values: python tests/fuzz/tries.py [AREA] [FIRST] [COUNT].

A try is the function ``attempt`` of a file in ``areas/``, given a random generator and an empty folder. AREA and a
number seed it: ``tries.py heads 17 1`` repeats one. It makes input of random settings and asserts what holds for any. A
UserError in one line is a refusal. All else that is raised is a finding, printed with its number.
"""

from __future__ import annotations

import sys
import tempfile
import traceback
import zlib
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path

import numpy as np

import ringlet

sys.path.append(str(Path(__file__).parents[1] / "python"))
AREAS = ("recipes", "asked", "used", "heads", "shots", "rates", "resumes", "formats", "names", "bounds")


@contextmanager
def limited(seconds: int) -> Iterator[None]:
    """Raises TimeoutError in work that takes longer."""
    import signal

    def stop(*_: object) -> None:
        raise TimeoutError(f"takes over {seconds} s")

    signal.signal(signal.SIGALRM, stop)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)


def attempt(area: str, number: int, seconds: int = 120) -> str:
    """Runs a try: ``held``, ``refused``, or what is wrong in one line."""
    random = np.random.default_rng([zlib.crc32(area.encode()), number])
    with tempfile.TemporaryDirectory() as folder:
        try:
            with limited(seconds):
                import_module(f"areas.{area}").attempt(random, Path(folder))
        except ringlet.UserError as error:
            return "refused" if "\n" not in str(error) else f"refused in several lines: {error}"
        except AssertionError as error:
            return (
                str(error).splitlines()[0]
                if str(error)
                else f"asserts: {traceback.extract_tb(error.__traceback__)[-1].line}"
            )
        except Exception as error:
            place = traceback.extract_tb(error.__traceback__)[-1]
            return f"{type(error).__name__}: {str(error)[:200]!r} at {Path(place.filename).name}:{place.lineno}"
    return "held"


def main() -> None:
    """Runs tries of one area or of all, and prints counts and findings."""
    area, first, count = [*sys.argv[1:], *["all", "0", "20"][len(sys.argv) - 1 :]]
    for one in AREAS if area == "all" else [area]:
        counts: Counter[str] = Counter()
        for number in range(int(first), int(first) + int(count)):
            outcome = attempt(one, number)
            counts[outcome if outcome in ("held", "refused") else "wrong"] += 1
            if outcome not in ("held", "refused"):
                print(f"{one} {number}: {outcome}", flush=True)
        print(f"{one}: {int(first)} to {int(first) + int(count) - 1}: {dict(counts)}", flush=True)


if __name__ == "__main__":
    main()
