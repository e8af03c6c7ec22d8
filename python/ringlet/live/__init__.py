"""Live hair: a groom that moves with its head while it is groomed."""

from ringlet.live.live import Live
from ringlet.live.touch import Touch

__all__ = ["Live", "Touch"]
