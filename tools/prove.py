"""Runs the proofs that are too long for a test, and notes in docs/proofs.md when each ran, of which commit.

Usage: .venv/bin/python tools/prove.py [NAME …], by default all. Fails where one does.
"""

import datetime
import re
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/proofs.md"
PROOFS = {  # commands that fail where a proof does
    "dense liveliness": ".venv/bin/python -m pytest tests/proof/test_dense_liveliness.py",
    "thousand frames": ".venv/bin/python -m pytest --timeout 0 tests/proof/test_thousand_frames.py",
    "fine sphere": ".venv/bin/python -m pytest tests/proof/test_fine_sphere.py",
    "long hair": ".venv/bin/python -m pytest tests/proof/test_long_hair.py",
    "whole demo": ".venv/bin/python -m pytest tests/proof/test_whole_demo.py",
    "live hour": ".venv/bin/python -m pytest --timeout 0 tests/proof/test_live_hour.py",
    "head script": ".venv/bin/python -m pytest tests/proof/test_head_script.py",
    "sanitizers": "make sanitize",
    "wheel": "make wheel",
    "ARM64": "make arm",
    "gallery": "make gallery",
}


def note(page: str, name: str, result: str) -> str:
    """The page with another result in the row of a proof."""
    noted, count = re.subn(rf"^(\| {name} \|.*\|) [^|]* \|$", rf"\1 {result} |", page, flags=re.MULTILINE)
    if count != 1:
        raise SystemExit(f"docs/proofs.md has {count} rows of {name}; must be 1")
    return noted


def commit() -> str:
    """The commit of the working tree, marked where files differ from it."""
    said = ["git", "describe", "--always", "--dirty", "--exclude=*"]
    return subprocess.run(said, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()


def main(names: list[str]) -> int:
    if unknown := set(names) - set(PROOFS):
        raise SystemExit(f"no proof {', '.join(sorted(unknown))}; choose from {', '.join(PROOFS)}")
    failed, of = False, commit()  # before the page differs from it
    for name in names or PROOFS:
        print(f"prove: {name}", flush=True)
        start = time.monotonic()
        holds = subprocess.run(PROOFS[name], shell=True, cwd=ROOT).returncode == 0
        failed |= not holds
        verdict, today = "holds" if holds else "**fails**", datetime.date.today().isoformat()
        PAGE.write_text(note(PAGE.read_text(), name, f"{verdict}: {today}, {of}, {time.monotonic() - start:.0f} s"))
    return int(failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
