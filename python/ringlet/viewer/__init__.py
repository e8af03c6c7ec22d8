"""The review: a page in the browser for grooming and playback, and its server."""

from ringlet.viewer.keep.share_page import share
from ringlet.viewer.run import view

__all__ = ["share", "view"]
