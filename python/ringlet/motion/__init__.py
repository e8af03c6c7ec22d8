"""Motion in the words of those who judge it: bounce, settle, sag and swing of hanging locks."""

from ringlet.motion.stepping import Integrator, Stepping, advised_steps
from ringlet.motion.words import HangingLocks, Words

__all__ = ["HangingLocks", "Integrator", "Stepping", "Words", "advised_steps"]
