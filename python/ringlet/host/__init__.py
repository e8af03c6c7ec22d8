"""Ringlet for other programs: a process of its own that grooms and simulates what they send. See docs/host.md."""

from ringlet.host.server import serve

__all__ = ["serve"]
