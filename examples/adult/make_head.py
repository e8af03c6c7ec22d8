"""Makes the adult head: a bust with named regions, as USD in centimetres. It stands where the child's head stands.

    python examples/adult/make_head.py [-o head.usdc]

Needs scikit-image in addition to Ringlet's requirements. The result is in the repository; there is no need to run the
script. The code that makes a head of a shape is that of ``examples/child``.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1] / "child"))

from adult_shape import HEAD
from bust import run

if __name__ == "__main__":
    run(HEAD, Path(__file__).with_name("head.usdc"))
