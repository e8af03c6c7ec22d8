"""The public functions: what the command line does, for programs.

They follow the data: recipe → groom → cache → hairs → pictures. Heavy libraries are imported where they are used, so
that ``import ringlet`` is quick. ``progress``, wherever it is taken, is called as ``progress(stage, done, total)``.
"""

from __future__ import annotations

from ringlet.api.grooms import (
    build_groom,
    check_groom,
    edit_lock,
    groom_inputs,
    list_edits,
    load_groom,
    read_groom,
    read_recipe,
    release_locks,
    write_groom,
)
from ringlet.api.hairs import (
    build_hairs,
    write_hairs,
)
from ringlet.api.pictures import (
    write_loft_picture,
    write_sheet,
    write_still,
    write_touches_picture,
)
from ringlet.api.program import (
    run_bench,
    run_validation,
    schema,
    use_threads,
)
from ringlet.api.progress import (
    OnFrame,
    Progress,
)
from ringlet.api.shots import (
    brought_along,
    hold_checkpoints,
    loft,
    made_from,
    open_cache,
    read_cache,
    read_shot,
    rest_place,
    scalp_clip,
    simulate,
    start_motion,
    write_cache,
    write_loft,
    write_simulation,
    write_touches,
)

__all__ = [
    "OnFrame",
    "Progress",
    "brought_along",
    "build_groom",
    "build_hairs",
    "check_groom",
    "edit_lock",
    "groom_inputs",
    "hold_checkpoints",
    "list_edits",
    "load_groom",
    "loft",
    "made_from",
    "open_cache",
    "read_cache",
    "read_groom",
    "read_recipe",
    "read_shot",
    "release_locks",
    "rest_place",
    "run_bench",
    "run_validation",
    "scalp_clip",
    "schema",
    "simulate",
    "start_motion",
    "use_threads",
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
]
