"""Makes the judges and scenes of tools/proof, and those of the physics tests, importable in the proofs."""

import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT / "tests/physics"), str(ROOT / "tools/proof")]
