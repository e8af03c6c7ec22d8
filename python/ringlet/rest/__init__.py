"""Rest shapes: what locks must remember to hang as they were groomed. One file per method."""

from ringlet.rest.equilibrium import equilibrium
from ringlet.rest.loft import Loft
from ringlet.rest.preload import loft, with_sag
from ringlet.rest.staleness import check_current, dependencies
from ringlet.rest.update import from_curves, solve_rest_shape, to_curves, update_rest_shape

__all__ = [
    "Loft",
    "check_current",
    "dependencies",
    "equilibrium",
    "from_curves",
    "loft",
    "solve_rest_shape",
    "to_curves",
    "update_rest_shape",
    "with_sag",
]
