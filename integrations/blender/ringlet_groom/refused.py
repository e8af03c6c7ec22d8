"""The one exception for what a user can mend."""

from __future__ import annotations


class Refused(Exception):
    """What a user can mend, in one line."""
