"""Motion in the words of those who judge it: bounce, settle, sag and swing of hanging locks."""

from ringlet.motion.coils import CoilLengths, SeenMotion, seen_motion
from ringlet.motion.modes import modes_of
from ringlet.motion.search import find_stiffness
from ringlet.motion.spring import HelicalSpring
from ringlet.motion.stepping import Integrator, Stepping, advised_steps
from ringlet.motion.words import STIFFNESS, HangingLocks, Words

__all__ = [
    "STIFFNESS",
    "CoilLengths",
    "HangingLocks",
    "HelicalSpring",
    "Integrator",
    "SeenMotion",
    "Stepping",
    "Words",
    "advised_steps",
    "find_stiffness",
    "modes_of",
    "seen_motion",
]
