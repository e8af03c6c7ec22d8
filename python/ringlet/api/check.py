"""Intersections of a groom, their repair and their picture."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ringlet import groom as grooms
from ringlet import io
from ringlet.api.grooms import load_groom, write_groom
from ringlet.api.progress import Progress
from ringlet.data.extras import need
from ringlet.data.groom import Groom
from ringlet.data.mesh import Mesh
from ringlet.data.reads import recorded
from ringlet.data.thickness import own_radii
from ringlet.picture import write_places


@recorded()
def check_groom(
    groom: Groom | Path | str,
    *,
    root_depth: float = 5e-4,
    root_length: float = 5e-3,
    thickness: float = 1e-4,
    own_radius: float = 0.85,
    fixed: Path | str | None = None,
    picture: Path | str | None = None,
    variant: str | None = None,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Intersections of a groom with the scalp, the body and itself: places, locks, greatest depth [m], worst places.

    Returns ``found``, and ``folds``: the braids that fold back on themselves, after the repair if there is one. Lengths
    [m] are the ``thickness``, the ``lock_thickness`` of locks with their hairs, and the largest ``own_thickness`` at
    which locks with a radius of their own count. Density and cover are those of ``measure_hairs``. With ``fixed`` also
    ``left``, the remaining intersections, and ``repair``, the displacements.

    root_depth:  how deep a lock may be in the skin up to ``root_length`` from its root [m]
    thickness:   distance below which two locks count as intersecting [m]
    own_radius:  part of the radius of their own at which locs and strands of braids touch, where that is more
    fixed:       where to write the repaired groom
    picture:     where to write a picture of the places: of those that are left, if it is repaired
    variant:     of the groom file, in place of the one that is selected in it
    """
    if picture is not None:
        need("matplotlib")
    if not isinstance(groom, Groom):
        groom = load_groom(groom, variant=variant, progress=progress)
    allowed = grooms.Allowed(root_depth, root_length, thickness, own_radius)
    others = _other_meshes(groom)
    findings = grooms.check_groom(groom, others, allowed)
    summary: dict[str, Any] = {
        "locks": len(groom.locks),
        "points": len(groom.locks.points),
        "thickness": thickness,
        "lock_thickness": grooms.lock_thickness(groom),
        "own_thickness": 2.0 * own_radius * float(own_radii(groom.locks).max(initial=0.0)),
        "found": findings.summary(),
        "folds": grooms.folded_braids(groom.locks),
        **grooms.hair_measures(groom),
    }
    if fixed is not None:
        repair = grooms.fix_groom(groom, others, allowed, progress)
        write_groom(repair.groom, fixed)
        findings = repair.left
        folds = grooms.folded_braids(repair.groom.locks)
        summary |= {"left": findings.summary(), "repair": repair.summary(), "folds": folds}
    if picture is not None:
        body = np.concatenate([mesh.points for mesh in (groom.scalp, *others)])
        title = "left after the repair" if fixed is not None else "found"
        write_places(body, findings.locks.points, findings.by_kind(), picture, title)
    return summary


def _other_meshes(groom: Groom) -> list[Mesh]:
    """Visible meshes in the scalp's USD file, except the scalp; empty for an OBJ."""
    file = groom.scalp_file
    meshes = [] if file is None or file.suffix == ".obj" else io.read_meshes(file, groom.cage)
    return [mesh for mesh in meshes if mesh.name != groom.scalp.name and groom.shows(mesh.name)]
