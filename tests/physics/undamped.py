"""A single undamped strand for tests of its motion."""

from ringlet.data.curves import Curves
from ringlet.shot import Material
from ringlet.sim import Strands


def undamped_strand(points, prescribed=4, **material):
    defaults = {"damping": 0.0, "drag": 0.0}
    return Strands(Curves.from_list([points]), Material(**{**defaults, **material}), prescribed)
