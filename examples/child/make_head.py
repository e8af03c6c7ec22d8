"""Makes the example head: a child's bust with a named scalp and a clip of 48 frames, as USD in centimetres.

    python examples/child/make_head.py [-o head.usdc]

Needs scikit-image in addition to Ringlet's requirements. The result is in the repository; there is no need to run the
script. ``bust.py`` makes any head; this one moves.
"""

from __future__ import annotations

from pathlib import Path

from bust import run
from head_shape import HEAD
from motion import FRAMES

if __name__ == "__main__":
    run(HEAD, Path(__file__).with_name("head.usdc"), FRAMES)
