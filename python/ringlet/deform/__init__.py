"""Hairs that are carried by the locks of a groom."""

from ringlet.deform.hairs import Hairs, root_frames
from ringlet.deform.joined_hairs import AnyHairs, JoinedHairs

__all__ = ["AnyHairs", "Hairs", "JoinedHairs", "root_frames"]
