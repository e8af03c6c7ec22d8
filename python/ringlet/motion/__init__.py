"""Motion in the words of those who judge it: bounce, settle, sag and swing of hanging locks."""

from ringlet.motion.coils import CoilLengths, SeenMotion, seen_motion
from ringlet.motion.modes import modes_of
from ringlet.motion.stepping import Integrator, Stepping, advised_steps
from ringlet.motion.words import HangingLocks, Words

__all__ = [
    "CoilLengths",
    "HangingLocks",
    "Integrator",
    "SeenMotion",
    "Stepping",
    "Words",
    "advised_steps",
    "modes_of",
    "seen_motion",
]
