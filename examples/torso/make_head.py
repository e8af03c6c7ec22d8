"""Makes the torso: the adult head with shoulders and a back that long hair lies on, as USD in centimetres. The head
stands where the child's head stands, so that the trunk ends below the ground.

    python examples/torso/make_head.py [-o head.usdc]

Needs scikit-image in addition to Ringlet's requirements. The result is in the repository; there is no need to run the
script. The shape is that of ``examples/adult``, and the code that makes a head of it that of ``examples/child``.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path += [str(Path(__file__).parents[1] / name) for name in ("child", "adult")]

from adult_shape import TORSO
from bust import run

if __name__ == "__main__":
    run(TORSO, Path(__file__).with_name("head.usdc"))
