"""Ringlet grooms tightly curled hair and simulates it."""

from importlib.metadata import version

from ringlet.curves import Curves
from ringlet.errors import UserError
from ringlet.mesh import Clip, Mesh

__version__ = version("ringlet")
__all__ = ["Clip", "Curves", "Mesh", "UserError", "__version__"]
