"""Live hair: a groom that moves with its head while it is groomed."""

from ringlet.live.live import Live

__all__ = ["Live"]
