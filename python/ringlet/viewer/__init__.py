"""The review: a page in the browser on which a look is found, and the server behind it."""

from ringlet.viewer.run import view

__all__ = ["view"]
