"""The review: a page in the browser for grooming and playback, and its server."""

from ringlet.viewer.run import view
from ringlet.viewer.share_page import share

__all__ = ["share", "view"]
