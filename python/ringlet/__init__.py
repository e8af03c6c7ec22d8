"""Ringlet grooms tightly curled hair and simulates it."""

import os
from importlib import import_module
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

# Threads of the core wait for one another actively for so many turns, some microseconds, then sleep. OpenMP reads this
# when the core is loaded, so it stands before all imports of ours: docs/decisions/waiting_threads.md.
if "OMP_WAIT_POLICY" not in os.environ:
    os.environ.setdefault("GOMP_SPINCOUNT", "1000")

from ringlet import api
from ringlet.api import *
from ringlet.data import limits
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError, line_of
from ringlet.data.files import check_place
from ringlet.data.former_names import FormerNames
from ringlet.data.mesh import Clip, Mesh
from ringlet.data.picture import PictureSettings
from ringlet.data.reads import recorded
from ringlet.data.stage import StageSpace

if TYPE_CHECKING:
    from ringlet.api.clock import Clock, solver_counts
    from ringlet.data.cache import Cache
    from ringlet.data.explain import explain
    from ringlet.data.groom import Groom
    from ringlet.farm import compare_wedge, wedge, write_wedge_template
    from ringlet.groom.stages import Memory
    from ringlet.host import serve
    from ringlet.rest.loft import Loft
    from ringlet.shot.cloth import ClothMaterial
    from ringlet.shot.contact import Contact
    from ringlet.shot.material import Material
    from ringlet.shot.solver import ClothSolver, Solver
    from ringlet.sim.cloth import Cloth
    from ringlet.sim.direct import DirectSolver
    from ringlet.sim.obstacle import Body
    from ringlet.sim.scene import Scene
    from ringlet.sim.strands import Strands
    from ringlet.viewer import share, view

# These load slowly, so they are imported when they are first asked for.
_SLOW = {
    "Body": "ringlet.sim.obstacle",
    "Cache": "ringlet.data.cache",
    "Clock": "ringlet.api.clock",
    "Cloth": "ringlet.sim.cloth",
    "ClothMaterial": "ringlet.shot.cloth",
    "ClothSolver": "ringlet.shot.solver",
    "Contact": "ringlet.shot.contact",
    "DirectSolver": "ringlet.sim.direct",
    "Groom": "ringlet.data.groom",
    "Loft": "ringlet.rest.loft",
    "Material": "ringlet.shot.material",
    "Memory": "ringlet.groom.stages",
    "Scene": "ringlet.sim.scene",
    "Solver": "ringlet.shot.solver",
    "Strands": "ringlet.sim.strands",
    "compare_wedge": "ringlet.farm",
    "explain": "ringlet.data.explain",
    "serve": "ringlet.host",
    "solver_counts": "ringlet.api.clock",
    "share": "ringlet.viewer",
    "view": "ringlet.viewer",
    "wedge": "ringlet.farm",
    "write_wedge_template": "ringlet.farm",
}

__version__ = version("ringlet")
__all__ = [
    "Clip",
    "Curves",
    "FormerNames",
    "Mesh",
    "PictureSettings",
    "StageSpace",
    "UserError",
    "__version__",
    "check_place",
    "limits",
    "line_of",
]
__all__ += ["recorded"]
__all__ += api.__all__
__all__ += _SLOW  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    if name in _SLOW:
        return getattr(import_module(_SLOW[name]), name)
    raise AttributeError(f"module 'ringlet' has no attribute '{name}'")
