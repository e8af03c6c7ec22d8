"""Makes the judges and scenes of tools/proof importable in the proofs."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tools/proof"))
