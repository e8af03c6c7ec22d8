"""Ringlet grooms tightly curled hair and simulates it."""

from importlib import import_module
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

from ringlet.api import (
    build_groom,
    build_hairs,
    check_groom,
    edit_lock,
    hold_checkpoints,
    list_edits,
    load_groom,
    loft,
    open_cache,
    read_cache,
    read_groom,
    read_recipe,
    read_shot,
    release_locks,
    rest_place,
    run_bench,
    run_validation,
    schema,
    simulate,
    use_threads,
    write_cache,
    write_groom,
    write_hairs,
    write_loft,
    write_loft_picture,
    write_sheet,
    write_simulation,
    write_still,
    write_touches,
    write_touches_picture,
)
from ringlet.api.demo import run_demo
from ringlet.api.doctor import Finding, diagnose
from ringlet.api.run import Run
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.files import check_place
from ringlet.data.mesh import Clip, Mesh
from ringlet.data.stage import StageSpace

if TYPE_CHECKING:
    from ringlet.api.clock import Clock, solver_counts
    from ringlet.data.cache import Cache
    from ringlet.data.groom import Groom
    from ringlet.farm import compare_wedge, wedge, write_wedge_template
    from ringlet.groom.stack import Memory
    from ringlet.shot.cloth import Cloth, ClothMaterial, ClothSolver
    from ringlet.shot.direct import DirectSolver
    from ringlet.shot.loft import Loft
    from ringlet.shot.scene import Body, Contact, Scene
    from ringlet.shot.strands import Material, Solver, Strands
    from ringlet.viewer import view

__version__ = version("ringlet")
__all__ = [
    "Body",
    "Cache",
    "Clip",
    "Clock",
    "Cloth",
    "ClothMaterial",
    "ClothSolver",
    "Contact",
    "Curves",
    "DirectSolver",
    "Finding",
    "Groom",
    "Loft",
    "Material",
    "Memory",
    "Mesh",
    "Run",
    "Scene",
    "Solver",
    "StageSpace",
    "Strands",
    "UserError",
    "__version__",
    "build_groom",
    "build_hairs",
    "check_groom",
    "check_place",
    "compare_wedge",
    "diagnose",
    "edit_lock",
    "hold_checkpoints",
    "list_edits",
    "load_groom",
    "loft",
    "open_cache",
    "read_cache",
    "read_groom",
    "read_recipe",
    "read_shot",
    "release_locks",
    "rest_place",
    "run_bench",
    "run_demo",
    "run_validation",
    "schema",
    "simulate",
    "solver_counts",
    "use_threads",
    "view",
    "wedge",
    "write_cache",
    "write_groom",
    "write_hairs",
    "write_loft",
    "write_loft_picture",
    "write_sheet",
    "write_simulation",
    "write_still",
    "write_touches",
    "write_touches_picture",
    "write_wedge_template",
]


# These live in packages that load slowly, so they are imported when they are first asked for.
_SLOW = {
    "Body": "ringlet.shot.scene",
    "Cache": "ringlet.data.cache",
    "Clock": "ringlet.api.clock",
    "Cloth": "ringlet.shot.cloth",
    "ClothMaterial": "ringlet.shot.cloth",
    "ClothSolver": "ringlet.shot.cloth",
    "Contact": "ringlet.shot.scene",
    "DirectSolver": "ringlet.shot.direct",
    "Groom": "ringlet.data.groom",
    "Loft": "ringlet.shot.loft",
    "Material": "ringlet.shot.strands",
    "Memory": "ringlet.groom.stack",
    "Scene": "ringlet.shot.scene",
    "Solver": "ringlet.shot.strands",
    "Strands": "ringlet.shot.strands",
    "compare_wedge": "ringlet.farm",
    "solver_counts": "ringlet.api.clock",
    "view": "ringlet.viewer",
    "wedge": "ringlet.farm",
    "write_wedge_template": "ringlet.farm",
}


def __getattr__(name: str) -> Any:
    if name in _SLOW:
        return getattr(import_module(_SLOW[name]), name)
    raise AttributeError(f"module 'ringlet' has no attribute '{name}'")
