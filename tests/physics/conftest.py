"""Makes the judges and scenes of tools/proof importable in the tests."""

import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[2] / "tools/proof")]
