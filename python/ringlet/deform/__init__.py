"""Hairs that are carried by the locks of a groom."""

from ringlet.deform.hairs import Hairs, root_frames

__all__ = ["Hairs", "root_frames"]
