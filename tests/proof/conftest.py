"""Makes the judges and scenes of tools/proof, and those of other tests, importable in the proofs."""

import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT / folder) for folder in ("tests/physics", "tests/python", "tools/proof")]
